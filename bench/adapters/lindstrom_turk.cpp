// CGAL stays in this file: it takes its time to compile.
#include "ladder.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Edge_collapse_visitor_base.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

#include <span>
#include <string>
#include <utility>

namespace gimg::adapter {
namespace {

namespace sms = CGAL::Surface_mesh_simplification;
using Point = CGAL::Simple_cartesian<double>::Point_3;
using Surface = CGAL::Surface_mesh<Point>;

Result<Surface> toSurface(const Mesh& mesh)
{
    Surface surface;
    const auto size = [](size_t count) { return static_cast<Surface::size_type>(count); };
    surface.reserve(size(mesh.positions.size()), size(mesh.faces.size() * 3 / 2), size(mesh.faces.size()));
    for (const Vec3& p : mesh.positions) surface.add_vertex({p[0], p[1], p[2]});
    for (size_t i = 0; i < mesh.faces.size(); ++i) {
        const auto corner = [&](int k) {
            return Surface::Vertex_index(static_cast<unsigned>(mesh.faces[i][k]));
        };
        if (surface.add_face(corner(0), corner(1), corner(2)) == Surface::null_face())
            return Error{ErrorKind::NonManifoldEdge,
                         "face " + std::to_string(i) +
                             " does not fit an oriented manifold, which the simplifier needs"};
    }
    return surface;
}

Mesh toMesh(const Surface& surface)
{
    Mesh mesh;
    std::vector<int> number(surface.num_vertices(), -1);
    for (const Surface::Vertex_index v : surface.vertices()) {
        number[v] = mesh.vertexCount();
        const Point& p = surface.point(v);
        mesh.positions.emplace_back(p.x(), p.y(), p.z());
    }
    for (const Surface::Face_index f : surface.faces()) {
        Triangle face{};
        int k = 0;
        for (const Surface::Vertex_index v : surface.vertices_around_face(surface.halfedge(f)))
            face[k++] = number[v];
        mesh.faces.push_back(face);
    }
    return mesh;
}

// Keeps a copy of the surface whenever it gets down to the next of the counts.
struct Snapshots : sms::Edge_collapse_visitor_base<Surface>
{
    std::span<const std::size_t> counts;
    std::size_t* taken = nullptr;
    std::vector<Mesh>* meshes = nullptr;

    void OnCollapsed(const Profile& profile, const Surface::Vertex_index&)
    {
        const Surface& surface = profile.surface_mesh();
        if (*taken == counts.size() || surface.number_of_faces() > counts[*taken]) return;
        meshes->push_back(toMesh(surface));
        while (*taken < counts.size() && surface.number_of_faces() <= counts[*taken]) ++*taken;
    }
};

// Goes on until all copies are taken.
struct Stop
{
    const std::size_t* taken;
    std::size_t wanted;
    template <class Profile> bool operator()(double, const Profile&, std::size_t, std::size_t) const
    {
        return *taken == wanted;
    }
};

// The surface at each of the falling counts, or a triangle or two below; fewer of them where no edge is left
// that may be collapsed.
std::vector<Mesh> collapse(Surface surface, std::span<const std::size_t> counts)
{
    std::vector<Mesh> meshes;
    std::size_t taken = 0;
    Snapshots snapshots;
    snapshots.counts = counts;
    snapshots.taken = &taken;
    snapshots.meshes = &meshes;
    sms::edge_collapse(surface, Stop{&taken, counts.size()}, CGAL::parameters::visitor(snapshots));
    return meshes;
}

class LindstromTurk : public Ladder
{
public:
    explicit LindstromTurk(std::vector<Mesh> rungs) : rungs_(std::move(rungs)) {}
    int size() const override { return static_cast<int>(rungs_.size()); }
    const Mesh& rung(int i) override { return rungs_[i]; }

    std::vector<Mesh> between(int i) override
    {
        const std::vector<std::size_t> counts =
            countsBetween(rungs_[i].faces.size(), rungs_[i + 1].faces.size());
        Result<Surface> surface = toSurface(rungs_[i]);
        // A rung comes out of a manifold, so it is one.
        return surface && !counts.empty() ? collapse(std::move(*surface), counts) : std::vector<Mesh>{};
    }

private:
    std::vector<Mesh> rungs_;
};

} // namespace

Result<std::unique_ptr<Ladder>> lindstromTurkLadder(const Mesh& mesh, std::size_t mostTriangles)
{
    Mesh whole = referenced(mesh);
    Result<Surface> surface = toSurface(whole);
    if (!surface) return surface.error();
    const auto below = static_cast<std::size_t>(static_cast<double>(whole.faces.size()) * Ladder::kRungRatio);
    std::vector<Mesh> rungs = collapse(std::move(*surface), rungCounts(std::min(mostTriangles, below)));
    rungs.insert(rungs.begin(), std::move(whole));
    return std::unique_ptr<Ladder>(std::make_unique<LindstromTurk>(std::move(rungs)));
}

} // namespace gimg::adapter

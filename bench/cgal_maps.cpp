#define CGAL_EIGEN3_ENABLED
#define CGAL_SMP_USE_SPARSESUITE_SOLVERS // what CGAL recommends for speed
#include <Eigen/UmfPackSupport>

#include "cgal_maps.h"

#include <CGAL/Eigen_solver_traits.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_parameterization/ARAP_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Barycentric_mapping_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Discrete_authalic_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Discrete_conformal_map_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Mean_value_coordinates_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Square_border_parameterizer_3.h>

namespace gimg::bench {
namespace {

namespace SMP = CGAL::Surface_mesh_parameterization;
using Kernel = CGAL::Simple_cartesian<double>;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Vertex = SurfaceMesh::Vertex_index;
using Halfedge = SurfaceMesh::Halfedge_index;
using Solver = CGAL::Eigen_solver_traits<Eigen::UmfPackLU<CGAL::Eigen_sparse_matrix<double>::EigenType>>;

// A model of CGAL's concept Parameterizer_3 for borders: positions that are given.
struct GivenBorder
{
    using Triangle_mesh = SurfaceMesh;
    using TriangleMesh = SurfaceMesh;

    template <class UvMap, class IndexMap, class DoneMap>
    SMP::Error_code parameterize(const SurfaceMesh& mesh, Halfedge border, UvMap uv, IndexMap, DoneMap done)
    {
        for (Vertex v : CGAL::vertices_around_face(border, mesh)) {
            put(uv, v, Kernel::Point_2((*position)[v].x(), (*position)[v].y()));
            put(done, v, true);
        }
        return SMP::OK;
    }
    bool is_border_convex() const { return true; }

    const std::vector<Vec2>* position = nullptr;
};

} // namespace

struct CgalDisk::Held
{
    SurfaceMesh mesh;
    Halfedge border;
    const std::vector<Vec2>* borderPosition;

    template <class Parameterizer>
    std::vector<Vec2> run(Parameterizer parameterizer, std::string& error) const
    {
        SurfaceMesh copy = mesh; // CGAL takes it mutable, and keeps its maps in it
        auto uv = copy.add_property_map<Vertex, Kernel::Point_2>("v:uv").first;
        auto done = copy.add_property_map<Vertex, bool>("v:done", false).first;
        const SMP::Error_code code =
            parameterizer.parameterize(copy, border, uv, get(boost::vertex_index, copy), done);
        if (code != SMP::OK) return error = SMP::get_error_message(code), std::vector<Vec2>{};
        std::vector<Vec2> st;
        for (Vertex v : copy.vertices()) st.emplace_back(uv[v].x(), uv[v].y());
        return st;
    }

    template <class Border>
    std::vector<Vec2> runWith(const std::string& map, const Border& around, std::string& error) const
    {
        if (map == "barycentric")
            return run(SMP::Barycentric_mapping_parameterizer_3<SurfaceMesh, Border, Solver>(around), error);
        if (map == "harmonic")
            return run(SMP::Discrete_conformal_map_parameterizer_3<SurfaceMesh, Border, Solver>(around),
                       error);
        if (map == "authalic")
            return run(SMP::Discrete_authalic_parameterizer_3<SurfaceMesh, Border, Solver>(around), error);
        return run(SMP::Mean_value_coordinates_parameterizer_3<SurfaceMesh, Border, Solver>(around), error);
    }
};

std::vector<CgalMap> cgalMaps()
{
    std::vector<CgalMap> maps;
    for (const char* map : {"barycentric", "harmonic", "authalic", "mean value"})
        for (const char* border : {"gimg's", "arc length", "uniform"}) maps.push_back({map, border});
    maps.push_back({"ARAP", ""});
    return maps;
}

CgalDisk::CgalDisk(const SquareDisk& square) : held_(new Held)
{
    held_->borderPosition = &square.borderPosition;
    for (const Vec3& p : square.disk.mesh.positions)
        held_->mesh.add_vertex(Kernel::Point_3(p.x(), p.y(), p.z()));
    const auto vertex = [](int v) { return Vertex(static_cast<SurfaceMesh::size_type>(v)); };
    for (const Triangle& f : square.disk.mesh.faces)
        held_->mesh.add_face(vertex(f[0]), vertex(f[1]), vertex(f[2]));
    for (Halfedge h : held_->mesh.halfedges())
        if (held_->mesh.is_border(h)) held_->border = h;
}

CgalDisk::~CgalDisk() { delete held_; }

std::vector<Vec2> CgalDisk::run(const CgalMap& map, std::string& error) const
{
    if (map.map == "ARAP") return held_->run(SMP::ARAP_parameterizer_3<SurfaceMesh>(), error);
    if (map.border == "arc length")
        return held_->runWith(map.map, SMP::Square_border_arc_length_parameterizer_3<SurfaceMesh>(), error);
    if (map.border == "uniform")
        return held_->runWith(map.map, SMP::Square_border_uniform_parameterizer_3<SurfaceMesh>(), error);
    return held_->runWith(map.map, GivenBorder{held_->borderPosition}, error);
}

} // namespace gimg::bench

#include "conformal/sphere_check.h"

#include "mesh_check.h"

#include <algorithm>
#include <string>
#include <vector>

namespace gimg {
namespace {

// Thinner triangles have angles that doubles cannot tell.
constexpr double kLeastHeight = 1e-12; // of the longest side

Status checkAreas(const Mesh& mesh)
{
    for (int f = 0; f < mesh.faceCount(); ++f) {
        const auto [a, b, c] = mesh.faces[f];
        const Vec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
        const double longest =
            std::max({(q - p).squaredNorm(), (r - q).squaredNorm(), (p - r).squaredNorm()});
        if (a == b || b == c || c == a || !((q - p).cross(r - p).norm() > kLeastHeight * longest))
            return Error{ErrorKind::ZeroAreaFace, "face " + std::to_string(f) + " (vertices " +
                                                      std::to_string(a) + ", " + std::to_string(b) + ", " +
                                                      std::to_string(c) + ") has no area"};
    }
    return Done{};
}

Status checkManifold(const Mesh& mesh, const Halfedges& he)
{
    std::vector<int> valence(mesh.positions.size(), 0);
    for (int h = 0; h < he.count(); ++h) {
        ++valence[he.tail(h)];
        const int twin = he.twin(h);
        if (twin >= 0 && he.twin(twin) != h)
            return Error{ErrorKind::NonManifoldEdge,
                         "edge " + std::to_string(he.tail(h)) + "-" + std::to_string(he.head(h)) +
                             " is not one of two faces that run along it both ways"};
    }
    for (int v = 0; v < mesh.vertexCount(); ++v) {
        if (valence[v] == 0)
            return Error{ErrorKind::BadArgument, "vertex " + std::to_string(v) + " is in no face"};
        int around = 0;
        for (int h = he.outgoing(v); h >= 0 && around <= valence[v]; ++around) {
            h = he.rotateCcw(h);
            if (h == he.outgoing(v)) h = -1;
        }
        if (around != valence[v])
            return Error{ErrorKind::NonManifoldVertex,
                         "the faces at vertex " + std::to_string(v) + " form more than one fan"};
    }
    return Done{};
}

int components(const Mesh& mesh, const Halfedges& he)
{
    std::vector<bool> seen(mesh.faces.size(), false);
    int count = 0;
    for (int first = 0; first < mesh.faceCount(); ++first) {
        if (seen[first]) continue;
        ++count;
        std::vector<int> waiting{first};
        seen[first] = true;
        while (!waiting.empty()) {
            const int f = waiting.back();
            waiting.pop_back();
            for (int k = 0; k < 3; ++k) {
                const int twin = he.twin(3 * f + k);
                if (twin < 0 || seen[Halfedges::face(twin)]) continue;
                seen[Halfedges::face(twin)] = true;
                waiting.push_back(Halfedges::face(twin));
            }
        }
    }
    return count;
}

} // namespace

Status checkSphere(const Mesh& mesh)
{
    if (const auto objection = objectionToTriangles(mesh, "the surface")) return *objection;
    if (const Status areas = checkAreas(mesh); !areas) return areas.error();
    const Halfedges he(mesh.faces, mesh.vertexCount());
    int open = 0;
    for (int h = 0; h < he.count(); ++h) open += he.onBoundary(h);
    if (open > 0)
        return Error{ErrorKind::NotClosed,
                     "the surface is not closed: it has " + std::to_string(open) + " boundary edges"};
    if (const Status manifold = checkManifold(mesh, he); !manifold) return manifold.error();
    if (const int count = components(mesh, he); count > 1)
        return Error{ErrorKind::SeveralComponents,
                     "the surface has " + std::to_string(count) + " components"};
    if (const int genus = topology(mesh).genus; genus != 0)
        return Error{ErrorKind::WrongGenus,
                     "the surface has genus " + std::to_string(genus) + "; only genus 0 maps to the sphere"};
    return Done{};
}

} // namespace gimg

#include "conformal/closed_surface.h"

#include "mesh_check.h"

namespace gimg {

Result<ClosedSurface> closedSurface(const PolyhedralSurface& surface, int leastGenus)
{
    const Result<Topology> topology = closedTopology(surface);
    if (!topology) return topology.error();
    if (topology->genus < leastGenus)
        return Error{ErrorKind::WrongGenus, "the surface has genus " + std::to_string(topology->genus) +
                                                ", at least " + std::to_string(leastGenus) + " is needed"};
    return ClosedSurface{surface, *topology, Halfedges(surface.faces, surface.vertexCount)};
}

Result<PolyhedralSurface> checkedSurface(const Mesh& mesh)
{
    if (std::optional<Error> objection = objectionToTriangles(mesh, "the mesh")) return *objection;
    return polyhedralSurface(mesh);
}

} // namespace gimg

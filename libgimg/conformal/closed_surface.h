#pragma once

#include "gimg/polyhedral_surface.h"

namespace gimg {

/// A surface that closedTopology() had no objection to, with its connectivity.
struct ClosedSurface
{
    const PolyhedralSurface& surface; ///< must outlive this
    Topology topology;
    Halfedges halfedges;

    double length(int h) const { return surface.lengths[h]; }
};

/// Errors: those of closedTopology; WrongGenus below `leastGenus`.
Result<ClosedSurface> closedSurface(const PolyhedralSurface& surface, int leastGenus);

/// polyhedralSurface() of a mesh whose indices and positions were looked at first.
/// Errors: EmptyMesh, BadArgument, NotFinite.
Result<PolyhedralSurface> checkedSurface(const Mesh& mesh);

} // namespace gimg

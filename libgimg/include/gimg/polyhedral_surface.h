#pragma once

#include "gimg/mesh.h"
#include "gimg/result.h"

#include <vector>

namespace gimg {

/// A surface glued from flat triangles, known by the lengths of their edges: all that its conformal structure
/// needs. It may have no shape in space, like a branched cover or squares glued along their sides.
struct PolyhedralSurface
{
    int vertexCount = 0;
    std::vector<Triangle> faces; ///< as a Mesh has them: two vertices are joined by one edge at most
    std::vector<double> lengths; ///< per halfedge 3 f + k (see Halfedges), the same on twins

    int faceCount() const { return static_cast<int>(faces.size()); }
};

/// The surface that the triangles of a mesh make.
PolyhedralSurface polyhedralSurface(const Mesh& mesh);

/// What type a closed surface has, after a look at all that could be wrong with it. Vertices that no face has
/// do not count.
/// Errors: EmptyMesh; BadArgument for an index out of range, lengths that are not one a halfedge or differ on
/// twins, or faces that are orientable but not oriented alike; NotFinite; NonManifoldEdge; NotOrientable;
/// NotClosed; NonManifoldVertex; SeveralComponents; ZeroAreaFace where a face has a vertex twice, or a side
/// as long as the other two together up to rounding.
Result<Topology> closedTopology(const PolyhedralSurface& surface);

} // namespace gimg

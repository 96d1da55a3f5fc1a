#pragma once

#include "gimg/cut.h"
#include "gimg/mesh.h"
#include "gimg/result.h"

#include <vector>

namespace gimg {

/// One cut-path as the opened boundary meets it.
struct DiskSide
{
    int path = 0;              ///< index into CutGraph::paths
    bool reversed = false;     ///< traversed against the path's own direction
    std::vector<int> vertices; ///< disk vertices along the side, both ends included
};

/// A surface opened along a cut: one boundary loop, Euler characteristic 1. Faces are those of the surface,
/// in the same order.
struct DiskMesh
{
    Mesh mesh;
    std::vector<int> origin;     ///< surface vertex of every disk vertex
    std::vector<DiskSide> sides; ///< counter-clockwise around the disk, beginning with path 0

    int borderLength() const; ///< number of boundary edges (= boundary vertices)
};

/// Opens `mesh` along `cut`. Errors: NotADisk if the cut does not open the surface to one disk.
/// Source: thesis §3.1.
Result<DiskMesh> openAlong(const Mesh& mesh, const CutGraph& cut);

} // namespace gimg

#pragma once

#include "gimg/homology.h"
#include "gimg/mesh.h"
#include "gimg/result.h"

#include <span>
#include <vector>

namespace gimg {

/// A surface slit along edges. Faces are those of the surface, in the same order.
struct SlicedMesh
{
    Mesh mesh;               ///< the copies of a vertex lie next to each other
    std::vector<int> origin; ///< surface vertex of every vertex
};

/// Slits a mesh along loops: at a vertex of theirs, every run of corners between slit edges (a wedge) gets a
/// copy of its own. Loops that together leave one disk, like those of a homology basis through one root, open
/// the surface to it.
/// @param mesh  manifold and oriented
/// Errors: BadArgument for a halfedge that the mesh does not have.
/// Source: thesis §6.3, Algorithm 5.
Result<SlicedMesh> sliceAlong(const Mesh& mesh, std::span<const Loop> loops);

} // namespace gimg

#pragma once

#include "arguments.h"

#include "gimg/topology_noise.h"

#include <string>
#include <vector>

namespace gimg::gimenc {

/// What --close-holes and --max-genus make of a mesh, and what they did.
struct SimplifiedSurface
{
    Mesh mesh;
    std::vector<ClosedHole> holes;
    std::vector<RemovedHandle> handles;
    std::vector<std::string> notes; ///< a line for each option that changed something

    bool changed() const { return !holes.empty() || !handles.empty(); }
};

/// Whether any of the options asks for it.
bool asksForSimplifying(const Arguments& a);

/// @param mesh  connected, manifold, oriented
/// Errors: those of closeHoles and removeHandles.
Result<SimplifiedSurface> simplifiedSurface(const Mesh& mesh, const Arguments& a);

} // namespace gimg::gimenc

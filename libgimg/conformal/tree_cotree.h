#pragma once

#include "conformal/closed_surface.h"
#include "conformal/shortest_paths.h"

#include <vector>

namespace gimg {

/// Shortest paths from a root, a tree of faces that crosses none of them, and the 2g edges that are in
/// neither. Each of these closes one loop with the paths to its ends. Together the loops generate the
/// fundamental group, and the face tree avoids edges with a short loop where it can, so that no other loops
/// through the root are shorter. Source: Eppstein 2003; Erickson, Whittlesey 2005, section 3.
struct TreeCotree
{
    std::vector<int> loopEdges; ///< 2g halfedges, by the length of their loops
    std::vector<int> faceOrder; ///< every face, after the face it hangs on
    std::vector<int> hangsBy;   ///< per face: its halfedge to the face it hangs on; -1 for the first
};

/// @param paths  that reach every vertex from one root
TreeCotree treeCotree(const ClosedSurface& surface, const ShortestPaths& paths);

/// The loop that the halfedge closes, without what the paths to its ends have in common.
std::vector<int> closedLoop(const ClosedSurface& surface, const ShortestPaths& paths, int halfedge);

} // namespace gimg

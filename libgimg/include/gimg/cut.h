#pragma once

#include "gimg/mesh.h"
#include "gimg/result.h"

#include <span>
#include <vector>

namespace gimg {

/// A chain of mesh edges between two cut-nodes with no cut-node in between.
struct CutPath
{
    std::vector<int> vertices; ///< consecutive ones are joined by a mesh edge; first and last are cut-nodes
    bool boundary = false;     ///< made of original boundary edges; otherwise it is opened into two mates
};

/// A set of edges whose removal opens the surface to a disk, as the cut-paths between its cut-nodes
/// (vertices of valence other than 2 in the cut; where there is none, one vertex stands in).
struct CutGraph
{
    std::vector<CutPath> paths;

    int nodeCount() const;
};

/// Total length of the cut on the surface, boundary loops included.
double cutLength(const Mesh& mesh, const CutGraph& cut);

/// Opens a surface of any genus with any number of boundary loops: faces are removed in order of geodesic
/// distance from a seed face, dangling edges are trimmed, and every cut-path is straightened to the shortest
/// path that keeps the cut's topology. A closed surface of genus 0 is cut along two adjacent edges at the
/// vertex farthest from the seed. Original boundary edges always belong to the cut.
/// @param mesh     connected, manifold, oriented
/// @param extrema  vertices that the cut is then extended to, each in turn by a shortest path; one that it
/// passes
///                 already adds nothing
/// Source: thesis §3.1.2.
CutGraph cutToDisk(const Mesh& mesh, std::span<const int> extrema = {});

/// Opens a closed surface of genus 0 along paths from one vertex, the centre, to each of the tips: the
/// shortest ones that touch each other in the centre only. The centre is the vertex nearest to all tips
/// together that has enough edges. No paths where that fails.
CutGraph starCut(const Mesh& mesh, std::span<const int> tips);

} // namespace gimg

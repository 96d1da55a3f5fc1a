#pragma once

#include "gimg/flatten.h"
#include "gimg/mesh.h"

#include <vector>

namespace gimg {

/// A mesh with fewer faces whose vertices are some of the original's.
struct SimplifiedMesh
{
    Mesh mesh;
    std::vector<int> vertexOf; ///< the original's index of each vertex
};

/// @param faces  to be left, where the boundary lets it be so coarse
SimplifiedMesh simplify(const Mesh& mesh, int faces);

struct ExtremaOptions
{
    int faces = 4000;   ///< of the simplified mesh
    int most = 24;      ///< extrema to find at most
    int rejections = 4; ///< candidates in a row that may fail before the search ends
    FlattenEffort effort =
        FlattenEffort::Full; ///< of judging; unfold makes trials where the surface is no sphere
};

/// Where a cut should reach, and what that does for the simplified mesh.
struct Extrema
{
    std::vector<int> vertices; ///< in the order for cutToDisk; none where no extension helps
    double energyWithout =
        0;                 ///< quarticStretchEnergy of the simplified mesh, flattened along the initial cut
    double energyWith = 0; ///< the same with the cut extended to `vertices`
};

/// Finds tips of limbs and the like: vertices that the cut should pass so that samples spread evenly. A
/// candidate is the vertex farthest from the cut and from the candidates that failed. It is kept if extending
/// the cut to it lowers the stretch of the flattened surface by 5 % or more. Candidates are found and judged
/// on a simplified mesh whose vertices are vertices of `mesh`.
/// @param mesh  connected, manifold, oriented
/// Source: thesis §3.1.2, iterated cut augmentation; there the triangle most stretched by a Floater map is
/// the candidate, and the first failure ends the search.
Extrema findExtrema(const Mesh& mesh, const ExtremaOptions& options = {}, const Progress& progress = {});

/// The same for a mesh that is simplified already.
Extrema findExtrema(const SimplifiedMesh& coarse, const ExtremaOptions& options, const Progress& progress);

/// Four vertices that starCut opens a closed surface of genus 0 to.
struct StarTips
{
    std::vector<int> vertices; ///< four, or none where no star was found
    double energy = 0;         ///< quarticStretchEnergy of the simplified mesh in the octahedral layout
};

/// Tips far from each other: each is the vertex farthest from those before; for the last, the two next
/// farthest are tried too, on the simplified mesh.
StarTips findStarTips(const SimplifiedMesh& coarse);

} // namespace gimg

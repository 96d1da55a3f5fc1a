#pragma once

#include "gimg/mesh.h"
#include "gimg/result.h"

#include <vector>

namespace gimg {

/// How much `neighbour` counts in the mean that `vertex` is at. Those of one pair add up.
struct MeanWeight
{
    int vertex, neighbour;
    double weight; ///< >= 0
};

enum class Weights
{
    Symmetric, ///< every pair occurs both ways with the same weight
    General,
};

/// Places every vertex that is not fixed and that `weights` mention at the weighted mean of its neighbours.
/// @param fixed     per vertex: position given
/// @param position  per vertex: positions of the fixed vertices on entry, of all on return
/// Errors: FlippedTriangle if the linear system could not be solved.
Status placeAtMeans(const std::vector<MeanWeight>& weights, Weights kind, const std::vector<bool>& fixed,
                    std::vector<Vec2>& position);

} // namespace gimg

#pragma once

#include "border.h"

namespace gimg::codec {

constexpr std::uint32_t kDiffusionRings = 16;

/// Makes glued samples of one component equal, by averaging, and spreads what that changed into the
/// interior if `diffuse` is true.
/// @param samples  grid x grid
/// @param classes  borderClasses() of the grid
/// @param scratch  2 * borderSize(grid) numbers
void fuseBorder(double* samples, std::uint32_t grid, const std::uint32_t* classes, bool diffuse,
                double* scratch);

} // namespace gimg::codec

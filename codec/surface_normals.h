#pragma once

#include "border.h"

#include <cstddef>
#include <cstdint>

namespace gimg::codec {

/// Numbers of scratch for estimateNormals().
constexpr std::size_t normalScratch(std::uint32_t grid)
{
    return 6 * (std::size_t{grid} + 1) + 3 * std::size_t{borderSize(grid)};
}

/// Unit normals of the surface at the samples of a level: of the area vectors of the cells around a point,
/// glued ones too, summed. A cell's area vector is half the cross product of its diagonals, whichever of them
/// splits it; so this is the area-weighted mean of the normals of its triangles, where each cell counts as a
/// whole. (0, 0, 1) where the sum vanishes.
/// @param grid      samples a side of the level
/// @param stride    from one sample of the level to the next, in the finest grid
/// @param fineGrid  samples a side of the finest grid
/// @param xyz       3 fineGrid^2 floats
/// @param classes   borderClasses() of `grid`, or nullptr if nothing is glued
/// @param scratch   normalScratch(grid) numbers
/// @param normals   receives three floats where `xyz` has a sample of the level; the others are left alone
void estimateNormals(std::uint32_t grid, std::uint32_t stride, std::uint32_t fineGrid, const float* xyz,
                     const std::uint32_t* classes, double* scratch, float* normals);

} // namespace gimg::codec

#pragma once

#include "border.h"

namespace gimg::codec {

/// Numbers the vertices of a level by first appearance in rows; glued samples are one vertex.
/// @param grid     samples a side of the level
/// @param stride   from one sample of the level to the next, in the finest grid
/// @param fineGrid samples a side of the finest grid
/// @param classes  borderClasses() of `grid`, or nullptr to keep one vertex a sample
/// @param scratch  borderSize(grid) entries
/// @param vertexOfSample  grid^2 entries
/// @param sampleOfVertex  one entry a vertex, or nullptr
/// @return how many vertices there are
std::uint32_t numberVertices(std::uint32_t grid, std::uint32_t stride, std::uint32_t fineGrid,
                             const std::uint32_t* classes, std::uint32_t* scratch,
                             std::uint32_t* vertexOfSample, std::uint32_t* sampleOfVertex);

/// Splits each cell into two triangles, counter-clockwise. Cells at the border are split so that no two
/// seam edges can become one; the others along their shorter diagonal.
void triangulate(std::uint32_t grid, std::uint32_t stride, std::uint32_t fineGrid, const float* xyz,
                 const std::uint32_t* vertexOfSample, std::uint32_t* triangles);

/// The number of distinct border positions after gluing.
std::uint32_t countClasses(const std::uint32_t* classes, std::uint32_t size);

} // namespace gimg::codec

#pragma once

#include "gim.h"

#include <cstdint>

namespace gimg::codec {

/// The border of an n x n grid, numbered counter-clockwise from (0, 0).
constexpr std::uint32_t borderSize(std::uint32_t grid) { return 4 * (grid - 1); }

struct GridPoint
{
    std::uint32_t i, j;
};

inline GridPoint borderPoint(std::uint32_t grid, std::uint32_t position)
{
    const std::uint32_t last = grid - 1;
    const std::uint32_t along = position % last;
    switch (position / last) {
    case 0:
        return {along, 0};
    case 1:
        return {last, along};
    case 2:
        return {last - along, last};
    default:
        return {0, last - along};
    }
}

inline std::uint32_t borderSample(std::uint32_t grid, std::uint32_t position)
{
    const GridPoint point = borderPoint(grid, position);
    return point.j * grid + point.i;
}

/// The border position of a sample that is on the border.
inline std::uint32_t borderPosition(std::uint32_t grid, std::uint32_t i, std::uint32_t j)
{
    const std::uint32_t last = grid - 1;
    if (j == 0) return i;
    if (i == last) return last + j;
    if (j == last) return 3 * last - i;
    return 4 * last - j;
}

inline bool onBorder(std::uint32_t grid, std::uint32_t i, std::uint32_t j)
{
    return i == 0 || j == 0 || i == grid - 1 || j == grid - 1;
}

/// The seam as a run of sides around the border of the lowest level's grid.
struct SeamView
{
    const gim_side* sides = nullptr;
    std::uint32_t count = 0;
    std::uint32_t start = 0;
    std::uint32_t lowest = 0;
};

/// For each border position of a grid, the smallest position it is glued to (itself if none smaller).
/// @param grid   any size of which the seam's lowest grid is a subsampling
/// @param first  scratch, one entry a path label (at most seam.count)
/// @param out    borderSize(grid) entries
void borderClasses(const SeamView& seam, std::uint32_t grid, std::uint32_t* first, std::uint32_t* out);

struct Topology
{
    std::uint32_t paths = 0;
    std::uint32_t cutNodes = 0;
    std::uint32_t genus = 0;
    std::uint32_t loops = 0;
};

/// Walks around the cut-nodes and along the boundary.
/// @param scratch  2 entries a side
Topology seamTopology(const SeamView& seam, std::uint32_t* scratch);

} // namespace gimg::codec

#pragma once

#include "gim.h"

#include <cstdint>
#include <string>
#include <vector>

namespace gimg::codec {

/// A seam as an encoder holds it: sides around the border of the lowest level's grid.
struct Seam
{
    std::uint32_t lowest = 0; ///< samples a side of the lowest level, 2^l + 1
    std::uint32_t start = 0;  ///< border position of the first side, in steps of that grid
    std::vector<gim_side> sides;
};

/// Why the sides do not make a seam, naming the side; empty if they do.
std::string seamFault(const Seam& seam);

/// For each border position of a grid, the smallest position it is glued to (itself if none smaller).
/// The seam must be without fault, and `grid` a refinement of its lowest grid.
std::vector<std::uint32_t> borderClasses(const Seam& seam, std::uint32_t grid);

struct SeamTopology
{
    std::uint32_t genus = 0;
    std::uint32_t boundaryLoops = 0;
    std::uint32_t cutNodes = 0;
    std::uint32_t paths = 0;
};
SeamTopology topologyOf(const Seam& seam);

/// Whether the triangulated grid, glued along the seam, is a simplicial surface: every edge has two
/// different ends, and no two edges have the same two. Counting pairs of vertices then gives the right
/// Euler number. Depends on the seam alone; takes O(n log n) for a grid of n samples a side.
bool seamIsSimplicial(const gim_side* sides, std::uint32_t count, std::uint32_t start, std::uint32_t lowest,
                      std::uint32_t grid);

/// The coded word, as it stands in a file.
std::vector<std::uint8_t> encodeSeam(const Seam& seam);

} // namespace gimg::codec

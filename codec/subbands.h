#pragma once

#include <cstddef>
#include <cstdint>

namespace gimg::codec {

/// The coarsest image a grid is taken down to.
constexpr std::uint32_t kCoarsest = 3;

/// Wavelet coefficients of an n x n grid fill an n x n plane. A level of size 2m-1 has its coarser
/// image in [0, m)^2 and its three bands of details around it:
///     coarse      Horizontal
///     Vertical    Diagonal
enum Orientation : unsigned
{
    Horizontal = 0, ///< differences along i
    Vertical = 1,   ///< differences along j
    Diagonal = 2,
};

struct Subband
{
    std::uint32_t i0, j0, width, height;
};

constexpr Subband subband(std::uint32_t coarse, unsigned orientation)
{
    const std::uint32_t m = coarse;
    if (orientation == Horizontal) return {m, 0, m - 1, m};
    if (orientation == Vertical) return {0, m, m, m - 1};
    return {m, m, m - 1, m - 1};
}

} // namespace gimg::codec

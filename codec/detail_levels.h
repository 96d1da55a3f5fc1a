#pragma once

#include "border.h"
#include "coefficients.h"
#include "glued_border.h"
#include "surface_blocks.h"

namespace gimg::codec {

/// Details are kept where they lie in their level, with a margin of zeros around.
constexpr std::uint32_t kCodedMargin = 4;
constexpr std::size_t codedPitch(std::uint32_t grid) { return std::size_t{grid} + 2 * kCodedMargin; }
constexpr std::size_t codedSize(std::uint32_t grid) { return codedPitch(grid) * codedPitch(grid); }
inline std::size_t codedIndex(std::uint32_t grid, std::uint32_t i, std::uint32_t j)
{
    return (j + kCodedMargin) * codedPitch(grid) + i + kCodedMargin;
}

/// A detail's magnitude has at most so many bits.
constexpr unsigned kDetailBits = 30;

/// The quantised details of one level, as far as they are known.
struct DetailLevel
{
    std::uint32_t size = 0; ///< samples a side
    std::int32_t*
        q[kComponents]; ///< codedSize(size), in steps; the lowest `missing` bits of magnitudes are 0
    std::uint8_t* known[kComponents]; ///< codedSize(size): magnitudes without the missing bits, at most 255
    unsigned missing = 0;
    bool isFilled = false; ///< a detail is not 0
    BlockMap blocks;       ///< where
};

/// The quantised details of all levels, the coarsest first.
struct DetailLevels
{
    DetailLevel level[kLevels];
    unsigned count = 0;

    /// @param take  take(pointer, count) sets a pointer to so many zeros
    template <class Take> void layOut(std::uint32_t grid, Take&& take)
    {
        for (std::uint32_t n = 2 * kCoarsest - 1; n <= grid; n = 2 * n - 1, ++count) {
            DetailLevel& made = level[count];
            made.size = n;
            for (unsigned c = 0; c < kComponents; ++c) {
                take(made.q[c], codedSize(n));
                take(made.known[c], codedSize(n));
            }
            std::uint8_t* flags = nullptr;
            take(flags, BlockMap::memory(n));
            made.blocks = BlockMap(flags, n);
        }
    }

    /// Back to zeros, of which nothing is known.
    void clear()
    {
        for (unsigned l = 0; l < count; ++l) {
            DetailLevel& cleared = level[l];
            for (unsigned c = 0; c < kComponents; ++c) {
                std::memset(cleared.q[c], 0, codedSize(cleared.size) * sizeof *cleared.q[c]);
                std::memset(cleared.known[c], 0, codedSize(cleared.size));
            }
            cleared.blocks.clear();
            cleared.missing = 0;
            cleared.isFilled = false;
        }
    }
};

/// The positions of an orientation's band in a level.
constexpr std::uint32_t firstColumn(unsigned orientation) { return orientation == Vertical ? 0 : 1; }
constexpr std::uint32_t firstRow(unsigned orientation) { return orientation == Horizontal ? 0 : 1; }

/// The border position that a detail shares, or GluedBorder::kNoMate; and whether it is the one met first,
/// which is coded.
struct SharedDetail
{
    std::uint32_t mate;
    bool isFirst;
};

/// @param border  nullptr: this level's details are not glued
inline SharedDetail sharedDetail(const GluedBorder* border, std::uint32_t n, unsigned orientation,
                                 std::uint32_t i, std::uint32_t j)
{
    const std::uint32_t last = n - 1;
    SharedDetail shared = {GluedBorder::kNoMate, true};
    if (border == nullptr || (i > 0 && j > 0 && i < last && j < last)) return shared;
    shared.mate = border->mateOf(n, borderPosition(n, i, j));
    if (shared.mate == GluedBorder::kNoMate) return shared;
    const GridPoint other = borderPoint(n, shared.mate);
    const unsigned otherBand = other.i % 2 == 0 ? Vertical : Horizontal;
    shared.isFirst = !(otherBand < orientation ||
                       (otherBand == orientation && (other.j < j || (other.j == j && other.i < i))));
    return shared;
}

/// Calls visit(orientation, i, j, shared, bi, bj) for the details of a level that are coded, in their order,
/// until it returns false.
/// @param isWanted  isWanted(bi, bj): whether any detail of the block is
/// @return false: a visit did
template <class IsWanted, class Visit>
bool visitDetails(const GluedBorder* border, std::uint32_t n, const IsWanted& isWanted, const Visit& visit)
{
    const std::uint32_t side = BlockMap::side(n);
    for (unsigned orientation = 0; orientation < 3; ++orientation)
        for (std::uint32_t j = firstRow(orientation); j < n; j += 2) {
            const std::uint32_t bj = BlockMap::blockOf(j, side);
            for (std::uint32_t bi = 0; bi < side; ++bi) {
                if (!isWanted(bi, bj)) continue;
                const std::uint32_t end = bi + 1 == side ? n : (bi + 1) * BlockMap::kBlock;
                for (std::uint32_t i = bi * BlockMap::kBlock + firstColumn(orientation); i < end; i += 2) {
                    const SharedDetail shared = sharedDetail(border, n, orientation, i, j);
                    if (shared.isFirst && !visit(orientation, i, j, shared, bi, bj)) return false;
                }
            }
        }
    return true;
}

} // namespace gimg::codec

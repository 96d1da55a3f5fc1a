#pragma once

#include "border.h"
#include "exp_golomb.h"

#include <cstring>

namespace gimg::codec {

/// Models of the seam's word.
struct SeamModels
{
    BitModel isMate[2];     ///< [the side before opened a path]
    BitModel isBoundary[2]; ///< [the side before was boundary]
    ExpGolombModels<15> rank;
    ExpGolombModels<15> length;
};

/// Codes the word: the start, and then sides until the border is full and no path is open.
///
/// A side that closes a path names it by how recently it was opened: 0 is the newest open one.
/// @param seam   lowest is given; a decoder fills in start and count, an encoder reads them
/// @param sides  a decoder writes them, at most `capacity`; an encoder reads them
/// @param open   scratch, `capacity` entries
/// @return false if a decoder met more sides than `capacity`; a word that breaks a rule fails the coder
template <class Coder>
bool codeSeam(Coder& coder, SeamView& seam, gim_side* sides, std::uint32_t capacity, std::uint32_t* open)
{
    SeamModels models;
    const std::uint32_t total = borderSize(seam.lowest);
    seam.start = coder.raw(log2Floor(total), seam.start);

    std::uint32_t openCount = 0, paths = 0, used = 0, reserved = 0, count = 0;
    // `reserved` is what the open paths' mates will still use of the border.
    while (used < total) {
        if (count == capacity) return false;
        gim_side& side = sides[count];
        if (Coder::kDecodes) side = {};
        const std::uint32_t before = count == 0 ? 2u : sides[count - 1].kind;
        const std::uint32_t left = total - used - reserved;
        // Without room for another path, or without an open one, the kind is known.
        const bool mate = left == 0 || (openCount > 0 && coder.bit(models.isMate[before == GIM_SIDE_FIRST],
                                                                   side.kind == GIM_SIDE_MATE));
        if (mate) {
            std::uint32_t rank = 0;
            if (!Coder::kDecodes)
                while (rank + 1 < openCount && sides[open[openCount - 1 - rank]].path != side.path) ++rank;
            if (openCount > 1) rank = static_cast<std::uint32_t>(codeExpGolomb(coder, models.rank, rank));
            if (rank >= openCount) return coder.fail(), true;
            const std::uint32_t at = openCount - 1 - rank;
            const gim_side& first = sides[open[at]];
            side = {first.path, first.length, GIM_SIDE_MATE};
            std::memmove(open + at, open + at + 1, (openCount - 1 - at) * sizeof *open);
            --openCount;
            reserved -= side.length;
        } else {
            const bool boundary = left == 1 || coder.bit(models.isBoundary[before == GIM_SIDE_BOUNDARY],
                                                         side.kind == GIM_SIDE_BOUNDARY);
            const auto length = static_cast<std::uint32_t>(
                                    codeExpGolomb(coder, models.length, std::uint64_t{side.length} - 1)) +
                                1;
            side = {paths++, length, boundary ? GIM_SIDE_BOUNDARY : GIM_SIDE_FIRST};
            if (length > (boundary ? left : left / 2)) return coder.fail(), true;
            if (!boundary) {
                open[openCount++] = count;
                reserved += length;
            }
        }
        used += side.length;
        ++count;
        if (coder.failed()) return true;
    }
    seam.sides = sides;
    seam.count = count;
    return true;
}

} // namespace gimg::codec

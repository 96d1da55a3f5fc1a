#pragma once

#include "detail_models.h"

namespace gimg::codec {

/// Codes which blocks of a level hold details that are not 0 down to the pass's bit.
/// @param whole  see codePass()
/// @return false: the bytes have ended
template <class Coder, class Whole>
bool codeBlocks(Coder& coder, DetailModels& models, DetailLevels& levels, unsigned components, unsigned l,
                unsigned pass, const Whole& whole)
{
    constexpr int kHalf = BlockMap::kBlock / 2;
    const unsigned directions = components == 1 ? 1 : kDirections;
    BlockMap& blocks = levels.level[l].blocks;
    const std::uint32_t m = levels.level[l].size / 2 + 1;
    const auto row = static_cast<std::ptrdiff_t>(codedPitch(m));
    for (std::uint32_t bj = 0; bj < blocks.side(); ++bj)
        for (std::uint32_t bi = 0; bi < blocks.side(); ++bi) {
            if (blocks.isFilled(bi, bj, 0) && (directions == 1 || blocks.isFilled(bi, bj, 1))) continue;
            // The coarser level's details below the block, and those one further.
            unsigned below[kDirections] = {}, ring[kDirections] = {};
            if (l > 0)
                for (unsigned c = 0; c < components; ++c) {
                    const std::uint8_t* corner =
                        levels.level[l - 1].known[c] + codedIndex(m, bi * kHalf, bj * kHalf);
                    for (int dj = -2; dj <= kHalf + 2; ++dj)
                        for (int di = -2; di <= kHalf + 2; ++di) {
                            const bool inside = di >= 0 && di <= kHalf && dj >= 0 && dj <= kHalf;
                            (inside ? below : ring)[c == 0 ? 0 : 1] += corner[dj * row + di];
                        }
                }
            unsigned before = 0;
            for (unsigned d = 0; d < directions; ++d) {
                if (!blocks.isFilled(bi, bj, d)) {
                    const unsigned around = blocks.around(bi, bj, d);
                    const unsigned b = quickClass<13>(below[d]), r = quickClass<13>(ring[d]);
                    BitModel* const mixed[kBlockModels] = {&models.blockByLevel[d][before][l][around],
                                                           &models.blockByParents[d][before][around][b],
                                                           &models.blockByRing[d][before][b < 9 ? b : 9][r]};
                    const bool fills = codeMixed(coder, mixed, models.blockWeights[d][before],
                                                 whole.isFilled(l, bi, bj, d, pass));
                    if (coder.hasEnded()) return false;
                    if (!fills) continue;
                    blocks.fill(bi, bj, d);
                }
                before = 1;
            }
        }
    return true;
}

/// Codes one more bit of all details.
///
/// In pass k a detail is known down to bit k if its turn has come, else down to bit k + 1. Coarse levels come
/// first.
/// @param whole  asked of encoders: whole.isEmpty(level, pass), whole.isFilled(level, bi, bj, direction,
/// pass):
///               whether the level, or the block's normal (0) or tangential (1) details, have a bit from
///               `pass` on; whole(level, component, index) is a detail
/// @return false: the bytes have ended, and what was not read whole is left as it was
template <class Coder, class Whole>
bool codePass(Coder& coder, DetailModels& models, DetailLevels& levels, const GluedBorder& border,
              unsigned components, unsigned pass, const Whole& whole)
{
    for (unsigned l = 0; l < levels.count; ++l) {
        DetailLevel& level = levels.level[l];
        const std::uint32_t n = level.size, m = n / 2 + 1;
        level.missing = pass;
        if (level.isFilled) {
            for (std::uint8_t* known : level.known)
                for (std::size_t k = 0; k < codedSize(n); ++k)
                    known[k] = known[k] < 128 ? static_cast<std::uint8_t>(2 * known[k]) : std::uint8_t{255};
        } else {
            const bool empty = coder.bit(models.levelIsEmpty[l], whole.isEmpty(l, pass));
            if (coder.hasEnded()) return false;
            if (empty) continue;
            level.isFilled = true;
        }
        if (!codeBlocks(coder, models, levels, components, l, pass, whole)) return false;

        const DetailLevel* coarser = l > 0 ? &levels.level[l - 1] : nullptr;
        const DetailLevel* finer =
            l + 1 < levels.count && levels.level[l + 1].isFilled ? &levels.level[l + 1] : nullptr;
        DetailPlace place;
        place.row = static_cast<std::ptrdiff_t>(codedPitch(n));
        place.parentRow = static_cast<std::ptrdiff_t>(codedPitch(m));
        place.childRow = static_cast<std::ptrdiff_t>(codedPitch(2 * n - 1));
        place.level = l;
        const GluedBorder* glued = border.isGluedAt(m) ? &border : nullptr;
        const auto codeOne = [&](unsigned orientation, std::uint32_t i, std::uint32_t j,
                                 const SharedDetail& shared, std::uint32_t bi, std::uint32_t bj) {
            const std::size_t index = codedIndex(n, i, j);
            const std::size_t parent = codedIndex(m, i / 4 * 2 + i % 2, j / 4 * 2 + j % 2);
            const std::size_t children = codedIndex(2 * n - 1, i / 2 * 4 + i % 2, j / 2 * 4 + j % 2);
            place.orientation = orientation;
            for (unsigned c = 0; c < kComponents; ++c) place.known[c] = level.known[c] + index;
            for (unsigned c = 0; c < components; ++c) {
                if (!level.blocks.isFilled(bi, bj, c == 0 ? 0 : 1)) continue;
                place.parent = coarser == nullptr ? nullptr : coarser->known[c] + parent;
                place.children = finer == nullptr ? nullptr : finer->known[c] + children;
                const Surroundings around = surroundingsOf(place, c);
                const std::int32_t exact = whole(l, c, index);
                const auto size = static_cast<std::uint32_t>(magnitudeOf(exact) >> pass);
                std::int32_t& q = level.q[c][index];
                std::int32_t more = 0;
                if (q != 0) {
                    const bool bit = codeNext(coder, models, around, *place.known[c], (size & 1u) != 0);
                    if (bit) more = q < 0 ? -(1 << pass) : 1 << pass;
                } else if (codeGrowth(coder, models, place, around, c, size != 0)) {
                    const bool negative =
                        codeDetailSign(coder, models, place, &q,
                                       coarser == nullptr ? nullptr : coarser->q[c] + parent, c, exact < 0);
                    more = negative ? -(1 << pass) : 1 << pass;
                }
                if (coder.hasEnded()) return false;
                if (more == 0) continue;
                q += more;
                std::uint8_t& known = level.known[c][index];
                if (known < 255) ++known;
                if (shared.mate == GluedBorder::kNoMate) continue;
                const GridPoint other = borderPoint(n, shared.mate);
                const std::size_t copy = codedIndex(n, other.i, other.j);
                level.q[c][copy] = q;
                level.known[c][copy] = known;
            }
            return true;
        };
        const bool goesOn = visitDetails(
            glued, n,
            [&](std::uint32_t bi, std::uint32_t bj) {
                return level.blocks.isFilled(bi, bj, 0) || level.blocks.isFilled(bi, bj, 1);
            },
            codeOne);
        if (!goesOn) return false;
    }
    return true;
}

/// Codes the quantised details of a surface, or of up to three channels of a field, after their coarse image.
/// @param levels  all zero
/// @param passes  how many there are: the bits of the largest magnitude; of encoders
/// Failure shows in the coder.
template <class Coder, class Whole>
void codeDetails(Coder& coder, DetailModels& models, const GluedBorder& border, unsigned components,
                 QuantizedImage& coarse, DetailLevels& levels, unsigned passes, const Whole& whole)
{
    passes = coder.raw(5, passes);
    if (passes > kDetailBits) return coder.fail();
    detail::codeCoarse(coder, models.coarse, coarse, components);
    while (passes > 0 && !coder.failed() && !coder.hasEnded())
        if (!codePass(coder, models, levels, border, components, --passes, whole)) return;
}

} // namespace gimg::codec

#pragma once

#include "byte_sums.h"
#include "detail_models.h"

namespace gimg::codec {

/// Sums of the coarser level's magnitudes below a block, 5 x 5, and around those, 9 x 9 without them.
struct BlockParents
{
    unsigned below[kDirections] = {}, ring[kDirections] = {};

    BlockParents(const DetailLevels& levels, unsigned components, unsigned l, std::uint32_t bi,
                 std::uint32_t bj)
    {
        if (l == 0) return;
        constexpr std::uint8_t kBelow[8] = {0, 0, 255, 255, 255, 255, 255, 0};
        constexpr std::uint32_t kHalf = BlockMap::kBlock / 2;
        const std::uint32_t m = levels.level[l].size / 2 + 1;
        const std::uint64_t isBelow = eightBytes(kBelow);
        for (unsigned c = 0; c < components; ++c) {
            const std::uint8_t* row =
                levels.level[l - 1].known[c] + codedIndex(m, bi * kHalf, bj * kHalf) - 2 * codedPitch(m) - 2;
            ByteSums all, inner;
            unsigned last = 0;
            for (unsigned j = 0; j < 9; ++j, row += codedPitch(m)) {
                const std::uint64_t eight = eightBytes(row);
                all.add(eight);
                last += row[8];
                if (j >= 2 && j < 7) inner.add(eight & isBelow);
            }
            below[c == 0 ? 0 : 1] += inner.total();
            ring[c == 0 ? 0 : 1] += all.total() + last - inner.total();
        }
    }
};

/// Codes which blocks of a level hold details that are not 0 down to the pass's bit.
/// @param whole  see codePass()
/// @return false: the bytes have ended
template <class Coder, class Whole>
bool codeBlocks(Coder& coder, DetailModels& models, DetailLevels& levels, unsigned components, unsigned l,
                unsigned pass, const Whole& whole)
{
    const unsigned directions = components == 1 ? 1 : kDirections;
    BlockMap& blocks = levels.level[l].blocks;
    for (std::uint32_t bj = 0; bj < blocks.side(); ++bj)
        for (std::uint32_t bi = 0; bi < blocks.side(); ++bi) {
            if (blocks.isFilled(bi, bj, 0) && (directions == 1 || blocks.isFilled(bi, bj, 1))) continue;
            const BlockParents parents(levels, components, l, bi, bj);
            unsigned before = 0;
            for (unsigned d = 0; d < directions; ++d) {
                if (!blocks.isFilled(bi, bj, d)) {
                    const unsigned around = blocks.around(bi, bj, d);
                    const unsigned b = quickClass<13>(parents.below[d]), r = quickClass<13>(parents.ring[d]);
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

/// Codes one more bit of the details of a band of a level. What does not change within a band is known when
/// this is compiled, or kept by value: stores of magnitudes, which are bytes, may alias all that is behind a
/// pointer.
template <unsigned Orientation, bool HasChildren, class Coder, class Whole> class BandPass
{
public:
    BandPass(Coder& coder, DetailModels& models, DetailLevels& levels, const GluedBorder* glued,
             unsigned components, unsigned l, unsigned pass, const Whole& whole)
        : coder_(coder), models_(models), level_(levels.level[l]), glued_(glued), whole_(whole), l_(l),
          pass_(pass), components_(components), n_(level_.size), side_(BlockMap::side(n_)),
          row_(static_cast<std::ptrdiff_t>(codedPitch(n_))),
          parentRow_(static_cast<std::ptrdiff_t>(codedPitch(n_ / 2 + 1))),
          childRow_(static_cast<std::ptrdiff_t>(codedPitch(2 * n_ - 1)))
    {
        for (unsigned c = 0; c < kComponents; ++c) {
            known_[c] = level_.known[c];
            q_[c] = level_.q[c];
            parent_[c] = l > 0 ? levels.level[l - 1].known[c] : nullptr;
            parentQ_[c] = l > 0 ? levels.level[l - 1].q[c] : nullptr;
            children_[c] = HasChildren ? levels.level[l + 1].known[c] : nullptr;
        }
    }

    /// @return false: the bytes have ended
    bool run()
    {
        const std::uint32_t last = n_ - 1;
        for (std::uint32_t j = firstRow(Orientation); j < n_; j += 2) {
            const std::uint32_t bj = BlockMap::blockOf(j, side_);
            const bool onBorder = glued_ != nullptr && (j == 0 || j == last);
            for (std::uint32_t bi = 0; bi < side_; ++bi) {
                const unsigned filled = level_.blocks.flags(bi, bj);
                if (filled == 0) continue;
                std::uint32_t i = bi * BlockMap::kBlock + firstColumn(Orientation);
                std::uint32_t end = bi + 1 == side_ ? n_ : (bi + 1) * BlockMap::kBlock;
                if (glued_ != nullptr && Orientation == Vertical) {
                    if (bi == 0) {
                        if (!codeOnBorder(i, j, filled)) return false;
                        i += 2;
                    }
                    if (bi + 1 == side_) --end;
                }
                if (filled == 1 && !onBorder && i + 2 * (kRun - 1) < end && isQuietRun(i, j)) {
                    if (!codeRun(i, j)) return false;
                    i += 2 * kRun;
                }
                for (; i < end; i += 2)
                    if (!(onBorder ? codeOnBorder(i, j, filled) : codePlace(i, j, filled))) return false;
                if (glued_ != nullptr && Orientation == Vertical && bi + 1 == side_)
                    if (!codeOnBorder(last, j, filled)) return false;
            }
        }
        return true;
    }

private:
    std::size_t parentIndex(std::uint32_t i, std::uint32_t j) const
    {
        return (j / 4 * 2 + j % 2 + kCodedMargin) * static_cast<std::size_t>(parentRow_) + i / 4 * 2 + i % 2 +
               kCodedMargin;
    }

    std::size_t childIndex(std::uint32_t i, std::uint32_t j) const
    {
        return (j / 2 * 4 + j % 2 + kCodedMargin) * static_cast<std::size_t>(childRow_) + i / 2 * 4 + i % 2 +
               kCodedMargin;
    }

    /// Whether the run that begins here, and all its neighbours in the band, have no detail along the normal.
    bool isQuietRun(std::uint32_t i, std::uint32_t j) const
    {
        const std::uint8_t* q = known_[0] + codedIndex(n_, i, j);
        std::uint64_t any = 0;
        for (const std::ptrdiff_t row : {-2 * row_, std::ptrdiff_t{0}, 2 * row_})
            any |= eightBytes(q + row - 2) | eightBytes(q + row + 2);
        return everySecond(any) == 0;
    }

    RunSurroundings runSurroundings(std::uint32_t i, std::uint32_t j) const
    {
        const std::uint8_t* q = known_[0] + codedIndex(n_, i, j);
        RunSurroundings s = {};
        // Those of the band itself are 0, and so are the coarser level's places.
        ByteSums siblings;
        for (const std::ptrdiff_t row : {-row_, std::ptrdiff_t{0}, row_}) {
            siblings.add(eightBytes(q + row - 1));
            s.siblings += q[row + 7];
        }
        s.siblings += siblings.total();
        if (l_ > 0) {
            const std::uint8_t* p = parent_[0] + parentIndex(i, j);
            const std::ptrdiff_t up = 2 * parentRow_;
            s.parents = 3 * (unsigned{p[0]} + p[2]) + p[-2] + p[4] + p[-up] + p[2 - up] + p[up] + p[up + 2];
        }
        if (HasChildren) {
            const std::uint8_t* p = children_[0] + childIndex(i, j);
            ByteSums below;
            for (const std::ptrdiff_t row : {std::ptrdiff_t{0}, 2 * childRow_})
                for (const std::ptrdiff_t half : {0, 8}) below.add(everySecond(eightBytes(p + row + half)));
            s.below = below.total();
        }
        return s;
    }

    /// Codes the details of a quiet run along the normal: whether there is any, which is the first, and
    /// those after it like others.
    bool codeRun(std::uint32_t i, std::uint32_t j)
    {
        const std::size_t index = codedIndex(n_, i, j);
        const auto grows = [&](unsigned k) {
            return magnitudeOf(whole_(l_, 0, index + 2 * k)) >> pass_ != 0;
        };
        bool any = false;
        if (!Coder::kDecodes)
            for (unsigned k = 0; k < kRun; ++k) any = any || grows(k);
        any = codeRunGrowth<Orientation>(coder_, models_, l_, runSurroundings(i, j), any);
        if (coder_.hasEnded()) return false;
        if (!any) return true;

        unsigned sums[kRun], after = 0;
        for (unsigned k = 0; k < kRun; ++k)
            sums[k] =
                surroundings(0, index + 2 * k, parentIndex(i + 2 * k, j), childIndex(i + 2 * k, j)).all();
        for (unsigned k = 1; k < kRun; ++k) after += sums[k];
        unsigned first = 0;
        for (; first + 1 < kRun; ++first) {
            BitModel& model = models_.firstOfRun[first][quickClass<5>(sums[first])][quickClass<5>(after)];
            const bool isFirst = coder_.bit(model, grows(first));
            if (coder_.hasEnded()) return false;
            if (isFirst) break;
            after -= sums[first + 1];
        }
        const std::size_t grown = index + 2 * first;
        const std::int32_t* parent = l_ == 0 ? nullptr : parentQ_[0] + parentIndex(i + 2 * first, j);
        const bool negative = codeDetailSign<Orientation>(coder_, models_, row_, q_[0] + grown, parent, 0,
                                                          whole_(l_, 0, grown) < 0);
        if (coder_.hasEnded()) return false;
        q_[0][grown] = negative ? -(1 << pass_) : 1 << pass_;
        known_[0][grown] = 1;
        for (unsigned k = first + 1; k < kRun; ++k)
            if (!codePlace(i + 2 * k, j, 1)) return false;
        return true;
    }

    bool codeOnBorder(std::uint32_t i, std::uint32_t j, unsigned filled)
    {
        const SharedDetail shared = sharedDetail(glued_, n_, Orientation, i, j);
        if (!shared.isFirst) return true;
        const bool goesOn = codePlace(i, j, filled);
        if (shared.mate == GluedBorder::kNoMate) return goesOn;
        const GridPoint other = borderPoint(n_, shared.mate);
        const std::size_t index = codedIndex(n_, i, j), copy = codedIndex(n_, other.i, other.j);
        for (unsigned c = 0; c < components_; ++c) {
            q_[c][copy] = q_[c][index];
            known_[c][copy] = known_[c][index];
        }
        return goesOn;
    }

    bool codePlace(std::uint32_t i, std::uint32_t j, unsigned filled)
    {
        const std::size_t index = codedIndex(n_, i, j);
        const std::size_t parent = parentIndex(i, j), children = childIndex(i, j);
        for (unsigned c = 0; c < components_; ++c) {
            if ((filled >> (c == 0 ? 0 : 1) & 1u) == 0) continue;
            const Surroundings around = surroundings(c, index, parent, children);
            const std::int32_t exact = whole_(l_, c, index);
            const auto size = static_cast<std::uint32_t>(magnitudeOf(exact) >> pass_);
            const std::int32_t q = q_[c][index];
            const std::uint8_t known = known_[c][index];
            std::int32_t more = 0;
            if (q != 0) {
                const bool bit = codeNext(coder_, models_, around, known, (size & 1u) != 0);
                if (bit) more = q < 0 ? -(1 << pass_) : 1 << pass_;
            } else if (codeGrowth<Orientation>(coder_, models_, l_, around, c, size != 0)) {
                const bool negative =
                    codeDetailSign<Orientation>(coder_, models_, row_, q_[c] + index,
                                                l_ == 0 ? nullptr : parentQ_[c] + parent, c, exact < 0);
                more = negative ? -(1 << pass_) : 1 << pass_;
            }
            if (coder_.hasEnded()) return false;
            if (more == 0) continue;
            q_[c][index] = q + more;
            known_[c][index] = known < 255 ? static_cast<std::uint8_t>(known + 1) : known;
        }
        return true;
    }

    Surroundings surroundings(unsigned component, std::size_t index, std::size_t parent,
                              std::size_t children) const
    {
        const std::ptrdiff_t row = row_, two = 2 * row;
        const std::uint8_t* q = known_[component] + index;
        Surroundings s;
        s.across = unsigned{q[-2]} + q[2];
        s.along = unsigned{q[-two]} + q[two];
        s.diagonals = unsigned{q[-two - 2]} + q[-two + 2] + q[two - 2] + q[two + 2];
        // Of the other bands.
        s.siblings =
            Orientation == Diagonal ? 0u : unsigned{q[-row - 1]} + q[-row + 1] + q[row - 1] + q[row + 1];
        if (Orientation != Vertical) s.siblings += unsigned{q[-row]} + q[row];
        if (Orientation != Horizontal) s.siblings += unsigned{q[-1]} + q[1];
        s.parents = 0;
        if (l_ > 0) {
            const std::uint8_t* p = parent_[component] + parent;
            const std::ptrdiff_t up = 2 * parentRow_;
            s.parents = 2u * p[0] + p[-2] + p[2] + p[-up] + p[up];
        }
        s.below = 0;
        if (HasChildren) {
            const std::uint8_t* p = children_[component] + children;
            const std::ptrdiff_t down = 2 * childRow_;
            s.below = 2 * (unsigned{p[0]} + p[2] + p[down] + p[down + 2]);
        }
        const unsigned here = unsigned{known_[0][index]} + known_[1][index] + known_[2][index];
        s.others = 2 * (here - q[0]);
        return s;
    }

    Coder& coder_;
    DetailModels& models_;
    DetailLevel& level_;
    const GluedBorder* glued_;
    const Whole& whole_;
    const unsigned l_, pass_, components_;
    const std::uint32_t n_, side_;
    const std::ptrdiff_t row_, parentRow_, childRow_;
    std::uint8_t* known_[kComponents];
    std::int32_t* q_[kComponents];
    const std::uint8_t *parent_[kComponents], *children_[kComponents];
    const std::int32_t* parentQ_[kComponents];
};

template <bool HasChildren, class Coder, class Whole>
bool codeBands(Coder& coder, DetailModels& models, DetailLevels& levels, const GluedBorder* glued,
               unsigned components, unsigned l, unsigned pass, const Whole& whole)
{
    return BandPass<Horizontal, HasChildren, Coder, Whole>(coder, models, levels, glued, components, l, pass,
                                                           whole)
               .run() &&
           BandPass<Vertical, HasChildren, Coder, Whole>(coder, models, levels, glued, components, l, pass,
                                                         whole)
               .run() &&
           BandPass<Diagonal, HasChildren, Coder, Whole>(coder, models, levels, glued, components, l, pass,
                                                         whole)
               .run();
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
        const bool hasFiner = l + 1 < levels.count && levels.level[l + 1].isFilled;
        const GluedBorder* glued = border.isGluedAt(m) ? &border : nullptr;
        if (!(hasFiner ? codeBands<true>(coder, models, levels, glued, components, l, pass, whole)
                       : codeBands<false>(coder, models, levels, glued, components, l, pass, whole)))
            return false;
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

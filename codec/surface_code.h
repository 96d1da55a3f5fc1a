#pragma once

#include "lifting.h"
#include "surface_blocks.h"
#include "surface_frame.h"
#include "surface_models.h"

namespace gimg::codec {

/// Memory for coding a surface of grid n.
struct SurfaceWork
{
    double* surface[kComponents];       ///< n^2: the surface; before its details are known, its prediction
    double* detail[kComponents];        ///< n^2
    double* coarse[kComponents];        ///< ((n + 1) / 2)^2
    std::int32_t* coded[kComponents];   ///< codedSize(n): quantised details, where they lie in the surface
    std::int32_t* parents[kComponents]; ///< codedSize(n)
    double* border;                     ///< 2 borderSize(n)
    BlockMap blocks;                    ///< BlockMap::memory(n)
};

constexpr std::uint32_t kCodedMargin = 4;
constexpr std::size_t codedPitch(std::uint32_t grid) { return std::size_t{grid} + 2 * kCodedMargin; }
constexpr std::size_t codedSize(std::uint32_t grid) { return codedPitch(grid) * codedPitch(grid); }
inline std::size_t codedIndex(std::uint32_t grid, std::uint32_t i, std::uint32_t j)
{
    return (j + kCodedMargin) * codedPitch(grid) + i + kCodedMargin;
}

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

inline SharedDetail sharedDetail(const SurfaceLevel& level, unsigned orientation, std::uint32_t i,
                                 std::uint32_t j)
{
    const std::uint32_t n = level.size, last = n - 1;
    SharedDetail shared = {GluedBorder::kNoMate, true};
    if (level.border == nullptr || (i > 0 && j > 0 && i < last && j < last)) return shared;
    shared.mate = level.border->mateOf(n, borderPosition(n, i, j));
    if (shared.mate == GluedBorder::kNoMate) return shared;
    const GridPoint other = borderPoint(n, shared.mate);
    const unsigned otherBand = other.i % 2 == 0 ? Vertical : Horizontal;
    shared.isFirst = !(otherBand < orientation ||
                       (otherBand == orientation && (other.j < j || (other.j == j && other.i < i))));
    return shared;
}

/// Codes which blocks of a level are filled.
/// @param isFilled  isFilled(bi, bj, direction), asked of encoders
template <class Coder, class IsFilled>
void codeBlocks(Coder& coder, SurfaceModels& models, const SurfaceWork& work, const SurfaceLevel& level,
                unsigned components, BlockMap& blocks, const IsFilled& isFilled)
{
    const std::uint32_t m = level.size / 2 + 1;
    constexpr int kHalf = BlockMap::kBlock / 2;
    blocks.begin(level.size);
    for (std::uint32_t bj = 0; bj < blocks.side(); ++bj)
        for (std::uint32_t bi = 0; bi < blocks.side(); ++bi) {
            // The coarser level's details below the block, and those one further.
            std::uint64_t below[kDirections] = {}, ring[kDirections] = {};
            if (level.index > 0)
                for (unsigned c = 0; c < components; ++c) {
                    const std::int32_t* corner =
                        work.parents[c] + codedIndex(m, bi * BlockMap::kBlock / 2, bj * BlockMap::kBlock / 2);
                    for (int dj = -2; dj <= kHalf + 2; ++dj)
                        for (int di = -2; di <= kHalf + 2; ++di) {
                            const std::uint64_t size =
                                sizeAt(corner + dj * static_cast<std::ptrdiff_t>(codedPitch(m)), di);
                            const bool inside = di >= 0 && di <= kHalf && dj >= 0 && dj <= kHalf;
                            (inside ? below : ring)[c == 0 ? 0 : 1] += size;
                        }
                }
            unsigned before = 0;
            for (unsigned d = 0; d < kDirections && d < components; ++d) {
                const unsigned around = blocks.around(bi, bj, d);
                const unsigned b = quickClass<13>(below[d]), r = quickClass<13>(ring[d]);
                BitModel* const mixed[3] = {&models.blockByLevel[d][before][level.index][around],
                                            &models.blockByParents[d][before][around][b],
                                            &models.blockByRing[d][before][b < 9 ? b : 9][r]};
                if (!codeMixed(coder, mixed, models.blockWeights[d][before], isFilled(bi, bj, d))) continue;
                blocks.fill(bi, bj, d);
                before = 1;
            }
        }
}

/// Codes the details of one level. On entry work.surface holds the prediction and work.detail zeros; on
/// return work.detail holds the details as vectors.
/// @param frames  SurfaceFrames or FieldFrames: the axes and steps of details
/// @param pick    pick(coder, context, component, index in the level, frame) codes a detail with
/// codeSurfaceDetail() and returns it; asked of encoders: pick.isEmpty(), of the level, and
/// pick.isFilled(bi, bj, direction), of a block
/// @return whether any block is filled
template <class Coder, class Frames, class Pick>
bool codeLevel(Coder& coder, SurfaceModels& models, const Frames& frames, SurfaceWork& work,
               const SurfaceLevel& level, Pick& pick)
{
    const std::uint32_t n = level.size, m = n / 2 + 1;
    const double* planes[kComponents] = {work.surface[0], work.surface[1], work.surface[2]};
    if (coder.bit(models.levelIsEmpty[level.index], pick.isEmpty())) return false;
    BlockMap& blocks = work.blocks;
    codeBlocks(coder, models, work, level, frames.components(), blocks,
               [&](std::uint32_t bi, std::uint32_t bj, unsigned d) { return pick.isFilled(bi, bj, d); });

    DetailNeighbourhood around;
    around.pitch = codedPitch(n);
    around.parentPitch = codedPitch(m);
    const auto codeOne = [&](unsigned orientation, std::uint32_t i, std::uint32_t j,
                             const bool(&isCoded)[kComponents]) {
        const SharedDetail shared = sharedDetail(level, orientation, i, j);
        if (!shared.isFirst) return;
        const std::size_t place = j * std::size_t{n} + i;
        const std::size_t index = codedIndex(n, i, j);
        const auto frame = frames.at(planes, level, orientation, i, j);
        const std::uint32_t pi = i / 2 / 2 * 2 + i % 2, pj = j / 2 / 2 * 2 + j % 2;
        for (unsigned c = 0; c < kComponents; ++c) {
            around.near[c] = work.coded[c] + index;
            around.parent[c] = level.index == 0 ? nullptr : work.parents[c] + codedIndex(m, pi, pj);
        }
        std::int32_t here[kComponents] = {};
        Vector detail = {0, 0, 0};
        for (unsigned c = 0; c < frames.components(); ++c) {
            if (!isCoded[c]) continue;
            const DetailContext context =
                contextOfDetail(models, around, here, c, orientation, level.index, frames.bend(frame, c));
            const std::int32_t q = pick(coder, context, c, place, frame);
            here[c] = q;
            if (q == 0) continue;
            work.coded[c][index] = q;
            detail = detail + (q * frame.step[c]) * frame.axis[c];
        }
        if (here[0] == 0 && here[1] == 0 && here[2] == 0) return;
        const auto put = [&](std::size_t k) {
            work.detail[0][k] = detail.x;
            work.detail[1][k] = detail.y;
            work.detail[2][k] = detail.z;
        };
        put(place);
        if (shared.mate == GluedBorder::kNoMate) return;
        const GridPoint other = borderPoint(n, shared.mate);
        put(other.j * std::size_t{n} + other.i);
        for (unsigned c = 0; c < kComponents; ++c) work.coded[c][codedIndex(n, other.i, other.j)] = here[c];
    };

    const std::uint32_t side = blocks.side();
    for (unsigned orientation = 0; orientation < 3; ++orientation) {
        const std::uint32_t i0 = firstColumn(orientation);
        for (std::uint32_t j = firstRow(orientation); j < n; j += 2) {
            const std::uint32_t bj = j / BlockMap::kBlock < side ? j / BlockMap::kBlock : side - 1;
            for (std::uint32_t bi = 0; bi < side; ++bi) {
                const bool normal = blocks.isFilled(bi, bj, 0), tangents = blocks.isFilled(bi, bj, 1);
                if (!normal && !tangents) continue;
                const bool isCoded[kComponents] = {normal, tangents, tangents};
                const std::uint32_t end = bi + 1 == side ? n : (bi + 1) * BlockMap::kBlock;
                for (std::uint32_t i = bi * BlockMap::kBlock + i0; i < end; i += 2)
                    codeOne(orientation, i, j, isCoded);
            }
        }
    }
    return true;
}

/// Codes a surface, or up to three channels of a field, coarse to fine; on return work.surface holds it as it
/// will be decoded.
/// @param frames  see codeLevel()
/// @param coarse  the 3 x 3 image in steps: read by encoders, written by decoders
/// @param pick    see codeLevel(); pick.begin(level, prediction) is called before each level
/// Failure shows in the coder.
template <class Coder, class Frames, class Pick>
void codeSurface(Coder& coder, SurfaceModels& models, const Frames& frames, const GluedBorder& border,
                 QuantizedImage& coarse, SurfaceWork& work, Pick& pick)
{
    const std::uint32_t grid = border.grid();
    detail::codeCoarse(coder, models.coarse, coarse, frames.components());
    for (unsigned c = 0; c < kComponents; ++c)
        for (unsigned k = 0; k < kCoarsest * kCoarsest; ++k)
            work.surface[c][k] = static_cast<double>(coarse.coarse[c][k]) * frames.coarseStep();
    if (border.isGluedAt(kCoarsest))
        for (unsigned c = 0; c < kComponents; ++c) border.average(work.surface[c], kCoarsest, work.border);

    SurfaceLevel level;
    for (std::uint32_t m = kCoarsest; m < grid; m = level.size, ++level.index) {
        level.size = 2 * m - 1;
        level.border = border.isGluedAt(m) ? &border : nullptr;
        const std::uint32_t n = level.size;
        const std::size_t count = std::size_t{n} * n;
        for (unsigned c = 0; c < kComponents; ++c) {
            double *coarser = work.coarse[c], *finer = work.surface[c];
            std::memcpy(coarser, finer, std::size_t{m} * m * sizeof *finer);
            std::memset(finer, 0, count * sizeof *finer);
            if (c < frames.components()) {
                for (std::uint32_t j = 0; j < m; ++j)
                    for (std::uint32_t i = 0; i < m; ++i)
                        finer[2 * j * std::size_t{n} + 2 * i] =
                            coarser[j * std::size_t{m} + i] * kInverseAreaScale;
                inverseLifting(finer, n, level.border, work.border);
            }
            std::memset(work.detail[c], 0, count * sizeof *finer);
            std::int32_t* coded = work.parents[c];
            work.parents[c] = work.coded[c];
            work.coded[c] = coded;
            std::memset(coded, 0, codedSize(n) * sizeof *coded);
        }
        const double* planes[kComponents] = {work.surface[0], work.surface[1], work.surface[2]};
        frames.begin(level, planes);
        pick.begin(level, planes);
        if (codeLevel(coder, models, frames, work, level, pick)) {
            for (unsigned c = 0; c < frames.components(); ++c) {
                double *details = work.detail[c], *finer = work.surface[c];
                for (std::uint32_t j = 1; j < n; j += 2)
                    for (std::uint32_t i = 1; i < n; i += 2) details[j * std::size_t{n} + i] *= kAreaScale;
                inverseLifting(details, n, level.border, work.border);
                for (std::size_t k = 0; k < count; ++k) finer[k] += details[k];
            }
        }
        if (level.border == nullptr && border.isGluedAt(n))
            for (unsigned c = 0; c < kComponents; ++c) border.average(work.surface[c], n, work.border);
    }
}

} // namespace gimg::codec

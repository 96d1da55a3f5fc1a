#pragma once

#include "lifting.h"
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
};

constexpr std::uint32_t kCodedMargin = 4;
constexpr std::size_t codedPitch(std::uint32_t grid) { return std::size_t{grid} + 2 * kCodedMargin; }
constexpr std::size_t codedSize(std::uint32_t grid) { return codedPitch(grid) * codedPitch(grid); }
inline std::size_t codedIndex(std::uint32_t grid, std::uint32_t i, std::uint32_t j)
{
    return (j + kCodedMargin) * codedPitch(grid) + i + kCodedMargin;
}

/// Codes the details of one level. On entry work.surface holds the prediction and work.detail zeros; on
/// return work.detail holds the details as vectors.
/// @param pick  pick(coder, context, component, index in the level, frame) codes a detail with
/// codeSurfaceDetail() and
///              returns it; pick.isEmpty(orientation, component): an encoder knows that the band holds zeros
///              only
/// @return whether any detail is not 0
template <class Coder, class Pick>
bool codeLevel(Coder& coder, SurfaceModels& models, const SurfaceParameters& parameters, SurfaceWork& work,
               const SurfaceLevel& level, Pick& pick)
{
    const std::uint32_t n = level.size, last = n - 1, m = n / 2 + 1;
    const double* planes[kComponents] = {work.surface[0], work.surface[1], work.surface[2]};
    bool any = false;
    for (unsigned orientation = 0; orientation < 3; ++orientation) {
        bool isEmpty[kComponents];
        for (unsigned c = 0; c < kComponents; ++c)
            isEmpty[c] = coder.bit(models.bandIsEmpty[c][level.index], pick.isEmpty(orientation, c));
        if (isEmpty[0] && isEmpty[1] && isEmpty[2]) continue;
        any = true;
        const std::uint32_t i0 = orientation == Vertical ? 0 : 1, j0 = orientation == Horizontal ? 0 : 1;
        for (std::uint32_t j = j0; j < n; j += 2)
            for (std::uint32_t i = i0; i < n; i += 2) {
                const std::size_t place = j * std::size_t{n} + i;
                const std::size_t index = codedIndex(n, i, j);
                std::uint32_t mate = GluedBorder::kNoMate;
                if (level.border != nullptr && (i == 0 || j == 0 || i == last || j == last)) {
                    mate = level.border->mateOf(n, borderPosition(n, i, j));
                    if (mate != GluedBorder::kNoMate) {
                        // The one met first is coded.
                        const GridPoint other = borderPoint(n, mate);
                        const unsigned otherBand = other.i % 2 == 0 ? Vertical : Horizontal;
                        const bool isLater =
                            otherBand < orientation ||
                            (otherBand == orientation && (other.j < j || (other.j == j && other.i < i)));
                        if (isLater) continue;
                    }
                }
                const Frame frame = frameAt(planes, level, parameters, orientation, i, j);
                DetailNeighbourhood around;
                around.pitch = codedPitch(n);
                around.parentPitch = codedPitch(m);
                const std::uint32_t pi = i / 2 / 2 * 2 + i % 2, pj = j / 2 / 2 * 2 + j % 2;
                for (unsigned c = 0; c < kComponents; ++c) {
                    around.near[c] = work.coded[c] + index;
                    around.parent[c] = level.index == 0 ? nullptr : work.parents[c] + codedIndex(m, pi, pj);
                }
                std::int32_t here[kComponents] = {};
                Vector detail = {0, 0, 0};
                for (unsigned c = 0; c < kComponents; ++c) {
                    if (isEmpty[c]) continue;
                    const DetailContext context =
                        contextOfDetail(models, around, here, c, orientation, level.index, frame.bend);
                    const std::int32_t q = pick(coder, context, c, place, frame);
                    here[c] = q;
                    if (q == 0) continue;
                    work.coded[c][index] = q;
                    detail = detail + (q * frame.step[c]) * frame.axis[c];
                }
                if (here[0] == 0 && here[1] == 0 && here[2] == 0) continue;
                const auto put = [&](std::size_t k) {
                    work.detail[0][k] = detail.x;
                    work.detail[1][k] = detail.y;
                    work.detail[2][k] = detail.z;
                };
                put(place);
                if (mate != GluedBorder::kNoMate) {
                    const GridPoint other = borderPoint(n, mate);
                    put(other.j * std::size_t{n} + other.i);
                    for (unsigned c = 0; c < kComponents; ++c)
                        work.coded[c][codedIndex(n, other.i, other.j)] = here[c];
                }
            }
    }
    return any;
}

/// Codes a surface coarse to fine; on return work.surface holds it as it will be decoded.
/// @param coarse  the 3 x 3 image in steps: read by encoders, written by decoders
/// @param pick    see codeLevel(); pick.begin(level) is called before each level
/// Failure shows in the coder.
template <class Coder, class Pick>
void codeSurface(Coder& coder, SurfaceModels& models, const SurfaceParameters& parameters,
                 const GluedBorder& border, QuantizedImage& coarse, SurfaceWork& work, Pick& pick)
{
    const std::uint32_t grid = border.grid();
    detail::codeCoarse(coder, models.coarse, coarse);
    for (unsigned c = 0; c < kComponents; ++c)
        for (unsigned k = 0; k < kCoarsest * kCoarsest; ++k)
            work.surface[c][k] = static_cast<double>(coarse.coarse[c][k]) * parameters.step;
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
            for (std::uint32_t j = 0; j < m; ++j)
                for (std::uint32_t i = 0; i < m; ++i)
                    finer[2 * j * std::size_t{n} + 2 * i] =
                        coarser[j * std::size_t{m} + i] * kInverseAreaScale;
            inverseLifting(finer, n, level.border, work.border);
            std::memset(work.detail[c], 0, count * sizeof *finer);
            std::int32_t* coded = work.parents[c];
            work.parents[c] = work.coded[c];
            work.coded[c] = coded;
            std::memset(coded, 0, codedSize(n) * sizeof *coded);
        }
        const double* planes[kComponents] = {work.surface[0], work.surface[1], work.surface[2]};
        level.meanArea = meanCellArea(planes, n);
        level.largestRatio = largestTangentialRatio(parameters, level.index);
        pick.begin(level);
        if (codeLevel(coder, models, parameters, work, level, pick)) {
            for (unsigned c = 0; c < kComponents; ++c) {
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

#pragma once

#include "detail_levels.h"
#include "lifting.h"
#include "surface_frame.h"

namespace gimg::codec {

/// Memory for building a surface of grid n.
struct SurfaceWork
{
    double* surface[kComponents]; ///< n^2: the surface; before its details are known, its prediction
    double* detail[kComponents];  ///< n^2
    double* coarse[kComponents];  ///< ((n + 1) / 2)^2
    double* border;               ///< 2 borderSize(n)

    template <class Take> void layOut(std::uint32_t grid, Take&& take)
    {
        const std::size_t samples = std::size_t{grid} * grid,
                          coarser = std::size_t{grid / 2 + 1} * (grid / 2 + 1);
        for (unsigned c = 0; c < kComponents; ++c) {
            take(surface[c], samples);
            take(detail[c], samples);
            take(coarse[c], coarser);
        }
        take(border, 2 * std::size_t{borderSize(grid)});
    }
};

/// Builds a surface, or up to three channels of a field, from the details, coarse to fine; on return
/// work.surface holds it.
/// @param frames   SurfaceFrames or FieldFrames: the axes and steps of details
/// @param coarse   the 3 x 3 image in steps
/// @param details  details.begin(level, prediction) is called before each level, and if it returns false the
///                 level has none; details.isWanted(bi, bj): whether a block has any;
///                 details(level, prediction, orientation, i, j, shared) is one, as a vector
template <class Frames, class Details>
void buildSurface(const Frames& frames, const GluedBorder& border,
                  const std::int64_t (&coarse)[kComponents][kCoarsest * kCoarsest], SurfaceWork& work,
                  Details& details)
{
    const std::uint32_t grid = border.grid();
    for (unsigned c = 0; c < kComponents; ++c)
        for (unsigned k = 0; k < kCoarsest * kCoarsest; ++k)
            work.surface[c][k] = static_cast<double>(coarse[c][k]) * frames.coarseStep();
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
            if (c < frames.components())
                inverseLiftingOfCoarse(coarser, kInverseAreaScale, finer, n, level.border, work.border);
            else
                std::memset(finer, 0, count * sizeof *finer);
        }
        const double* planes[kComponents] = {work.surface[0], work.surface[1], work.surface[2]};
        frames.begin(level, planes);
        if (details.begin(level, planes)) {
            for (unsigned c = 0; c < kComponents; ++c)
                std::memset(work.detail[c], 0, count * sizeof *work.detail[c]);
            visitDetails(
                level.border, n, [&](std::uint32_t bi, std::uint32_t bj) { return details.isWanted(bi, bj); },
                [&](unsigned orientation, std::uint32_t i, std::uint32_t j, const SharedDetail& shared,
                    std::uint32_t, std::uint32_t) {
                    const Vector detail = details(level, planes, orientation, i, j, shared);
                    if (detail.x == 0 && detail.y == 0 && detail.z == 0) return true;
                    const auto put = [&](std::size_t k) {
                        work.detail[0][k] = detail.x;
                        work.detail[1][k] = detail.y;
                        work.detail[2][k] = detail.z;
                    };
                    put(j * std::size_t{n} + i);
                    if (shared.mate == GluedBorder::kNoMate) return true;
                    const GridPoint other = borderPoint(n, shared.mate);
                    put(other.j * std::size_t{n} + other.i);
                    return true;
                });
            for (unsigned c = 0; c < frames.components(); ++c) {
                double *moves = work.detail[c], *finer = work.surface[c];
                for (std::uint32_t j = 1; j < n; j += 2)
                    for (std::uint32_t i = 1; i < n; i += 2) moves[j * std::size_t{n} + i] *= kAreaScale;
                inverseLifting(moves, n, level.border, work.border);
                for (std::size_t k = 0; k < count; ++k) finer[k] += moves[k];
            }
        }
        if (level.border == nullptr && border.isGluedAt(n))
            for (unsigned c = 0; c < kComponents; ++c) border.average(work.surface[c], n, work.border);
    }
}

} // namespace gimg::codec

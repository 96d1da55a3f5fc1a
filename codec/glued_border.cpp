#include "glued_border.h"

namespace gimg::codec {

namespace {

// The seam's sides begin at multiples of this many steps of the lowest grid.
std::uint32_t commonStride(const SeamView& seam)
{
    std::uint32_t all = seam.start | (seam.lowest - 1);
    for (std::uint32_t s = 0; s < seam.count; ++s) all |= seam.sides[s].length;
    return all & (~all + 1);
}

} // namespace

GluedBorder::GluedBorder(const SeamView& seam, std::uint32_t grid, const std::uint32_t* classes,
                         std::uint32_t* mates)
    : classes_(classes), mates_(mates), grid_(grid), coarsest_((seam.lowest - 1) / commonStride(seam) + 1)
{
    if (coarsest_ < 3) coarsest_ = 3;
    const std::uint32_t size = borderSize(grid);
    for (std::uint32_t k = 0; k < size; ++k) mates[k] = kNoMate;
    // A third member of a class makes its first point at itself, which is undone below.
    for (std::uint32_t k = 0; k < size; ++k) {
        const std::uint32_t first = classes[k];
        if (first == k) continue;
        mates[k] = first;
        mates[first] = mates[first] == kNoMate ? k : first;
    }
    for (std::uint32_t k = 0; k < size; ++k)
        if (classes[k] != k && mates[classes[k]] == classes[k]) mates[k] = kNoMate;
    for (std::uint32_t k = 0; k < size; ++k)
        if (mates[k] == k) mates[k] = kNoMate;
}

void GluedBorder::average(double* image, std::uint32_t size, double* work) const
{
    const std::uint32_t positions = borderSize(size), last = size - 1;
    double *sum = work, *weight = work + positions;
    for (std::uint32_t k = 0; k < positions; ++k) sum[k] = weight[k] = 0;
    for (std::uint32_t k = 0; k < positions; ++k) {
        const std::uint32_t c = classOf(size, k);
        const double cells = k % last == 0 ? 1 : 2;
        sum[c] += cells * image[borderSample(size, k)];
        weight[c] += cells;
    }
    for (std::uint32_t k = 0; k < positions; ++k) {
        const std::uint32_t c = classOf(size, k);
        image[borderSample(size, k)] = sum[c] / weight[c];
    }
}

} // namespace gimg::codec

#pragma once

#include <cstddef>
#include <cstdint>

namespace gimg::codec {

// CDF 9/7 by lifting (Daubechies and Sweldens 1998), scaled so that bands are nearly orthonormal.
// A line has 2m - 1 samples; the first and the last are even ones, and mirror their neighbours.
constexpr double kAlpha = -1.586134342059924;
constexpr double kBeta = -0.052980118572961;
constexpr double kGamma = 0.882911075530934;
constexpr double kDelta = 0.443506852043971;

// Lifting alone leaves the low band of a line 1 / kScale too weak and the high band kScale too strong.
// In two dimensions the two cancel, but for the coarse image and the diagonal band.
constexpr double kScale = 1.149604398860241;
constexpr double kAreaScale = kScale * kScale;
constexpr double kInverseAreaScale = 1.0 / kAreaScale;

/// odd[k] += factor * (even[k] + even[k + 1]) on a line of `size` samples.
inline void liftOdd(double* line, std::uint32_t size, double factor)
{
    for (std::uint32_t k = 1; k < size; k += 2) line[k] += factor * (line[k - 1] + line[k + 1]);
}

/// even[k] += factor * (odd[k - 1] + odd[k]), mirrored at the ends.
inline void liftEven(double* line, std::uint32_t size, double factor)
{
    line[0] += factor * (line[1] + line[1]);
    for (std::uint32_t k = 2; k + 1 < size; k += 2) line[k] += factor * (line[k - 1] + line[k + 1]);
    line[size - 1] += factor * (line[size - 2] + line[size - 2]);
}

/// The same in the vertical direction, on whole rows: all odd rows (first = 1) or all even ones (0).
inline void liftRows(double* image, std::uint32_t size, std::uint32_t first, double factor)
{
    const std::size_t pitch = size;
    for (std::uint32_t j = first; j < size; j += 2) {
        double* target = image + j * pitch;
        const double* above = image + (j == 0 ? 1 : j - 1) * pitch;
        const double* below = image + (j == size - 1 ? j - 1 : j + 1) * pitch;
        for (std::uint32_t i = 0; i < size; ++i) target[i] += factor * (above[i] + below[i]);
    }
}

/// Undoes the lifting of one level in place: even positions are coarse, odd ones details.
void inverseLifting(double* image, std::uint32_t size);

} // namespace gimg::codec

#pragma once

#include "coefficients.h"
#include "wavelet.h"

namespace gimg::codec {

/// Turns quantised coefficients back into real ones.
///
/// A magnitude stands for an interval, whose values are not spread evenly; the point to use within it is
/// told for magnitude 1 and for larger ones, in 1/32 of a step below (or above) the middle.
struct Dequantizer
{
    double step = 1;
    double shiftOne = 0;
    double shiftMore = 0;

    static constexpr double kShiftUnit = 1.0 / 32;
    static constexpr int kShiftBias = 8; ///< a nibble n stands for a shift of (n - 8) / 32

    static Dequantizer fromByte(float step, std::uint8_t shifts)
    {
        return {static_cast<double>(step), (int{shifts} % 16 - kShiftBias) * kShiftUnit,
                (int{shifts} / 16 - kShiftBias) * kShiftUnit};
    }

    double operator()(std::int32_t q) const
    {
        if (q == 0) return 0;
        const double magnitude = q < 0 ? -static_cast<double>(q) : static_cast<double>(q);
        const double value = (magnitude - (magnitude == 1 ? shiftOne : shiftMore)) * step;
        return q < 0 ? -value : value;
    }
};

/// A step must be a number between these; all arithmetic then stays far from overflow.
constexpr float kSmallestStep = 7.8886090522101181e-31f; // 2^-100
constexpr float kLargestStep = 1.2676506002282294e30f;   // 2^100

/// Inverse transform of one component.
/// @param workA,workB  scratch of grid^2 and ((grid + 1) / 2)^2 numbers
/// The samples end up in workA.
void reconstructComponent(const QuantizedImage& image, unsigned component, const Dequantizer& dequantize,
                          double* workA, double* workB);

} // namespace gimg::codec

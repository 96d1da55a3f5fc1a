#pragma once

#include "coefficients.h"

#include <cstdint>
#include <span>
#include <vector>

namespace gimg::codec {

/// An image of three components after the forward transform, ready to be quantised at any step.
struct TransformedImage
{
    std::uint32_t grid = 0;
    std::vector<double> detail[kComponents]; ///< planes laid out as in QuantizedImage
    double coarse[kComponents][kCoarsest * kCoarsest] = {};
    double largest = 0;  ///< magnitude of any coefficient
    double diagonal = 0; ///< of the samples' bounding box

    /// Largest magnitude of a component's band, by level from the coarsest and orientation.
    std::vector<double> largestOfBand[kComponents];
};

/// @param samples  3 grid^2 finite numbers, x y z of each sample in turn
TransformedImage transform(std::span<const float> samples, std::uint32_t grid);

/// Forward lifting of one level in place; inverseLifting() undoes it.
void forwardLifting(double* image, std::uint32_t size);

struct CodedImage
{
    std::vector<std::uint8_t> payload;
    std::uint8_t shifts = 0; ///< see Dequantizer
};

/// Quantises and codes. Magnitudes are chosen by what they cost and what they mend.
/// The step must not be below smallestStep().
CodedImage encodeCoefficients(const TransformedImage& image, float step);

/// The step below which coefficients would not fit their coded range.
float smallestStep(const TransformedImage& image);

/// The same from the largest magnitude of a detail, and of any coefficient.
float smallestStep(double largestDetail, double largest);

} // namespace gimg::codec

#pragma once

#include "glued_border.h"
#include "wavelet.h"

namespace gimg::codec {

// The two-dimensional CDF 9/7 transform of one level on a glued grid. Each lifting step goes in both
// directions before the next begins. The steps that add neighbours to details stay within the square; those
// that add details to their neighbours look across its border. There each sample is mirrored first, as if the
// surface ended, and then all samples of a class take their mean: which is what the formula comes to when it
// sums over all the cells around a point, 4 / k times for k of them. So a seam leaves no trace where four
// cells meet, and cone points and cut-nodes need no rule of their own.

/// Undoes the lifting of one level in place: even positions are coarse, odd ones details.
/// @param border  nullptr: nothing is glued
/// @param work    2 borderSize(size) numbers
void inverseLifting(double* image, std::uint32_t size, const GluedBorder* border, double* work);

/// The same for a level without details, which need not be there: what is coarse comes from an image of its
/// own.
/// @param coarse  (size / 2 + 1)^2 numbers
/// @param factor  that they are multiplied by
/// @param image   size^2, for the result
void inverseLiftingOfCoarse(const double* coarse, double factor, double* image, std::uint32_t size,
                            const GluedBorder* border, double* work);

/// Its inverse; for encoders. Samples of a class must be equal.
void forwardLifting(double* image, std::uint32_t size, const GluedBorder* border, double* work);

} // namespace gimg::codec

#pragma once

#include "gimg/fit.h"
#include "gimg/image_io.h"
#include "gimg/result.h"

#include <string>

namespace gimg {

inline constexpr double kSeamTolerance = 1e-4; ///< see ImageSeamOptions

struct ImageSeamOptions
{
    /// How far apart samples may lie to be the same point of the surface, as a fraction of the diagonal of
    /// the image's bounding box; positive, at most 0.1. Less than the samples' spacing. Runs shorter than
    /// four times that are not told apart.
    double tolerance = kSeamTolerance;
    int lowest = 0; ///< samples a side of the lowest level, 2^l + 1; 0: the least that the seam allows
};

/// How the border of a geometry image that came without a seam is glued.
struct ImageSeam
{
    GridSeam seam;
    FloatImage image;      ///< glued samples are their mean, so that mates agree to the last bit
    int steps = 0;         ///< of the border, 4 (n - 1)
    int glued = 0;         ///< those that have a mate; the others are the surface's boundary
    double widestGap = 0;  ///< that was closed, as a fraction of the diagonal
    int slits = 0;         ///< pieces of boundary that face each other within 20 tolerances
    double widestSlit = 0; ///< how far, as a fraction of the diagonal
    std::string objection; ///< why samples that coincide are not glued, and the border is open; else empty
};

/// Finds the seam of a geometry image by the samples that coincide on its border: runs that come back in
/// reverse are mates, the longest first; where runs meet is decided by what they are glued to. Runs without a
/// mate are the surface's boundary. Where what was found is not a seam that a file can hold (it contradicts
/// itself, or would not leave a simplicial surface) the whole border is boundary, and `objection` says so.
/// @param image  square, 2^j + 1 samples a side, 3 to 4097; takes time as the square of its side
/// Errors: BadArgument (options, size), NotFinite, EmptyMesh (all samples in one point), TargetUnreachable
/// (the seam does not fit the lowest level asked for; says what does).
Result<ImageSeam> findImageSeam(const FloatImage& image, const ImageSeamOptions& options = {});

} // namespace gimg

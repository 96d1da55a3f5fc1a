#pragma once

#include "gimg/fit.h"

#include <functional>

/// Geometry images of surfaces that are given by a formula, and ways to glue their borders.
namespace gimg::test {

using Surface = std::function<Vec3(double s, double t)>;

inline FloatImage sampled(const Surface& surface, int n)
{
    FloatImage image{n, n, {}};
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            for (const double x : surface(static_cast<double>(i) / (n - 1), static_cast<double>(j) / (n - 1)))
                image.samples.push_back(static_cast<float>(x));
    return image;
}

inline Vec3 sampleAt(const FloatImage& image, int i, int j)
{
    return {image.at(i, j, 0), image.at(i, j, 1), image.at(i, j, 2)};
}

/// The whole border of the square is the surface's boundary.
inline GridSeam openSeam(int lowest)
{
    return {lowest, 0, {{0, static_cast<uint32_t>(4 * (lowest - 1)), GIM_SIDE_BOUNDARY}}};
}

} // namespace gimg::test

#pragma once

#include "coefficients.h"
#include "glued_border.h"

#include <cmath>

namespace gimg::codec {

/// What a surface's chunk tells before its coded samples.
struct SurfaceParameters
{
    double step = 1;         ///< of details along the normal, where cells have their mean area
    double areaLimit = 1.75; ///< steps differ from that by at most this factor, both ways
    double flatness = 4;     ///< tangential steps are at most this many times (cell / bend)^(1/2) normal ones
    unsigned rise = 3;       ///< quarter octaves a level by which tangential steps may grow over normal ones
    unsigned most = 12;      ///< quarter octaves at which that ends
};

/// 2^(quarters / 4).
inline double powerOfQuarters(unsigned quarters)
{
    constexpr double kQuarters[4] = {1.0, 1.189207115002721, 1.4142135623730951, 1.6817928305074292};
    return kQuarters[quarters % 4] * static_cast<double>(1u << quarters / 4);
}

/// The largest ratio of tangential steps to normal ones at a level of details, 0 for the coarsest.
inline double largestTangentialRatio(const SurfaceParameters& parameters, unsigned level)
{
    const unsigned grown = level * parameters.rise;
    return powerOfQuarters(grown < parameters.most ? grown : parameters.most);
}

struct Vector
{
    double x, y, z;
};
inline Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector operator*(double f, Vector a) { return {f * a.x, f * a.y, f * a.z}; }
inline double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector cross(Vector a, Vector b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// A level while its details are coded.
struct SurfaceLevel
{
    std::uint32_t size = 0;              ///< samples a side, with the details
    unsigned index = 0;                  ///< 0 for the coarsest
    double meanArea = 0;                 ///< of a cell of the prediction
    double largestRatio = 1;             ///< of tangential steps to normal ones
    const GluedBorder* border = nullptr; ///< nullptr: this level's details are not glued
};

/// The frame in which one detail is coded, and its steps.
struct Frame
{
    Vector axis[kComponents]; ///< normal and two tangents
    double step[kComponents];
};

inline Vector sampleOf(const double* const (&planes)[kComponents], std::size_t at)
{
    return {planes[0][at], planes[1][at], planes[2][at]};
}

/// Twice the derivatives of the prediction: central differences, across the seam too; at a border that is not
/// glued, twice the one-sided one.
struct Derivatives
{
    Vector i, j;
};

inline Derivatives derivativesAt(const double* const (&planes)[kComponents], const SurfaceLevel& level,
                                 std::uint32_t i, std::uint32_t j)
{
    const std::uint32_t n = level.size, last = n - 1;
    const std::size_t at = j * std::size_t{n} + i;
    const auto pick = [&](std::size_t k) { return sampleOf(planes, k); };
    if (i > 0 && i < last && j > 0 && j < last)
        return {pick(at + 1) - pick(at - 1), pick(at + n) - pick(at - n)};
    // Details on the border are never at the square's corners.
    const std::uint32_t mate =
        level.border == nullptr ? GluedBorder::kNoMate : level.border->mateOf(n, borderPosition(n, i, j));
    std::size_t beyond = 0;
    if (mate != GluedBorder::kNoMate) {
        const GridPoint p = borderPoint(n, mate);
        const std::uint32_t bi = p.i == 0 ? 1 : p.i == last ? last - 1 : p.i;
        const std::uint32_t bj = p.j == 0 ? 1 : p.j == last ? last - 1 : p.j;
        beyond = bj * std::size_t{n} + bi;
    }
    const bool glued = mate != GluedBorder::kNoMate;
    const Vector here = pick(at);
    const auto across = [&](std::size_t inside, bool low) {
        const Vector inner = pick(inside);
        const Vector outer = glued ? pick(beyond) : here + (here - inner);
        return low ? inner - outer : outer - inner;
    };
    Derivatives d;
    d.i = i == 0 ? across(at + 1, true) : i == last ? across(at - 1, false) : pick(at + 1) - pick(at - 1);
    d.j = j == 0 ? across(at + n, true) : j == last ? across(at - n, false) : pick(at + n) - pick(at - n);
    return d;
}

/// Mean area of the prediction's cells, from their diagonals.
inline double meanCellArea(const double* const (&planes)[kComponents], std::uint32_t n)
{
    double sum = 0;
    for (std::uint32_t j = 0; j + 1 < n; ++j)
        for (std::uint32_t i = 0; i + 1 < n; ++i) {
            const std::size_t at = j * std::size_t{n} + i;
            const Vector d = sampleOf(planes, at + n + 1) - sampleOf(planes, at);
            const Vector e = sampleOf(planes, at + n) - sampleOf(planes, at + 1);
            const Vector c = cross(d, e);
            sum += std::sqrt(dot(c, c));
        }
    return sum * 0.5 / (static_cast<double>(n - 1) * static_cast<double>(n - 1));
}

inline Frame frameAt(const double* const (&planes)[kComponents], const SurfaceLevel& level,
                     const SurfaceParameters& parameters, std::uint32_t i, std::uint32_t j)
{
    Frame frame;
    const Derivatives d = derivativesAt(planes, level, i, j);
    Vector normal = cross(d.i, d.j);
    const double normalSquared = dot(normal, normal), alongSquared = dot(d.i, d.i);
    const double area = std::sqrt(normalSquared) * 0.25;
    // Lengths whose squares or fourth powers vanish give no direction.
    if (!(normalSquared > 0 && alongSquared > 0)) {
        frame.axis[0] = {0, 0, 1};
        frame.axis[1] = {1, 0, 0};
        frame.axis[2] = {0, 1, 0};
    } else {
        frame.axis[0] = (1.0 / std::sqrt(normalSquared)) * normal;
        frame.axis[1] = (1.0 / std::sqrt(alongSquared)) * d.i;
        frame.axis[2] = cross(frame.axis[0], frame.axis[1]);
    }
    double factor = 1;
    if (level.meanArea > 0) {
        const double ratio = area / level.meanArea, limit = parameters.areaLimit;
        const double squared = ratio * limit * limit < 1 ? limit * limit
                               : ratio > limit * limit   ? 1.0 / (limit * limit)
                                                         : 1.0 / ratio;
        factor = std::sqrt(squared);
    }
    frame.step[0] = parameters.step * factor;

    const std::uint32_t n = level.size, last = n - 1;
    const std::size_t at = j * std::size_t{n} + i;
    const auto pick = [&](std::size_t k) { return sampleOf(planes, k); };
    const auto bendAlong = [&](std::size_t apart) {
        return pick(at + apart) + pick(at - apart) - 2.0 * pick(at);
    };
    const Vector none = {0, 0, 0};
    const Vector alongI = i > 0 && i < last ? bendAlong(1) : none,
                 alongJ = j > 0 && j < last ? bendAlong(n) : none;
    // Where the surface is flat, a sample may err along it without being seen.
    const double bent = dot(alongI, alongI) + dot(alongJ, alongJ);
    const double flat = parameters.flatness * parameters.flatness * area;
    const double most = level.largestRatio * level.largestRatio;
    frame.step[1] = frame.step[0] * (flat >= most * bent ? level.largestRatio
                                     : flat > bent       ? std::sqrt(flat / bent)
                                                         : 1.0);
    frame.step[2] = frame.step[1];
    return frame;
}

/// How buildSurface() is to take the details of a surface: in frames of the prediction.
class SurfaceFrames
{
public:
    explicit SurfaceFrames(const SurfaceParameters& parameters) : parameters_(parameters) {}

    static constexpr unsigned components() { return kComponents; }
    double coarseStep() const { return parameters_.step; }
    void begin(SurfaceLevel& level, const double* const (&prediction)[kComponents]) const
    {
        level.meanArea = meanCellArea(prediction, level.size);
        level.largestRatio = largestTangentialRatio(parameters_, level.index);
    }
    Frame at(const double* const (&planes)[kComponents], const SurfaceLevel& level, std::uint32_t i,
             std::uint32_t j) const
    {
        return frameAt(planes, level, parameters_, i, j);
    }

private:
    SurfaceParameters parameters_;
};

} // namespace gimg::codec

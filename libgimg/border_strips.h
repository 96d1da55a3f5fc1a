#pragma once

#include "gimg/image_io.h"
#include "gimg/mesh.h"

#include <vector>

namespace gimg {

/// The border samples of a square image, counter-clockwise from (0, 0).
class BorderLoop
{
public:
    explicit BorderLoop(const FloatImage& image);

    int size() const { return static_cast<int>(points_.size()); }
    int wrapped(int position) const { return ((position % size()) + size()) % size(); }
    const Vec3& at(int position) const { return points_[static_cast<size_t>(wrapped(position))]; }
    double gap(int p, int q) const { return (at(p) - at(q)).norm(); }
    /// Along the border from one position on.
    double length(int begin, int steps) const;

private:
    std::vector<Vec3> points_;
};

/// Two runs of border steps of equal length that lie on each other, one in reverse: position p of one on
/// position sum - p of the other.
struct BorderStrip
{
    int sum = 0;
    int begin = 0, length = 0; ///< of the first run, in steps
    int mateBegin() const { return sum - begin - length; }
};

/// Strips that cover what coincides on a border, the longest first; no two share a step.
/// @param tolerance  how far mates may be apart
/// @param shortest   what is shorter, along the surface, is left out
std::vector<BorderStrip> findStrips(const BorderLoop& border, double tolerance, double shortest);

} // namespace gimg

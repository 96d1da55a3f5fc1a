#pragma once

#include "gimg/mesh.h"

#include <cstdint>
#include <vector>

namespace gimg {

/// Spreads points evenly over the area of triangles: one in each of equal slices of the area, in the order of
/// the faces. The same ones for the same seed. The triangles must outlive it.
class AreaSampler
{
public:
    struct Sample
    {
        Vec3 point;
        int face;
    };

    AreaSampler(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces);

    /// Without area there are no samples.
    bool hasArea() const { return !doubleAreaUpTo_.empty() && doubleAreaUpTo_.back() > 0; }
    double area() const { return doubleAreaUpTo_.empty() ? 0 : doubleAreaUpTo_.back() / 2; }

    /// Number `index` of `count` samples.
    Sample sample(int index, int count, uint64_t seed) const;

private:
    const std::vector<Vec3>& positions_;
    const std::vector<Triangle>& faces_;
    std::vector<double> doubleAreaUpTo_;
};

} // namespace gimg

#include "area_sampler.h"

#include <algorithm>
#include <cmath>

namespace gimg {
namespace {

/// Random numbers in [0, 1), a sequence of its own for every seed and index (SplitMix64).
class Random
{
public:
    Random(uint64_t seed, uint64_t index) : state_(mixed(mixed(seed + kStep) ^ index)) {}
    double next() { return static_cast<double>(mixed(state_ += kStep) >> 11) * 0x1p-53; }

private:
    static constexpr uint64_t kStep = 0x9e3779b97f4a7c15U;

    static uint64_t mixed(uint64_t z)
    {
        z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9U;
        z = (z ^ z >> 27) * 0x94d049bb133111ebU;
        return z ^ z >> 31;
    }

    uint64_t state_;
};

} // namespace

AreaSampler::AreaSampler(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces)
    : positions_(positions), faces_(faces)
{
    double area = 0;
    doubleAreaUpTo_.reserve(faces.size());
    for (const Triangle& t : faces) {
        const Vec3& p = positions[t[0]];
        doubleAreaUpTo_.push_back(area += (positions[t[1]] - p).cross(positions[t[2]] - p).norm());
    }
}

AreaSampler::Sample AreaSampler::sample(int index, int count, uint64_t seed) const
{
    Random random(seed, static_cast<uint64_t>(index));
    const double total = doubleAreaUpTo_.back();
    const double area = total * (index + random.next()) / count;
    auto at = std::upper_bound(doubleAreaUpTo_.begin(), doubleAreaUpTo_.end(), std::min(area, total));
    // Past the end by rounding: the last face with an area.
    if (at == doubleAreaUpTo_.end())
        at = std::lower_bound(doubleAreaUpTo_.begin(), doubleAreaUpTo_.end(), total);
    const auto face = static_cast<int>(at - doubleAreaUpTo_.begin());
    const Triangle& t = faces_[face];
    const double s = std::sqrt(random.next()), r = random.next();
    const Vec3 point = (1 - s) * positions_[t[0]] + s * (1 - r) * positions_[t[1]] + s * r * positions_[t[2]];
    return {point, face};
}

} // namespace gimg

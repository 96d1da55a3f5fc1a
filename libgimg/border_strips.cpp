#include "border_strips.h"

#include "codec/border.h"

#include <queue>
#include <tuple>

namespace gimg {
namespace {

bool isShorter(const BorderStrip& a, const BorderStrip& b)
{
    return std::tuple(a.length, b.sum, b.begin) < std::tuple(b.length, a.sum, a.begin);
}

// All runs that come back in reverse. Each sum mirrors the border about an axis through two opposite places;
// it is enough to go along one half.
template <class Take> void forEachStrip(const BorderLoop& border, double tolerance, const Take& take)
{
    const int total = border.size();
    for (int sum = 0; sum < total; ++sum) {
        const int first = (sum + 1) / 2, last = first + (total - sum % 2 * 2) / 2; // positions, both mirrored
        int begin = first;
        bool before = false;
        for (int p = first; p <= last; ++p) {
            const bool meets = (border.at(p) - border.at(sum - p)).squaredNorm() <= tolerance * tolerance;
            if (meets && !before) begin = p;
            if (before && (!meets || p == last) && (meets ? p : p - 1) > begin)
                take(BorderStrip{sum, begin, (meets ? p : p - 1) - begin});
            before = meets;
        }
    }
}

} // namespace

BorderLoop::BorderLoop(const FloatImage& image)
{
    const auto grid = static_cast<uint32_t>(image.width);
    for (uint32_t p = 0; p < codec::borderSize(grid); ++p) {
        const auto [i, j] = codec::borderPoint(grid, p);
        const auto at = [&](int c) { return image.at(static_cast<int>(i), static_cast<int>(j), c); };
        points_.emplace_back(at(0), at(1), at(2));
    }
}

double BorderLoop::length(int begin, int steps) const
{
    double sum = 0;
    for (int p = begin; p < begin + steps; ++p) sum += gap(p, p + 1);
    return sum;
}

std::vector<BorderStrip> findStrips(const BorderLoop& border, double tolerance, double shortest)
{
    std::priority_queue<BorderStrip, std::vector<BorderStrip>, decltype(&isShorter)> open(isShorter);
    const auto offer = [&](const BorderStrip& strip) {
        if (strip.length > 0 && border.length(strip.begin, strip.length) >= shortest) open.push(strip);
    };
    forEachStrip(border, tolerance, offer);
    std::vector<BorderStrip> strips;
    std::vector<bool> taken(static_cast<size_t>(border.size()));
    const auto isTaken = [&](int step) { return taken[static_cast<size_t>(border.wrapped(step))]; };
    while (!open.empty()) {
        const BorderStrip strip = open.top();
        open.pop();
        const int end = strip.begin + strip.length;
        const auto free = [&](int step) { return !isTaken(step) && !isTaken(strip.sum - 1 - step); };
        int begin = strip.begin;
        while (begin < end && free(begin)) ++begin;
        if (begin == end) {
            for (int step = strip.begin; step < end; ++step)
                taken[static_cast<size_t>(border.wrapped(step))] =
                    taken[static_cast<size_t>(border.wrapped(strip.sum - 1 - step))] = true;
            strips.push_back(strip);
            continue;
        }
        // Longer ones have taken a part of it: what is left stands in line again.
        for (int from = strip.begin; from < end;) {
            int to = from;
            while (to < end && free(to)) ++to;
            offer({strip.sum, from, to - from});
            from = to + 1;
        }
    }
    return strips;
}

} // namespace gimg

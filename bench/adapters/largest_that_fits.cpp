#include "largest_that_fits.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gimg::adapter {
namespace {

constexpr double kCloseEnough = 0.005; ///< of the room left over
constexpr double kLeastStep = 0.01;    ///< between logarithms until one file fits and one does not

} // namespace

Result<std::optional<std::vector<uint8_t>>> largestThatFits(const OneParameter& coder, std::size_t room)
{
    // u: the logarithm of the size, but for a constant, if the power law held.
    const auto parameter = [&](double u) { return std::exp(u / coder.exponent); };
    const double ends[] = {coder.exponent * std::log(coder.least), coder.exponent * std::log(coder.most)};
    const double least = std::min(ends[0], ends[1]), most = std::max(ends[0], ends[1]);
    double fits = -std::numeric_limits<double>::infinity(), tooLarge = -fits;
    std::optional<std::vector<uint8_t>> best;
    double u = std::clamp(coder.exponent * std::log(coder.start), least, most);
    for (int i = 0; i < coder.attempts; ++i) {
        Result<std::vector<uint8_t>> file = coder.encode(parameter(u));
        if (!file) return file.error();
        const double size = static_cast<double>(file->size()), left = static_cast<double>(room) - size;
        (left >= 0 ? fits : tooLarge) = u;
        if (left >= 0 && (!best || file->size() > best->size())) best = std::move(*file);
        if (left >= 0 && left <= kCloseEnough * static_cast<double>(room)) break;
        if ((left >= 0 && u >= most) || (left < 0 && u <= least)) break;
        double next = u + std::log(static_cast<double>(room) / size);
        next = left >= 0 ? std::max(next, u + kLeastStep) : std::min(next, u - kLeastStep);
        if (next <= fits || next >= tooLarge) next = (fits + tooLarge) / 2;
        u = std::clamp(next, least, most);
    }
    return best;
}

} // namespace gimg::adapter

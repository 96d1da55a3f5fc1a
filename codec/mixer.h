#pragma once

#include "bit_model.h"

namespace gimg::codec {

// Several estimates of one probability are combined in the logistic domain: stretch(p) = ln(p / (1 - p)),
// in units of 1/256, within +-2047. squash() is its inverse. Both are integer tables, so that every
// decoder computes the same.

constexpr int kStretchLimit = 2047;
/// Speed at which weights follow: larger is slower.
constexpr int kMixShift = 15;
/// Weights stay within 16 of 0, whatever is coded.
constexpr std::int32_t kMixLimit = 16 << 16;

/// 2^15 / (1 + exp(-x)) at x = -8, -7.5 .. 8.
constexpr std::int32_t kLogistic[33] = {11,    18,    30,    49,    81,    133,   219,   360,   589,
                                        961,   1554,  2486,  3906,  5978,  8813,  12371, 16384, 20397,
                                        23955, 26790, 28862, 30282, 31214, 31807, 32179, 32408, 32549,
                                        32635, 32687, 32719, 32738, 32750, 32757};

constexpr std::uint32_t squash(int stretched)
{
    const int clamped = stretched > kStretchLimit    ? kStretchLimit
                        : stretched < -kStretchLimit ? -kStretchLimit
                                                     : stretched;
    const int offset = clamped + kStretchLimit + 1;
    const int cell = offset >> 7, within = offset & 127;
    return static_cast<std::uint32_t>(
        (kLogistic[cell] * (128 - within) + kLogistic[cell + 1] * within + 64) >> 7);
}

/// stretch() of the middles of 4096 equal intervals of probability: the least number whose squash()
/// reaches the middle.
struct StretchTable
{
    std::int16_t value[4096];

    constexpr StretchTable() : value()
    {
        int stretched = -kStretchLimit;
        for (std::uint32_t k = 0; k < 4096; ++k) {
            while (stretched < kStretchLimit && squash(stretched) < 8 * k + 4) ++stretched;
            value[k] = static_cast<std::int16_t>(stretched);
        }
    }
};
inline constexpr StretchTable kStretch{};

constexpr int clampStretch(std::int64_t sum)
{
    return sum > kStretchLimit    ? kStretchLimit
           : sum < -kStretchLimit ? -kStretchLimit
                                  : static_cast<int>(sum);
}

/// Weights of `Count` estimates, in units of 2^-16.
template <unsigned Count> struct MixWeights
{
    std::int32_t weight[Count];

    constexpr MixWeights() : weight()
    {
        for (std::int32_t& w : weight) w = kStart;
    }

    static constexpr std::int32_t kStart = static_cast<std::int32_t>(65536 * 13 / 10 / Count);

    void learn(const int (&stretched)[Count], int error)
    {
        for (unsigned k = 0; k < Count; ++k) {
            const std::int32_t moved =
                weight[k] + ((stretched[k] * error + (1 << (kMixShift - 1))) >> kMixShift);
            weight[k] = moved > kMixLimit ? kMixLimit : moved < -kMixLimit ? -kMixLimit : moved;
        }
    }
};

/// One bit whose probability is mixed from the models' estimates. Bits are coded as
/// coder.code(probability of zero, bit).
template <unsigned Count, class Coder>
bool codeMixed(Coder& coder, BitModel* const (&models)[Count], MixWeights<Count>& weights, bool bit)
{
    int stretched[Count];
    std::int64_t sum = 0;
    for (unsigned k = 0; k < Count; ++k) {
        stretched[k] = kStretch.value[models[k]->zero() >> 3];
        sum += std::int64_t{weights.weight[k]} * stretched[k];
    }
    const std::uint32_t zero = squash(static_cast<int>(sum >> 16));
    const bool one = coder.code(zero, bit);
    if (!Coder::kAdapts) return one;
    const int error = (one ? 0 : 1 << kProbabilityBits) - static_cast<int>(zero);
    for (unsigned k = 0; k < Count; ++k) {
        const std::int32_t moved =
            weights.weight[k] + ((stretched[k] * error + (1 << (kMixShift - 1))) >> kMixShift);
        weights.weight[k] = moved > kMixLimit ? kMixLimit : moved < -kMixLimit ? -kMixLimit : moved;
        models[k]->update(one);
    }
    return one;
}

/// The same with two sets of weights, chosen by different contexts, whose results are averaged before
/// squash(). Each set learns from its own error.
template <unsigned Count, class Coder>
bool codeMixed(Coder& coder, BitModel* const (&models)[Count], MixWeights<Count>& first,
               MixWeights<Count>& second, bool bit)
{
    int stretched[Count];
    std::int64_t sums[2] = {};
    for (unsigned k = 0; k < Count; ++k) {
        stretched[k] = kStretch.value[models[k]->zero() >> 3];
        sums[0] += std::int64_t{first.weight[k]} * stretched[k];
        sums[1] += std::int64_t{second.weight[k]} * stretched[k];
    }
    const int parts[2] = {clampStretch(sums[0] >> 16), clampStretch(sums[1] >> 16)};
    const bool one = coder.code(squash((parts[0] + parts[1]) >> 1), bit);
    if (!Coder::kAdapts) return one;
    const int target = one ? 0 : 1 << kProbabilityBits;
    first.learn(stretched, target - static_cast<int>(squash(parts[0])));
    second.learn(stretched, target - static_cast<int>(squash(parts[1])));
    for (unsigned k = 0; k < Count; ++k) models[k]->update(one);
    return one;
}

} // namespace gimg::codec

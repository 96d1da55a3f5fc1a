#pragma once

#include "bit_model.h"

namespace gimg::codec {

// Several estimates of one probability are combined in the logistic domain: stretch(p) = ln(p / (1 - p)),
// in units of 1/256, within +-2047. squash() is its inverse. Both are integer tables, so that every
// decoder computes the same.

constexpr int kStretchLimit = 2047;
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

/// Weights of `Count` estimates, in units of 2^-12.
template <unsigned Count> struct MixWeights
{
    static_assert(Count <= 8);
    static constexpr int kUnitBits = 12;
    /// Weights stay within 8 of 0, whatever is coded.
    static constexpr std::int16_t kMost = 32600;
    static constexpr std::int16_t kStart = static_cast<std::int16_t>((1 << kUnitBits) * 13 / 10 / Count);

    std::int16_t weight[Count];

    constexpr MixWeights() : weight()
    {
        for (unsigned k = 0; k < Count; ++k) weight[k] = kStart;
    }

    /// At most 2^29.
    int times(const std::int16_t (&stretched)[Count]) const
    {
        int sum = 0;
        for (unsigned k = 0; k < Count; ++k) sum += static_cast<int>(weight[k]) * stretched[k];
        return sum;
    }

    /// Moves each weight by stretched * error / 2^19, rounded.
    /// @param error  in 2^-15
    void learn(const std::int16_t (&stretched)[Count], int error)
    {
        const auto part = static_cast<std::int16_t>(error >> 3);
        for (unsigned k = 0; k < Count; ++k) {
            const auto twice = static_cast<std::int16_t>(2 * stretched[k]);
            const auto moves = static_cast<std::int16_t>((twice * part) >> 16);
            const auto moved = static_cast<std::int16_t>(weight[k] + ((moves + 1) >> 1));
            const std::int16_t low = moved < -kMost ? static_cast<std::int16_t>(-kMost) : moved;
            weight[k] = low > kMost ? kMost : low;
        }
    }
};

template <unsigned Count> struct Stretched
{
    std::int16_t value[Count] = {};

    explicit Stretched(BitModel* const (&models)[Count])
    {
        for (unsigned k = 0; k < Count; ++k) value[k] = kStretch.value[models[k]->zero() >> 3];
    }
};

/// One bit whose probability is mixed from the models' estimates. Bits are coded as
/// coder.code(probability of zero, bit).
template <unsigned Count, class Coder>
bool codeMixed(Coder& coder, BitModel* const (&models)[Count], MixWeights<Count>& weights, bool bit)
{
    const Stretched<Count> stretched(models);
    const std::uint32_t zero = squash(weights.times(stretched.value) >> MixWeights<Count>::kUnitBits);
    const bool one = coder.code(zero, bit);
    if (!Coder::kAdapts) return one;
    weights.learn(stretched.value, (one ? 0 : 1 << kProbabilityBits) - static_cast<int>(zero));
    for (unsigned k = 0; k < Count; ++k) models[k]->update(one);
    return one;
}

} // namespace gimg::codec

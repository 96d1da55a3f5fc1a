#pragma once

#include "bit_model.h"

#include <utility>
#if defined(__SSE2__) && !defined(GIMG_SCALAR)
#include <emmintrin.h>
#endif

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

constexpr int clampStretched(int value)
{
    return value > kStretchLimit ? kStretchLimit : value < -kStretchLimit ? -kStretchLimit : value;
}

constexpr std::uint32_t squash(int stretched)
{
    const int offset = clampStretched(stretched) + kStretchLimit + 1;
    const int cell = offset >> 7, within = offset & 127;
    return static_cast<std::uint32_t>(
        (kLogistic[cell] * (128 - within) + kLogistic[cell + 1] * within + 64) >> 7);
}

/// squash() of what is in range.
struct SquashTable
{
    std::uint16_t value[2 * kStretchLimit + 1];

    constexpr SquashTable() : value()
    {
        for (int k = 0; k <= 2 * kStretchLimit; ++k)
            value[k] = static_cast<std::uint16_t>(squash(k - kStretchLimit));
    }
};
inline constexpr SquashTable kSquash{};

inline std::uint32_t quickSquash(int stretched)
{
    return kSquash.value[clampStretched(stretched) + kStretchLimit];
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

/// How far a model is trusted that has seen n bits: n / (n + 1), in 2^-15.
struct TrustTable
{
    std::int16_t value[RateTable::kSlowest + 1];

    constexpr TrustTable() : value()
    {
        for (unsigned n = 0; n <= RateTable::kSlowest; ++n)
            value[n] = static_cast<std::int16_t>(32767u * n / (n + 1));
    }
};
inline constexpr TrustTable kTrust{};

/// Up to eight numbers of 16 bits. With SSE2 they are one vector; what comes out is the same without.
struct Lanes
{
    static constexpr unsigned kCount = 8;
#if defined(__SSE2__) && !defined(GIMG_SCALAR)
    __m128i all = _mm_setzero_si128();

    template <unsigned K> void set(std::int16_t value) { all = _mm_insert_epi16(all, value, K); }

    /// Each times the other's / 2^15, rounded down; for numbers below 2^14.
    Lanes scaled(const Lanes& other) const
    {
        Lanes out;
        out.all = _mm_mulhi_epi16(_mm_add_epi16(all, all), other.all);
        return out;
    }

    /// At most 2^29 for weights and stretched estimates.
    int times(const Lanes& other) const
    {
        const __m128i pairs = _mm_madd_epi16(all, other.all);
        const __m128i halves = _mm_add_epi32(pairs, _mm_shuffle_epi32(pairs, 0x4E));
        return _mm_cvtsi128_si32(_mm_add_epi32(halves, _mm_shuffle_epi32(halves, 0xB1)));
    }

    /// Adds other * part / 2^15, rounded, and clamps to +-most.
    void move(const Lanes& other, std::int16_t part, std::int16_t most)
    {
        const __m128i twice = _mm_add_epi16(other.all, other.all);
        const __m128i product = _mm_mulhi_epi16(twice, _mm_set1_epi16(part));
        const __m128i moves = _mm_srai_epi16(_mm_add_epi16(product, _mm_set1_epi16(1)), 1);
        const __m128i limit = _mm_set1_epi16(most);
        all = _mm_min_epi16(_mm_add_epi16(all, moves), limit);
        all = _mm_max_epi16(all, _mm_sub_epi16(_mm_setzero_si128(), limit));
    }
#else
    std::int16_t all[kCount] = {};

    template <unsigned K> void set(std::int16_t value) { all[K] = value; }

    Lanes scaled(const Lanes& other) const
    {
        Lanes out;
        for (unsigned k = 0; k < kCount; ++k)
            out.all[k] = static_cast<std::int16_t>((2 * all[k] * other.all[k]) >> 16);
        return out;
    }

    int times(const Lanes& other) const
    {
        int sum = 0;
        for (unsigned k = 0; k < kCount; ++k) sum += static_cast<int>(all[k]) * other.all[k];
        return sum;
    }

    void move(const Lanes& other, std::int16_t part, std::int16_t most)
    {
        for (unsigned k = 0; k < kCount; ++k) {
            const int product = (2 * other.all[k] * part) >> 16;
            const int moved = all[k] + ((product + 1) >> 1);
            all[k] = static_cast<std::int16_t>(moved < -most ? -most : moved > most ? most : moved);
        }
    }
#endif
};

/// Weights of `Count` estimates, in units of 2^-12.
template <unsigned Count> struct MixWeights
{
    static_assert(Count <= Lanes::kCount);
    static constexpr int kUnitBits = 12;
    /// Weights stay within 8 of 0, whatever is coded.
    static constexpr std::int16_t kMost = 32600;
    static constexpr std::int16_t kStart = static_cast<std::int16_t>((1 << kUnitBits) * 12 / 10 / Count);

    Lanes weight;

    MixWeights() { setAll(std::make_integer_sequence<unsigned, Count>()); }

private:
    template <unsigned... K> void setAll(std::integer_sequence<unsigned, K...>)
    {
        (weight.set<K>(kStart), ...);
    }
};

template <unsigned... K>
Lanes trustedEstimates(BitModel* const* models, std::integer_sequence<unsigned, K...>)
{
    Lanes stretched, trusts;
    (stretched.set<K>(kStretch.value[unsigned{models[K]->estimate} >> 4]), ...);
    (trusts.set<K>(kTrust.value[models[K]->seen]), ...);
    return stretched.scaled(trusts);
}

/// One bit whose probability is mixed from the models' estimates. Bits are coded as
/// coder.code(probability of zero, bit).
template <unsigned Count, class Coder>
bool codeMixed(Coder& coder, BitModel* const (&models)[Count], MixWeights<Count>& weights, bool bit)
{
    const Lanes estimates = trustedEstimates(models, std::make_integer_sequence<unsigned, Count>());
    const std::uint32_t zero = quickSquash(weights.weight.times(estimates) >> MixWeights<Count>::kUnitBits);
    const bool one = coder.code(zero, bit);
    if (!Coder::kAdapts) return one;
    const int error = (one ? 0 : 1 << kProbabilityBits) - static_cast<int>(zero);
    weights.weight.move(estimates, static_cast<std::int16_t>(error * 3 >> 4), MixWeights<Count>::kMost);
    for (unsigned k = 0; k < Count; ++k) models[k]->update(one);
    return one;
}

} // namespace gimg::codec

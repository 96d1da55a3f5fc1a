#pragma once

#include <cstdint>

namespace gimg::codec {

/// Probabilities are in units of 2^-15.
constexpr unsigned kProbabilityBits = 15;

/// The position of the highest bit that is set; `value` is not 0.
inline unsigned log2Floor(std::uint32_t value)
{
#if defined(__GNUC__)
    return 31u - static_cast<unsigned>(__builtin_clz(value));
#else
    unsigned position = 0;
    while (value >>= 1) ++position;
    return position;
#endif
}

/// How far an estimate moves towards the bit that it was followed by, in 2^-15: 1 / (n + 1.6) after n bits,
/// so that a model seen a few times is already of use.
struct RateTable
{
    static constexpr unsigned kSlowest = 62;
    std::uint16_t value[kSlowest + 1];

    constexpr RateTable() : value()
    {
        for (unsigned n = 0; n <= kSlowest; ++n)
            value[n] = static_cast<std::uint16_t>(327680u / (10 * n + 16));
    }
};
inline constexpr RateTable kRates{};

/// An adaptive estimate of the probability that a bit is 0.
struct BitModel
{
    std::uint16_t estimate = 1u << 15; ///< in 2^-16
    std::uint16_t seen = 0;

    /// Estimates stay this far from 0 and 2^16 - 1.
    static constexpr int kLeast = 64;

    /// In [kLeast / 2, 2^15 - 1 - kLeast / 2].
    std::uint32_t zero() const { return estimate >> 1; }

    void update(bool bit)
    {
        const int away = (bit ? kLeast : 65535 - kLeast) - static_cast<int>(estimate);
        estimate =
            static_cast<std::uint16_t>(static_cast<int>(estimate) + ((away * kRates.value[seen]) >> 15));
        if (seen < RateTable::kSlowest) ++seen;
    }
};

} // namespace gimg::codec

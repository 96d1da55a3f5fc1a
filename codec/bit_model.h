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

/// An adaptive estimate of the probability that a bit is 0: the mean of a quick and a slow one.
/// Both begin quicker than they end, so that a model seen a few times is already of use.
struct BitModel
{
    std::uint16_t quick = 1u << 15;
    std::uint16_t slow = 1u << 15;
    std::uint8_t seen = 0;

    static constexpr unsigned kQuickShift = 4;
    static constexpr unsigned kSlowShift = 7;
    static constexpr unsigned kSeenCap = 126; // log2Floor(126 + 2) = kSlowShift

    /// In [19, 32748]: the shifts keep the estimates away from 0 and 2^16.
    std::uint32_t zero() const { return (std::uint32_t{quick} + slow) >> 2; }

    void update(bool bit)
    {
        const unsigned shift = log2Floor(seen + 2u);
        quick = moved(quick, shift < kQuickShift ? shift : kQuickShift, bit);
        slow = moved(slow, shift, bit);
        if (seen < kSeenCap) ++seen;
    }

private:
    static std::uint16_t moved(std::uint16_t estimate, unsigned shift, bool bit)
    {
        const std::uint32_t value = estimate;
        return static_cast<std::uint16_t>(bit ? value - (value >> shift)
                                              : value + ((65536u - value) >> shift));
    }
};

} // namespace gimg::codec

#pragma once

#include <cstdint>
#include <cstring>

namespace gimg::codec {

// Sums of bytes by eight. Which byte comes first in a word makes no difference: masks are symmetric, or made
// of bytes as well.

inline std::uint64_t eightBytes(const std::uint8_t* bytes)
{
    std::uint64_t word;
    std::memcpy(&word, bytes, sizeof word);
    return word;
}

/// Two sets of four sums of up to 2^16 - 1.
class ByteSums
{
public:
    void add(std::uint64_t word)
    {
        sums_[0] += word & kLow;
        sums_[1] += word >> 8 & kLow;
    }

    /// Of all that was added; below 2^16.
    unsigned total() const
    {
        return static_cast<unsigned>(((sums_[0] + sums_[1]) * 0x0001000100010001u) >> 48);
    }

private:
    static constexpr std::uint64_t kLow = 0x00FF00FF00FF00FFu;
    std::uint64_t sums_[2] = {};
};

/// Bytes 0, 2, 4 and 6 of eight, the others 0.
inline std::uint64_t everySecond(std::uint64_t word)
{
    constexpr std::uint8_t kBytes[8] = {255, 0, 255, 0, 255, 0, 255, 0};
    return word & eightBytes(kBytes);
}

} // namespace gimg::codec

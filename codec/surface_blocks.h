#pragma once

#include "mixer.h"
#include "subbands.h"

#include <cstring>

namespace gimg::codec {

/// A level of n x n samples in blocks of 8 x 8, those at the far sides one sample larger: which of them hold
/// details that are not 0, along the normal and along the tangents. The others cost one flag, and no time.
class BlockMap
{
public:
    static constexpr std::uint32_t kBlock = 8;
    static constexpr std::uint32_t side(std::uint32_t n) { return n <= kBlock ? 1 : (n - 1) / kBlock; }
    /// Bytes for levels of up to n x n samples.
    static constexpr std::size_t memory(std::uint32_t n)
    {
        return (std::size_t{side(n)} + 2) * (std::size_t{side(n)} + 2);
    }

    /// The block of a row or column.
    static std::uint32_t blockOf(std::uint32_t k, std::uint32_t side)
    {
        return k / kBlock < side ? k / kBlock : side - 1;
    }

    BlockMap() = default;
    /// @param flags  memory(n) zeros
    BlockMap(std::uint8_t* flags, std::uint32_t n) : flags_(flags), side_(side(n)) {}

    void clear() { std::memset(flags_, 0, (std::size_t{side_} + 2) * (std::size_t{side_} + 2)); }
    std::uint32_t side() const { return side_; }
    /// @param direction  0: the normal, 1: the tangents
    bool isFilled(std::uint32_t bi, std::uint32_t bj, unsigned direction) const
    {
        return (flags_[at(bi, bj)] >> direction & 1u) != 0;
    }
    /// Bit 0: the normal, bit 1: the tangents.
    unsigned flags(std::uint32_t bi, std::uint32_t bj) const { return flags_[at(bi, bj)]; }
    void fill(std::uint32_t bi, std::uint32_t bj, unsigned direction)
    {
        flags_[at(bi, bj)] |= static_cast<std::uint8_t>(1u << direction);
    }

    /// 0 to 8: how much is filled around.
    unsigned around(std::uint32_t bi, std::uint32_t bj, unsigned direction) const
    {
        const std::uint8_t* here = flags_ + at(bi, bj);
        const std::uint8_t *above = here - (side_ + 2), *below = here + (side_ + 2);
        const auto flag = [direction](std::uint8_t flags) { return flags >> direction & 1u; };
        return 2u * (flag(here[-1]) + flag(above[0])) + flag(above[-1]) + flag(above[1]) + flag(here[1]) +
               flag(below[0]);
    }

private:
    std::size_t at(std::uint32_t bi, std::uint32_t bj) const
    {
        return (std::size_t{bj} + 1) * (std::size_t{side_} + 2) + bi + 1;
    }

    std::uint8_t* flags_ = nullptr;
    std::uint32_t side_ = 0;
};

} // namespace gimg::codec

#pragma once

#include "bit_model.h"

namespace gimg::codec {

/// Models of an adaptive Exp-Golomb code: a number is coded as the bit count of (number + 1), in
/// unary, and the bits below its highest, the uppermost of which is modelled too.
template <unsigned Prefixes> struct ExpGolombModels
{
    BitModel more[Prefixes];
    BitModel upper[Prefixes];
};

/// `count` bits of equal chances, of a number that may be longer than the coder's 32.
template <class Coder> std::uint64_t codeRaw(Coder& coder, unsigned count, std::uint64_t value)
{
    std::uint64_t high = 0;
    if (count > 32) {
        high = coder.raw(count - 32, static_cast<std::uint32_t>(value >> 32));
        count = 32;
    }
    return high << 32 | coder.raw(count, static_cast<std::uint32_t>(value));
}

/// Codes a number below 2^Prefixes - 1; Coder is RangeDecoder or a class that mirrors it.
template <class Coder, unsigned Prefixes>
std::uint64_t codeExpGolomb(Coder& coder, ExpGolombModels<Prefixes>& models, std::uint64_t value)
{
    static_assert(Prefixes <= 60);
    const std::uint64_t shifted = value + 1;
    unsigned bits = 0;
    while (bits < Prefixes && coder.bit(models.more[bits], shifted >> bits > 1)) ++bits;
    if (bits == 0) return 0;
    if (bits == Prefixes) return coder.fail(), std::uint64_t{0};
    const unsigned rest = bits - 1;
    const std::uint64_t top = coder.bit(models.upper[bits], (shifted >> rest & 1u) != 0) ? 3 : 2;
    return (top << rest | codeRaw(coder, rest, shifted & ((std::uint64_t{1} << rest) - 1))) - 1;
}

} // namespace gimg::codec

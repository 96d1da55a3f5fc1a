#pragma once

#include "bit_model.h"

#include <vector>

namespace gimg::codec {

/// Binary range encoder with carry propagation; see RangeDecoder.
class RangeEncoder
{
public:
    static constexpr bool kDecodes = false;
    static constexpr bool kAdapts = true;

    bool code(std::uint32_t zero, bool one)
    {
        const std::uint32_t bound = (range_ >> kProbabilityBits) * zero;
        if (one) {
            low_ += bound;
            range_ -= bound;
        } else {
            range_ = bound;
        }
        normalise();
        return one;
    }

    bool bit(BitModel& model, bool one)
    {
        code(model.zero(), one);
        model.update(one);
        return one;
    }

    std::uint32_t raw(unsigned count, std::uint32_t value)
    {
        for (unsigned k = count; k-- > 0;) {
            range_ >>= 1;
            if ((value >> k & 1u) != 0) low_ += range_;
            normalise();
        }
        return value;
    }

    void fail() { failed_ = true; }
    bool failed() const { return failed_; }

    static constexpr bool hasEnded() { return false; }

    /// About how many bytes finish() will return.
    std::size_t bytesSoFar() const { return bytes_.size() + pending_; }

    /// The coded bytes; ends the encoder.
    std::vector<std::uint8_t> finish();

private:
    void normalise()
    {
        while (range_ < 1u << 24) {
            range_ <<= 8;
            shiftOut();
        }
    }

    void shiftOut();

    std::vector<std::uint8_t> bytes_;
    std::uint64_t low_ = 0;
    std::uint32_t range_ = 0xFFFFFFFFu;
    std::size_t pending_ = 0;  // bytes held back because a carry may still change them
    std::uint8_t held_ = 0xFF; // the first of them; the others are 0xFF
    bool failed_ = false;
};

} // namespace gimg::codec

#pragma once

#include "bit_model.h"
#include "format/bytes.h"

namespace gimg::codec {

/// Binary range decoder. Its calls mirror RangeEncoder's: the value argument is what an encoder would
/// write, and is ignored here. Code that is a template over the two is both halves of a coder.
class RangeDecoder
{
public:
    static constexpr bool kDecodes = true;
    static constexpr bool kAdapts = true;
    /// The encoder leaves out up to this many zero bytes at the end.
    static constexpr std::size_t kMaxOverrun = 4;

    /// @param isPrefix  more bytes would follow, but are not there
    explicit RangeDecoder(format::ByteSpan bytes, bool isPrefix = false)
        : bytes_(bytes), end_(isPrefix ? bytes.size : bytes.size + kMaxOverrun)
    {
        for (int k = 0; k < 4; ++k) code_ = code_ << 8 | nextByte();
    }

    /// A bit that is 0 with a probability of zero / 2^15, which is neither 0 nor 1.
    bool code(std::uint32_t zero, bool = false)
    {
        const std::uint32_t bound = (range_ >> kProbabilityBits) * zero;
        const bool one = code_ >= bound;
        if (one) {
            code_ -= bound;
            range_ -= bound;
        } else {
            range_ = bound;
        }
        normalise();
        return one;
    }

    bool bit(BitModel& model, bool = false)
    {
        const bool one = code(model.zero());
        model.update(one);
        return one;
    }

    /// `count` bits of equal chances, the highest first; count <= 32.
    std::uint32_t raw(unsigned count, std::uint32_t = 0)
    {
        std::uint32_t value = 0;
        for (unsigned k = 0; k < count; ++k) {
            range_ >>= 1;
            const bool one = code_ >= range_;
            if (one) code_ -= range_;
            value = value << 1 | (one ? 1u : 0u);
            normalise();
        }
        return value;
    }

    /// Something was read that no encoder writes.
    void fail() { failed_ = true; }
    bool failed() const { return failed_ || at_ > bytes_.size + kMaxOverrun; }

    /// What was read last hangs on bytes that are not there.
    bool hasEnded() const { return at_ > end_; }

    /// At the end: every byte was needed.
    bool finished() const { return !failed() && at_ >= bytes_.size; }

private:
    std::uint32_t nextByte()
    {
        const std::size_t at = at_++;
        return at < bytes_.size ? bytes_.data[at] : 0u;
    }

    void normalise()
    {
        while (range_ < 1u << 24) {
            range_ <<= 8;
            code_ = code_ << 8 | nextByte();
        }
    }

    format::ByteSpan bytes_;
    std::size_t end_;
    std::size_t at_ = 0;
    std::uint32_t range_ = 0xFFFFFFFFu;
    std::uint32_t code_ = 0;
    bool failed_ = false;
};

} // namespace gimg::codec

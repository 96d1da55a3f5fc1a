#include "range_encoder.h"

#include "range_decoder.h"

namespace gimg::codec {

void RangeEncoder::shiftOut()
{
    const bool carry = (low_ >> 32) != 0;
    if (carry || static_cast<std::uint32_t>(low_) < 0xFF000000u) {
        // Settled: the held bytes take the carry and go.
        const std::uint8_t add = carry ? 1 : 0;
        for (std::size_t k = 0; k < pending_; ++k)
            bytes_.push_back(static_cast<std::uint8_t>((k == 0 ? held_ : 0xFFu) + add));
        pending_ = 0;
        held_ = static_cast<std::uint8_t>(low_ >> 24);
    }
    ++pending_;
    low_ = (low_ & 0x00FFFFFFu) << 8;
}

std::vector<std::uint8_t> RangeEncoder::finish()
{
    // Of the numbers that decode alike, the one that ends in the most zeros; those need not be written.
    const std::uint64_t last = low_ + range_ - 1;
    std::uint64_t value = last;
    for (unsigned zeros = 1; zeros <= 32; ++zeros) {
        const std::uint64_t candidate = last >> zeros << zeros;
        if (candidate < low_) break;
        value = candidate;
    }
    low_ = value;
    for (int k = 0; k < 5; ++k) shiftOut();
    for (std::size_t k = 0; k < RangeDecoder::kMaxOverrun && !bytes_.empty() && bytes_.back() == 0; ++k)
        bytes_.pop_back();
    return bytes_;
}

} // namespace gimg::codec

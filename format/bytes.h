#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace gimg::format {

/// How reading ends. The values are those of gim_status in gim.h, which the codec asserts.
enum class ReadStatus : std::uint8_t
{
    Ok = 0,
    MoreInput = 1,
    Corrupt = 2,
    Unsupported = 3,
    Limit = 4,
    Misuse = 5,
};

/// A run of bytes that somebody else owns.
struct ByteSpan
{
    const std::uint8_t* data = nullptr;
    std::size_t size = 0;
};

/// Reads little-endian numbers from a run of bytes and never past its end: a read that does not fit
/// gives 0 and marks the reader as failed, once and for all.
class Reader
{
public:
    explicit Reader(ByteSpan bytes) : bytes_(bytes) {}

    std::uint8_t u8() { return take(1) ? bytes_.data[at_ - 1] : std::uint8_t{0}; }

    std::uint32_t u32()
    {
        if (!take(4)) return 0;
        const std::uint8_t* p = bytes_.data + at_ - 4;
        return p[0] | std::uint32_t{p[1]} << 8 | std::uint32_t{p[2]} << 16 | std::uint32_t{p[3]} << 24;
    }

    float f32()
    {
        const std::uint32_t bits = u32();
        float value;
        std::memcpy(&value, &bits, sizeof value);
        return value;
    }

    ByteSpan span(std::size_t size)
    {
        if (!take(size)) return {};
        return {bytes_.data + at_ - size, size};
    }

    std::size_t offset() const { return at_; }
    std::size_t remaining() const { return bytes_.size - at_; }
    bool failed() const { return failed_; }

private:
    bool take(std::size_t count)
    {
        if (failed_ || count > remaining()) return failed_ = true, false;
        at_ += count;
        return true;
    }

    ByteSpan bytes_;
    std::size_t at_ = 0;
    bool failed_ = false;
};

} // namespace gimg::format

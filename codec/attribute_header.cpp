#include "attribute_header.h"

namespace gimg::codec {

namespace {

// Bytes of the character at the front; 0 if there is none, or a control character.
std::size_t characterSize(format::ByteSpan text)
{
    const auto at = [&](std::size_t k) -> std::uint32_t { return k < text.size ? text.data[k] : 0; };
    const std::uint32_t first = at(0);
    if (first < 0x80) return first >= 0x20 && first != 0x7F ? 1 : 0;
    const std::size_t size = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
    std::uint32_t code = first & (0x7Fu >> size);
    for (std::size_t k = 1; k < size; ++k) {
        if ((at(k) & 0xC0u) != 0x80) return 0;
        code = code << 6 | (at(k) & 0x3Fu);
    }
    constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool sound = first >= 0xC0 && first < 0xF8 && code >= kLeast[size] && code <= 0x10FFFF &&
                       (code < 0xD800 || code > 0xDFFF) && code >= 0xA0;
    return sound ? size : 0;
}

} // namespace

bool isAttributeName(format::ByteSpan name)
{
    if (name.size < 1 || name.size > kMaxName) return false;
    while (name.size > 0) {
        const std::size_t size = characterSize(name);
        if (size == 0) return false;
        name = {name.data + size, name.size - size};
    }
    return true;
}

ReadStatus readAttributeHeader(format::ByteSpan content, AttributeHeader* header)
{
    format::Reader in(content);
    header->name = in.span(in.u8());
    header->channels = in.u8();
    const std::uint8_t kind = in.u8();
    if (in.failed() || !isAttributeName(header->name)) return ReadStatus::Corrupt;
    if (header->channels < 1 || header->channels > kMaxChannels) return ReadStatus::Corrupt;
    const unsigned type = kind & 3u;
    if (type > GIM_F32 || kind >> 4 != 0) return ReadStatus::Unsupported;
    header->type = static_cast<gim_sample_type>(type);
    header->glued = (kind & kGluedFlag) != 0;
    header->normalized = (kind & kNormalizedFlag) != 0;
    if (header->normalized && header->type == GIM_F32) return ReadStatus::Corrupt;
    const std::size_t before = in.offset();
    const ReadStatus status = readImageHeader(in.span(in.remaining()), ImageKind::Attribute, &header->image);
    header->image.fixedBytes += before;
    return status;
}

} // namespace gimg::codec

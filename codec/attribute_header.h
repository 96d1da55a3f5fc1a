#pragma once

#include "image_header.h"

namespace gimg::codec {

constexpr std::uint32_t kMaxChannels = GIM_MAX_CHANNELS;
constexpr std::size_t kMaxName = GIM_MAX_ATTRIBUTE_NAME;

/// Bits of the byte that says what samples are. The lowest two are the gim_sample_type.
constexpr std::uint8_t kGluedFlag = 1u << 2;
constexpr std::uint8_t kNormalizedFlag = 1u << 3;

/// What the chunk of an attribute image tells before its coded samples.
struct AttributeHeader
{
    format::ByteSpan name; ///< UTF-8
    std::uint32_t channels = 0;
    gim_sample_type type = GIM_U8;
    bool glued = false, normalized = false;
    ImageHeader image;
};

/// Reads and checks the fixed fields of an attribute chunk.
ReadStatus readAttributeHeader(format::ByteSpan content, AttributeHeader* header);

/// Whether the bytes are 1 to 63 of UTF-8 without control characters.
bool isAttributeName(format::ByteSpan name);

constexpr std::size_t sampleSize(gim_sample_type type)
{
    return type == GIM_U8 ? 1 : type == GIM_U16 ? 2 : 4;
}

/// Bytes that decodeAttribute() takes from its arena.
std::uint64_t attributeWorkspace(const AttributeHeader& header);

/// Decodes an attribute into `channels` numbers of its type for each sample.
/// @param classes  borderClasses() of the grid
ReadStatus decodeAttribute(const AttributeHeader& header, const SeamView& seam, const std::uint32_t* classes,
                           Arena& arena, void* out);

} // namespace gimg::codec

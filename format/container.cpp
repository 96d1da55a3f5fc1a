#include "container.h"

#include <zlib.h>

namespace gimg::format {

namespace {

// A fuzzer cannot guess checksums; in its build they are read and not compared.
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
constexpr bool kCompareChecksums = false;
#else
constexpr bool kCompareChecksums = true;
#endif

bool checksumDiffers(std::uint32_t stored, ByteSpan bytes)
{
    return kCompareChecksums && stored != crc(bytes);
}

// Base-128, low bits first, at most 32 bits. Only the shortest form of a number is allowed, so that
// a file has one spelling.
ReadStatus readLength(Reader& in, std::uint32_t* length)
{
    std::uint32_t value = 0;
    for (unsigned shift = 0; shift < 35; shift += 7) {
        const std::uint8_t byte = in.u8();
        if (in.failed()) return ReadStatus::MoreInput;
        const std::uint32_t bits = byte & 0x7Fu;
        if (shift == 28 && bits > 0x0F) return ReadStatus::Corrupt;
        value |= bits << shift;
        if ((byte & 0x80u) == 0) {
            if (byte == 0 && shift > 0) return ReadStatus::Corrupt;
            *length = value;
            return ReadStatus::Ok;
        }
    }
    return ReadStatus::Corrupt;
}

} // namespace

std::uint32_t crc(ByteSpan bytes)
{
    // zlib takes 32-bit sizes; files may be larger on paper.
    uLong sum = crc32(0, nullptr, 0);
    while (bytes.size > 0) {
        const std::size_t part = bytes.size < 0x40000000u ? bytes.size : 0x40000000u;
        sum = crc32(sum, bytes.data, static_cast<uInt>(part));
        bytes = {bytes.data + part, bytes.size - part};
    }
    return static_cast<std::uint32_t>(sum);
}

ReadStatus ChunkWalk::open()
{
    // A wrong magic is told apart from a short file as early as possible.
    for (std::size_t k = 0; k < sizeof kMagic && k < file_.size; ++k)
        if (file_.data[k] != kMagic[k]) return ReadStatus::Corrupt;
    in_.span(sizeof kMagic);
    const std::uint8_t version = in_.u8();
    if (in_.failed()) return ReadStatus::MoreInput;
    // Another version may lay out even the header differently, so it is tested before the checksum.
    if (version != kVersion) return ReadStatus::Unsupported;
    const std::uint8_t count = in_.u8();
    const std::uint32_t sum = in_.u32();
    if (in_.failed()) return ReadStatus::MoreInput;
    if (checksumDiffers(sum, {file_.data, kHeaderSize - 4})) return ReadStatus::Corrupt;
    count_ = count;
    return ReadStatus::Ok;
}

ReadStatus ChunkWalk::next(Chunk* chunk)
{
    const std::size_t begin = in_.offset();
    const std::uint8_t type = in_.u8();
    if (in_.failed()) return ReadStatus::MoreInput;
    if (!isLetter(type)) return ReadStatus::Corrupt;
    std::uint32_t length = 0;
    if (const ReadStatus status = readLength(in_, &length); status != ReadStatus::Ok) return status;
    const std::size_t offset = in_.offset();
    if (in_.remaining() < std::uint64_t{length} + 4) {
        const std::size_t rest = in_.remaining(), there = rest < length ? rest : length;
        *chunk = {type, in_.span(there), offset, offset + rest - begin, length - there};
        return ReadStatus::MoreInput;
    }
    const ByteSpan content = in_.span(length);
    const std::size_t end = in_.offset();
    const std::uint32_t sum = in_.u32();
    if (in_.failed()) return ReadStatus::MoreInput;
    if (checksumDiffers(sum, {file_.data + begin, end - begin})) return ReadStatus::Corrupt;
    *chunk = {type, content, offset, in_.offset() - begin, 0};
    return ReadStatus::Ok;
}

ReadStatus readContents(ByteSpan file, bool allowPrefix, Contents* contents)
{
    ChunkWalk walk(file);
    if (const ReadStatus status = walk.open(); status != ReadStatus::Ok) return status;
    *contents = {};
    contents->chunks = walk.count();
    // An unknown critical chunk is reported only if the file is sound otherwise: damage comes first.
    bool unknownCritical = false;
    for (std::uint32_t k = 0; k < walk.count(); ++k) {
        Chunk chunk;
        const ReadStatus status = walk.next(&chunk);
        if (status != ReadStatus::Ok && !(status == ReadStatus::MoreInput && allowPrefix)) return status;
        if (status == ReadStatus::MoreInput) {
            contents->isPrefix = true;
            if (contents->seam.type == 0) return status;
            if (contents->geometry.type == 0) {
                if (chunk.type != kGeometryChunk) return status;
                contents->geometry = chunk;
            }
            return unknownCritical ? ReadStatus::Unsupported : ReadStatus::Ok;
        }
        Chunk* known = nullptr;
        if (chunk.type == kSeamChunk) known = &contents->seam;
        if (chunk.type == kGeometryChunk) known = &contents->geometry;
        if (chunk.type == kNormalChunk) known = &contents->normals;
        if (chunk.type == kAttributeChunk) {
            if (contents->attributeCount == kMaxAttributes) return ReadStatus::Corrupt;
            known = &contents->attributes[contents->attributeCount++];
        }
        if (known != nullptr) {
            if (known->type != 0) return ReadStatus::Corrupt;
            *known = chunk;
        } else {
            contents->otherBytes += chunk.content.size;
            unknownCritical |= !isAncillary(chunk.type);
        }
    }
    if (const ReadStatus status = walk.close(); status != ReadStatus::Ok) return status;
    if (unknownCritical) return ReadStatus::Unsupported;
    if (contents->seam.type == 0 || contents->geometry.type == 0) return ReadStatus::Corrupt;
    return ReadStatus::Ok;
}

} // namespace gimg::format

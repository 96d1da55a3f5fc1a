#pragma once

#include "bytes.h"

namespace gimg::format {

constexpr std::uint8_t kMagic[4] = {0x89, 'G', 'I', 'M'};
constexpr std::uint8_t kVersion = 1;
constexpr std::size_t kHeaderSize = 10;
constexpr std::size_t kMaxChunks = 255;

/// Chunk types are letters. A small letter marks a chunk that a reader may skip.
constexpr std::uint8_t kSeamChunk = 'S';
constexpr std::uint8_t kGeometryChunk = 'G';
constexpr std::uint8_t kNormalChunk = 'n';
constexpr std::uint8_t kAttributeChunk = 'a';
constexpr std::size_t kMaxAttributes = 16;

constexpr bool isLetter(std::uint8_t type)
{
    return (type >= 'A' && type <= 'Z') || (type >= 'a' && type <= 'z');
}
constexpr bool isAncillary(std::uint8_t type) { return type >= 'a'; }

/// A chunk whose checksum was right.
struct Chunk
{
    std::uint8_t type = 0;
    ByteSpan content;
    std::size_t offset = 0;  ///< of the content in the file
    std::size_t total = 0;   ///< bytes with header and checksum
    std::size_t missing = 0; ///< bytes of the content that the file ends before
};

/// Walks a file's chunks in order.
class ChunkWalk
{
public:
    explicit ChunkWalk(ByteSpan file) : in_(file), file_(file) {}

    /// Reads the file's header; must come first.
    ReadStatus open();
    /// The next chunk. Call it count() times.
    /// MoreInput: the file ends within it; if that is in its content or checksum, the chunk holds what is
    /// there.
    ReadStatus next(Chunk* chunk);
    /// After the last chunk: nothing may follow it.
    ReadStatus close() const { return in_.remaining() == 0 ? ReadStatus::Ok : ReadStatus::Corrupt; }

    std::uint32_t count() const { return count_; }

private:
    Reader in_;
    ByteSpan file_;
    std::uint32_t count_ = 0;
};

/// What a file of this version holds.
struct Contents
{
    std::uint32_t chunks = 0;
    Chunk seam, geometry, normals; ///< type 0: absent
    Chunk attributes[kMaxAttributes];
    std::uint32_t attributeCount = 0;
    std::uint64_t otherBytes = 0; ///< contents of skipped chunks
    bool isPrefix = false;        ///< the file is cut short
};

/// Walks the whole file: checks every checksum, finds the known chunks, refuses unknown critical ones.
/// @param allowPrefix  a file that ends within its geometry chunk, or after it, will do if the seam comes
/// before
ReadStatus readContents(ByteSpan file, bool allowPrefix, Contents* contents);

std::uint32_t crc(ByteSpan bytes);

} // namespace gimg::format

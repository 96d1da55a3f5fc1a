#pragma once

#include "bytes.h"

#include <vector>

namespace gimg::format {

/// Builds a container chunk by chunk.
class Writer
{
public:
    /// Appends a chunk. At most 255 chunks of less than 2^32 bytes each.
    void addChunk(std::uint8_t type, const std::vector<std::uint8_t>& content);
    /// The whole file.
    std::vector<std::uint8_t> finish() const;

private:
    std::vector<std::uint8_t> chunks_;
    std::uint8_t count_ = 0;
};

void appendU32(std::vector<std::uint8_t>& out, std::uint32_t value);
void appendF32(std::vector<std::uint8_t>& out, float value);

/// Bytes that addChunk() appends for a content of this size.
std::size_t chunkSize(std::size_t contentSize);

} // namespace gimg::format

#include "writer.h"

#include "container.h"

#include <cassert>

namespace gimg::format {

void appendU32(std::vector<std::uint8_t>& out, std::uint32_t value)
{
    for (unsigned shift = 0; shift < 32; shift += 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

void appendF32(std::vector<std::uint8_t>& out, float value)
{
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    appendU32(out, bits);
}

std::size_t chunkSize(std::size_t contentSize)
{
    std::size_t lengthBytes = 1;
    for (std::size_t rest = contentSize >> 7; rest > 0; rest >>= 7) ++lengthBytes;
    return 1 + lengthBytes + contentSize + 4;
}

void Writer::addChunk(std::uint8_t type, const std::vector<std::uint8_t>& content)
{
    assert(isLetter(type) && count_ < kMaxChunks && content.size() <= 0xFFFFFFFFu);
    const std::size_t begin = chunks_.size();
    chunks_.push_back(type);
    std::size_t rest = content.size();
    for (; rest > 0x7F; rest >>= 7) chunks_.push_back(static_cast<std::uint8_t>(rest | 0x80u));
    chunks_.push_back(static_cast<std::uint8_t>(rest));
    chunks_.insert(chunks_.end(), content.begin(), content.end());
    appendU32(chunks_, crc({chunks_.data() + begin, chunks_.size() - begin}));
    ++count_;
}

std::vector<std::uint8_t> Writer::finish() const
{
    std::vector<std::uint8_t> file(kMagic, kMagic + sizeof kMagic);
    file.push_back(kVersion);
    file.push_back(count_);
    appendU32(file, crc({file.data(), file.size()}));
    file.insert(file.end(), chunks_.begin(), chunks_.end());
    return file;
}

} // namespace gimg::format

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace gimg::cli {

/// Writes a file whole or not at all: under another name (.gimenc-...) in the same folder, then renamed, so
/// that at no moment a part of it stands at `path`. Links are followed. What is there and is no regular file
/// (a device, a pipe) is written to directly. Returns whether all bytes reached the disk.
bool writeWhole(const std::string& path, const void* bytes, std::size_t size);

struct Contents
{
    std::uint64_t bytes = 0;
    std::string sha256; ///< 64 lower-case hexadecimal digits
};

/// Nothing if the file cannot be read to its end.
std::optional<Contents> contentsOf(const std::string& path);
Contents contentsOf(const void* bytes, std::size_t size);

} // namespace gimg::cli

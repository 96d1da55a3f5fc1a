#pragma once

#include "gimg/mesh.h"
#include "gimg/result.h"

#include <bit>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>
#include <type_traits>

namespace gimg {

/// Collects a file's bytes, text and binary.
class MeshOutput
{
public:
    explicit MeshOutput(bool bigEndian = false) : bigEndian_(bigEndian) {}

    MeshOutput& operator<<(std::string_view text)
    {
        bytes_ += text;
        return *this;
    }
    /// The shortest decimal that reads back as the same value.
    template <class Number> MeshOutput& operator<<(Number value) requires(std::is_arithmetic_v<Number>)
    {
        char digits[32];
        const auto [end, failure] = std::to_chars(digits, digits + sizeof digits, value);
        bytes_.append(digits, end);
        return *this;
    }
    MeshOutput& operator<<(const Vec3& p) { return *this << p[0] << " " << p[1] << " " << p[2]; }

    void binary(uint64_t bits, int size)
    {
        for (int k = 0; k < size; ++k)
            bytes_ += static_cast<char>(bits >> 8 * (bigEndian_ ? size - 1 - k : k) & 0xff);
    }
    void binary(float value) { binary(std::bit_cast<uint32_t>(value), 4); }
    void binary(double value) { binary(std::bit_cast<uint64_t>(value), 8); }

    const std::string& bytes() const { return bytes_; }

    Status save(const std::string& path) const
    {
        std::ofstream file(path, std::ios::binary);
        file.write(bytes_.data(), static_cast<std::streamsize>(bytes_.size()));
        file.close();
        if (!file) return Error{ErrorKind::FileNotWritable, path + ": cannot be written"};
        return Done{};
    }

private:
    std::string bytes_;
    bool bigEndian_;
};

} // namespace gimg

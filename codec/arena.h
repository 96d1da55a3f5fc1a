#pragma once

#include <cstddef>
#include <cstdint>

namespace gimg::codec {

/// Hands out pieces of the caller's workspace, front to back. A piece that does not fit is nullptr.
class Arena
{
public:
    static constexpr std::size_t kAlignment = 16;

    Arena(void* memory, std::size_t size) : at_(static_cast<unsigned char*>(memory)), left_(size)
    {
        const auto misalignment = reinterpret_cast<std::uintptr_t>(memory) % kAlignment;
        if (misalignment != 0) skip(kAlignment - misalignment);
    }

    template <class T> T* take(std::size_t count)
    {
        static_assert(alignof(T) <= kAlignment);
        if (count > (SIZE_MAX - kAlignment) / sizeof(T)) return nullptr;
        const std::size_t bytes = sizeOf<T>(count);
        unsigned char* piece = at_;
        return skip(bytes) ? reinterpret_cast<T*>(piece) : nullptr;
    }

    /// What take<T>(count) uses up, for computing workspace sizes.
    template <class T> static constexpr std::size_t sizeOf(std::size_t count)
    {
        return (count * sizeof(T) + kAlignment - 1) / kAlignment * kAlignment;
    }

private:
    bool skip(std::size_t bytes)
    {
        if (bytes > left_) return left_ = 0, false;
        at_ += bytes;
        left_ -= bytes;
        return true;
    }

    unsigned char* at_;
    std::size_t left_;
};

} // namespace gimg::codec

#pragma once

#include "gimg/encode.h"
#include "gimg/mesh_io.h"

#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// What the benchmarks share: the bunny, its file, and bars.
namespace gimg::bench {

/// The mesh, or nullptr where corpus/fetch has not brought it.
inline const Mesh* bunny()
{
    static const std::optional<Mesh> mesh = []() -> std::optional<Mesh> {
        const char* folder = std::getenv("GIMG_CORPUS_DIR");
        const std::string cache = folder != nullptr ? folder : std::string(GIMG_SOURCE_CORPUS) + "/cache";
        Result<MeshFile> read = readMesh(cache + "/bunny.obj");
        if (!read) return std::nullopt;
        return std::move(read->mesh);
    }();
    return mesh ? &*mesh : nullptr;
}

/// 257 x 257 samples in 12,000 bytes.
inline const std::vector<std::uint8_t>* bunnyFile()
{
    static const std::optional<std::vector<std::uint8_t>> file =
        []() -> std::optional<std::vector<std::uint8_t>> {
        if (bunny() == nullptr) return std::nullopt;
        EncodeOptions options;
        options.bytes = 12000;
        options.grid = 257;
        Result<EncodedMesh> encoded = encodeMesh(*bunny(), options);
        if (!encoded) return std::nullopt;
        return std::move(encoded->file);
    }();
    return file ? &*file : nullptr;
}

/// Skips the benchmark where the bunny is missing.
template <class T> bool have(benchmark::State& state, const T* what)
{
    if (what == nullptr) state.SkipWithError("no bunny: run corpus/fetch bunny");
    return what != nullptr;
}

/// Fails the benchmark if an iteration took longer than `bar` seconds on average.
class Bar
{
public:
    Bar(benchmark::State& state, double bar) : state_(state), bar_(bar), start_(Clock::now()) {}
    ~Bar()
    {
        const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
        if (seconds > bar_ * static_cast<double>(state_.iterations()))
            state_.SkipWithError("slower than its bar");
    }
    Bar(const Bar&) = delete;
    Bar& operator=(const Bar&) = delete;

private:
    using Clock = std::chrono::steady_clock;
    benchmark::State& state_;
    double bar_;
    Clock::time_point start_;
};

} // namespace gimg::bench

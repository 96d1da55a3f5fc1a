#include "gimg/border.h"
#include "gimg/cut.h"
#include "gimg/decode.h"
#include "gimg/distance.h"
#include "gimg/encode.h"
#include "gimg/flatten.h"
#include "gimg/mesh_io.h"
#include "gimg/sample.h"

#include <benchmark/benchmark.h>
#include <gim.h>

#include <chrono>
#include <cstdlib>
#include <optional>

namespace {

using namespace gimg;

const Mesh* bunny()
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

// 257 x 257 samples in 12,000 bytes.
const std::vector<uint8_t>* bunnyFile()
{
    static const std::optional<std::vector<uint8_t>> file = []() -> std::optional<std::vector<uint8_t>> {
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

// Skips the benchmark where the bunny is missing.
template <class T> bool have(benchmark::State& state, const T* what)
{
    if (what == nullptr) state.SkipWithError("no bunny: run corpus/fetch bunny");
    return what != nullptr;
}

// Fails the benchmark if an iteration took longer than `bar` seconds on average.
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

// From bytes to fused samples, one thread, workspace given. Bar: 30 ms.
void decodeSamples(benchmark::State& state)
{
    const std::vector<uint8_t>* file = bunnyFile();
    if (!have(state, file)) return;
    gim_info info{};
    info.size = sizeof info;
    gim_probe(file->data(), file->size(), nullptr, &info);
    std::vector<unsigned char> work(gim_workspace_size(&info));
    std::vector<float> xyz(size_t{3} * info.grid * info.grid);
    const Bar bar(state, 0.030);
    for (auto _ : state)
        if (gim_decode_geometry(file->data(), file->size(), nullptr, 0, work.data(), work.size(),
                                xyz.data()) != GIM_OK)
            state.SkipWithError("decoding failed");
    state.SetBytesProcessed(static_cast<int64_t>(state.iterations()) *
                            static_cast<int64_t>(xyz.size() * sizeof(float)));
}
BENCHMARK(decodeSamples)->Unit(benchmark::kMillisecond);

// Samples to an indexed mesh of the finest level.
void buildMesh(benchmark::State& state)
{
    const std::vector<uint8_t>* file = bunnyFile();
    if (!have(state, file)) return;
    const Result<DecodedImages> images = decodeImages(*file);
    std::vector<unsigned char> work(gim_workspace_size(&images->info));
    gim_mesh_counts counts{};
    counts.size = sizeof counts;
    gim_mesh_size(file->data(), file->size(), nullptr, 0, 0, work.data(), work.size(), &counts);
    std::vector<uint32_t> sample(counts.vertices), triangles(size_t{3} * counts.triangles);
    for (auto _ : state)
        if (gim_build_mesh(file->data(), file->size(), nullptr, 0, 0, work.data(), work.size(),
                           images->geometry.samples.data(), nullptr, sample.data(),
                           triangles.data()) != GIM_OK)
            state.SkipWithError("building failed");
}
BENCHMARK(buildMesh)->Unit(benchmark::kMillisecond);

void cut(benchmark::State& state)
{
    const Mesh* mesh = bunny();
    if (!have(state, mesh)) return;
    for (auto _ : state) benchmark::DoNotOptimize(cutToDisk(*mesh));
}
BENCHMARK(cut)->Unit(benchmark::kMillisecond);

void flatten(benchmark::State& state)
{
    const Mesh* mesh = bunny();
    if (!have(state, mesh)) return;
    const Result<SquareDisk> square = layOutBorder(*mesh, cutToDisk(*mesh), {257, 0});
    for (auto _ : state) benchmark::DoNotOptimize(flattenToSquare(*square));
}
BENCHMARK(flatten)->Unit(benchmark::kSecond)->Iterations(1);

void sample(benchmark::State& state)
{
    const Mesh* mesh = bunny();
    if (!have(state, mesh)) return;
    const Result<SquareDisk> square = layOutBorder(*mesh, cutToDisk(*mesh), {257, 0});
    const Result<Parameterization> map = flattenToSquare(*square);
    for (auto _ : state) benchmark::DoNotOptimize(sampleGeometry(*square, *map, 257));
}
BENCHMARK(sample)->Unit(benchmark::kMillisecond);

void measure(benchmark::State& state)
{
    const Mesh* mesh = bunny();
    const std::vector<uint8_t>* file = bunnyFile();
    if (!have(state, file)) return;
    const Result<DecodedImages> images = decodeImages(*file);
    const Result<Mesh> decoded = levelMesh(*file, *images, 0);
    for (auto _ : state) benchmark::DoNotOptimize(compareSurfaces(*mesh, *decoded));
}
BENCHMARK(measure)->Unit(benchmark::kMillisecond);

// The whole road. Bar: 60 s.
void encode(benchmark::State& state)
{
    const Mesh* mesh = bunny();
    if (!have(state, mesh)) return;
    EncodeOptions options;
    options.bytes = 12000;
    const Bar bar(state, 60);
    for (auto _ : state) benchmark::DoNotOptimize(encodeMesh(*mesh, options));
}
BENCHMARK(encode)->Unit(benchmark::kSecond)->Iterations(1);

} // namespace

// The stages of decoding, and the transform of encoding, on 257 x 257 samples in 12,000 bytes. The first two
// are the calls of the C interface, the others what these are made of.
#include "bunny.h"

#include "codec/arena.h"
#include "codec/forward.h"
#include "codec/fuse.h"
#include "codec/image_header.h"
#include "codec/seam.h"
#include "codec/triangulate.h"
#include "format/container.h"
#include "gimg/decode.h"

#include <gim.h>

namespace {

using namespace gimg;
using namespace gimg::bench;

/// The bunny's file, taken apart.
struct Stages
{
    const std::vector<std::uint8_t>& file;
    DecodedImages images;
    codec::ImageHeader header;
    std::vector<std::uint32_t> classes; ///< of the border's samples

    std::uint32_t grid() const { return header.grid; }
    size_t samples() const { return size_t{grid()} * grid(); }
};

std::vector<std::uint32_t> classesOf(const std::vector<std::uint8_t>& file, const gim_info& info)
{
    std::vector<unsigned char> work(gim_workspace_size(&info));
    gim_seam seam{};
    seam.size = sizeof seam;
    std::vector<gim_side> sides(4 * size_t{info.lowest - 1});
    gim_read_seam(file.data(), file.size(), nullptr, work.data(), work.size(), &seam, sides.data(),
                  static_cast<std::uint32_t>(sides.size()));
    sides.resize(seam.sides);
    return codec::borderClasses(codec::Seam{info.lowest, seam.start, sides}, info.grid);
}

const Stages* stages()
{
    static const std::optional<Stages> all = []() -> std::optional<Stages> {
        const std::vector<std::uint8_t>* file = bunnyFile();
        if (file == nullptr) return std::nullopt;
        Result<DecodedImages> images = decodeImages(*file);
        format::Contents contents;
        codec::ImageHeader header;
        const bool sound =
            images.ok() &&
            format::readContents({file->data(), file->size()}, &contents) == format::ReadStatus::Ok &&
            codec::readImageHeader(contents.geometry.content, codec::ImageKind::Geometry, &header) == format::ReadStatus::Ok;
        if (!sound) return std::nullopt;
        std::vector<std::uint32_t> classes = classesOf(*file, images->info);
        return Stages{*file, std::move(*images), header, std::move(classes)};
    }();
    return all ? &*all : nullptr;
}

// From bytes to fused samples, one thread, workspace given. Bar: 30 ms.
void decodeSamples(benchmark::State& state)
{
    const Stages* s = stages();
    if (!have(state, s)) return;
    std::vector<unsigned char> work(gim_workspace_size(&s->images.info));
    std::vector<float> xyz(3 * s->samples());
    const Bar bar(state, 0.030);
    for (auto _ : state)
        if (gim_decode_geometry(s->file.data(), s->file.size(), nullptr, 0, work.data(), work.size(),
                                xyz.data()) != GIM_OK)
            state.SkipWithError("decoding failed");
    state.SetBytesProcessed(static_cast<int64_t>(state.iterations()) *
                            static_cast<int64_t>(xyz.size() * sizeof(float)));
}
BENCHMARK(decodeSamples)->Unit(benchmark::kMillisecond);

// Samples to an indexed mesh of the finest level.
void buildMesh(benchmark::State& state)
{
    const Stages* s = stages();
    if (!have(state, s)) return;
    std::vector<unsigned char> work(gim_workspace_size(&s->images.info));
    gim_mesh_counts counts{};
    counts.size = sizeof counts;
    gim_mesh_size(s->file.data(), s->file.size(), nullptr, 0, 0, work.data(), work.size(), &counts);
    std::vector<uint32_t> sample(counts.vertices), triangles(size_t{3} * counts.triangles);
    for (auto _ : state)
        if (gim_build_mesh(s->file.data(), s->file.size(), nullptr, 0, 0, work.data(), work.size(),
                           s->images.geometry.samples.data(), nullptr, sample.data(),
                           triangles.data()) != GIM_OK)
            state.SkipWithError("building failed");
}
BENCHMARK(buildMesh)->Unit(benchmark::kMillisecond);

// Headers and checksums, which every call of the C interface reads.
void readHeaders(benchmark::State& state)
{
    const Stages* s = stages();
    if (!have(state, s)) return;
    gim_info info{};
    info.size = sizeof info;
    for (auto _ : state)
        if (gim_probe(s->file.data(), s->file.size(), nullptr, &info) != GIM_OK)
            state.SkipWithError("reading failed");
}
BENCHMARK(readHeaders)->Unit(benchmark::kMillisecond);

// Range decoder, mixing and contexts: bytes to quantised coefficients.
void decodeEntropy(benchmark::State& state)
{
    const Stages* s = stages();
    if (!have(state, s)) return;
    std::vector<unsigned char> work(codec::imageWorkspace(s->header) + codec::Arena::kAlignment);
    for (auto _ : state) {
        codec::Arena arena(work.data(), work.size());
        codec::QuantizedImage image;
        if (codec::decodeCoefficients(s->header, arena, &image) != format::ReadStatus::Ok)
            state.SkipWithError("decoding failed");
    }
    state.SetBytesProcessed(static_cast<int64_t>(state.iterations()) *
                            static_cast<int64_t>(s->header.samples.size));
}
BENCHMARK(decodeEntropy)->Unit(benchmark::kMillisecond);

// Quantised coefficients to samples, all three components.
void inverseTransform(benchmark::State& state)
{
    const Stages* s = stages();
    if (!have(state, s)) return;
    std::vector<unsigned char> work(codec::imageWorkspace(s->header) + codec::Arena::kAlignment);
    codec::Arena arena(work.data(), work.size());
    codec::QuantizedImage image;
    if (codec::decodeCoefficients(s->header, arena, &image) != format::ReadStatus::Ok)
        return state.SkipWithError("decoding failed");
    const auto dequantize = codec::Dequantizer::fromByte(s->header.step, s->header.shifts);
    std::vector<double> samples(s->samples()), coarse(s->samples());
    for (auto _ : state)
        for (unsigned c = 0; c < codec::kComponents; ++c) {
            codec::reconstructComponent(image, c, dequantize, samples.data(), coarse.data());
            benchmark::DoNotOptimize(samples.data());
            benchmark::ClobberMemory();
        }
}
BENCHMARK(inverseTransform)->Unit(benchmark::kMillisecond);

void forwardTransform(benchmark::State& state)
{
    const Stages* s = stages();
    if (!have(state, s)) return;
    for (auto _ : state) benchmark::DoNotOptimize(codec::transform(s->images.geometry.samples, s->grid()));
}
BENCHMARK(forwardTransform)->Unit(benchmark::kMillisecond);

// The border of all three components made one; with an argument of 1, what that changed spread inwards.
void fuse(benchmark::State& state)
{
    const Stages* s = stages();
    if (!have(state, s)) return;
    const std::vector<float>& xyz = s->images.geometry.samples;
    std::vector<double> component(s->samples()), scratch(2 * s->classes.size());
    for (size_t k = 0; k < component.size(); ++k) component[k] = static_cast<double>(xyz[3 * k]);
    for (auto _ : state)
        for (unsigned c = 0; c < codec::kComponents; ++c) {
            codec::fuseBorder(component.data(), s->grid(), s->classes.data(), state.range(0) != 0,
                              scratch.data());
            benchmark::DoNotOptimize(component.data());
            benchmark::ClobberMemory();
        }
}
BENCHMARK(fuse)->ArgName("diffuse")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

// Numbers of vertices, glued samples being one, and the triangles.
void generateIndices(benchmark::State& state)
{
    const Stages* s = stages();
    if (!have(state, s)) return;
    const std::uint32_t n = s->grid();
    std::vector<std::uint32_t> scratch(s->classes.size()), vertex(s->samples()), sample(s->samples());
    std::vector<std::uint32_t> triangles(size_t{6} * (n - 1) * (n - 1));
    for (auto _ : state) {
        codec::numberVertices(n, 1, n, s->classes.data(), scratch.data(), vertex.data(), sample.data());
        codec::triangulate(n, 1, n, s->images.geometry.samples.data(), vertex.data(), triangles.data());
        benchmark::DoNotOptimize(triangles.data());
        benchmark::ClobberMemory();
    }
}
BENCHMARK(generateIndices)->Unit(benchmark::kMillisecond);

} // namespace

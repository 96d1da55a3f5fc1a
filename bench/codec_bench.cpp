// The stages of decoding, and the transform of encoding, on 257 x 257 samples in 12,000 bytes. The first two
// are the calls of the C interface, the others what these are made of.
#include "bunny.h"

#include "codec/fuse.h"
#include "codec/image_header.h"
#include "codec/lifting.h"
#include "codec/surface_encoder.h"
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
    codec::Seam seam;
    std::vector<std::uint32_t> classes; ///< of the border's samples

    std::uint32_t grid() const { return header.grid; }
    codec::SeamView view() const
    {
        return {seam.sides.data(), static_cast<std::uint32_t>(seam.sides.size()), seam.start, seam.lowest};
    }
    size_t samples() const { return size_t{grid()} * grid(); }
};

codec::Seam seamOf(const std::vector<std::uint8_t>& file, const gim_info& info)
{
    std::vector<unsigned char> work(gim_workspace_size(&info));
    gim_seam seam{};
    seam.size = sizeof seam;
    std::vector<gim_side> sides(4 * size_t{info.lowest - 1});
    gim_read_seam(file.data(), file.size(), nullptr, work.data(), work.size(), &seam, sides.data(),
                  static_cast<std::uint32_t>(sides.size()));
    sides.resize(seam.sides);
    return {info.lowest, seam.start, sides};
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
            format::readContents({file->data(), file->size()}, false, &contents) == format::ReadStatus::Ok &&
            codec::readImageHeader(contents.geometry.content, codec::ImageKind::Geometry, &header) ==
                format::ReadStatus::Ok;
        if (!sound) return std::nullopt;
        codec::Seam seam = seamOf(*file, images->info);
        std::vector<std::uint32_t> classes = codec::borderClasses(seam, images->info.grid);
        return Stages{*file, std::move(*images), header, std::move(seam), std::move(classes)};
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

// What the decoder does at each level for all components: the transform of the coarser surface, and that of
// the details.
void inverseTransform(benchmark::State& state)
{
    const Stages* s = stages();
    if (!have(state, s)) return;
    std::vector<std::uint32_t> mates(s->classes.size());
    const codec::GluedBorder border(s->view(), s->grid(), s->classes.data(), mates.data());
    std::vector<double> samples(s->samples(), 1.0), work(2 * s->classes.size());
    for (auto _ : state)
        for (std::uint32_t m = codec::kCoarsest; m < s->grid(); m = 2 * m - 1)
            for (unsigned c = 0; c < 2 * codec::kComponents; ++c) {
                codec::inverseLifting(samples.data(), 2 * m - 1, border.isGluedAt(m) ? &border : nullptr,
                                      work.data());
                benchmark::DoNotOptimize(samples.data());
                benchmark::ClobberMemory();
            }
}
BENCHMARK(inverseTransform)->Unit(benchmark::kMillisecond);

// The frames of all details of the finest level.
void frames(benchmark::State& state)
{
    const Stages* s = stages();
    if (!have(state, s)) return;
    std::vector<std::uint32_t> mates(s->classes.size());
    const codec::GluedBorder border(s->view(), s->grid(), s->classes.data(), mates.data());
    std::vector<double> components[codec::kComponents];
    const double* planes[codec::kComponents];
    for (unsigned c = 0; c < codec::kComponents; ++c) {
        for (size_t k = 0; k < s->samples(); ++k)
            components[c].push_back(static_cast<double>(s->images.geometry.samples[3 * k + c]));
        planes[c] = components[c].data();
    }
    const std::uint32_t n = s->grid();
    for (auto _ : state) {
        codec::SurfaceLevel level;
        level.size = n;
        level.meanArea = codec::meanCellArea(planes, n);
        level.border = &border;
        for (std::uint32_t j = 0; j < n; ++j)
            for (std::uint32_t i = 0; i < n; ++i)
                if (i % 2 == 1 || j % 2 == 1)
                    benchmark::DoNotOptimize(codec::frameAt(planes, level, {}, i, j));
    }
}
BENCHMARK(frames)->Unit(benchmark::kMillisecond);

void forwardTransform(benchmark::State& state)
{
    const Stages* s = stages();
    if (!have(state, s)) return;
    const codec::SurfaceEncoder encoder(s->seam, s->grid());
    for (auto _ : state) benchmark::DoNotOptimize(encoder.transform(s->images.geometry.samples));
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

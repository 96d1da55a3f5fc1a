// The stages of encoding the bunny, and measuring.
#include "bunny.h"

#include "gimg/border.h"
#include "gimg/cut.h"
#include "gimg/decode.h"
#include "gimg/distance.h"
#include "gimg/flatten.h"
#include "gimg/intrinsic.h"
#include "gimg/linear_maps.h"
#include "gimg/sample.h"

namespace {

using namespace gimg;
using namespace gimg::bench;

void cut(benchmark::State& state)
{
    const Mesh* mesh = bunny();
    if (!have(state, mesh)) return;
    for (auto _ : state) benchmark::DoNotOptimize(cutToDisk(*mesh));
}
BENCHMARK(cut)->Unit(benchmark::kMillisecond);

// The border of the square: lengths of cut-paths, corners, split edges.
void layOut(benchmark::State& state)
{
    const Mesh* mesh = bunny();
    if (!have(state, mesh)) return;
    const CutGraph graph = cutToDisk(*mesh);
    for (auto _ : state) benchmark::DoNotOptimize(layOutBorder(*mesh, graph, {257, 0}));
}
BENCHMARK(layOut)->Unit(benchmark::kMillisecond);

// The intrinsic Delaunay triangulation of the surface.
void delaunay(benchmark::State& state)
{
    const Mesh* mesh = bunny();
    if (!have(state, mesh)) return;
    for (auto _ : state) {
        Result<IntrinsicTriangulation> triangulation = IntrinsicTriangulation::of(*mesh);
        benchmark::DoNotOptimize(triangulation->makeDelaunay());
    }
}
BENCHMARK(delaunay)->Unit(benchmark::kMillisecond);

// Linear maps; the argument is a MapKind.
void linear(benchmark::State& state)
{
    const Mesh* mesh = bunny();
    if (!have(state, mesh)) return;
    const Result<SquareDisk> square = layOutBorder(*mesh, cutToDisk(*mesh), {257, 0});
    const MapKind kind = static_cast<MapKind>(state.range(0));
    state.SetLabel(mapName(kind));
    for (auto _ : state) benchmark::DoNotOptimize(linearMap(*square, kind));
}
BENCHMARK(linear)->DenseRange(1, 3)->Unit(benchmark::kMillisecond);

// The parameterization.
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

// Distance of the decoded surface from the mesh, both ways, 400,000 samples in all.
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

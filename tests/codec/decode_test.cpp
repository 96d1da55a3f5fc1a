#include "codec/border.h"
#include "sample_images.h"

#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <limits>
#include <set>

namespace gimg::codec {
namespace {

using namespace samples;

Source torusSource(const std::vector<float>& xyz, std::uint32_t grid, std::uint32_t lowest = 17)
{
    Source source;
    source.grid = grid;
    source.seam = torusSeam(lowest);
    source.xyz = xyz;
    return source;
}

float* at(std::vector<float>& xyz, std::uint32_t grid, std::uint32_t i, std::uint32_t j)
{
    return &xyz[3 * (std::size_t{j} * grid + i)];
}

TEST(Wavelet, ErrorFollowsTheStep)
{
    const std::vector<float> xyz = bumpyImage(65, 1);
    Source source = torusSource(xyz, 65);
    source.seam = diskSeam(17);
    for (const float step : {0.1f, 0.01f, 0.001f}) {
        // A uniform quantiser errs by step / sqrt(12) a component; cost-aware rounding by more where
        // coefficients are sparse, and zeroed coefficients by less.
        const double rms = rmsDistance(decoded(encoded(source, {GIM_CODING_WAVELET, step, 0})), xyz);
        EXPECT_LT(rms, 1.15 * step * std::sqrt(3.0 / 12)) << step;
        EXPECT_GT(rms, 0.02 * step) << step;
    }
}

TEST(Wavelet, EveryGridSize)
{
    for (std::uint32_t grid = 3; grid <= 513; grid = 2 * grid - 1) {
        const std::vector<float> xyz = bumpyImage(grid, grid);
        Source source = torusSource(xyz, grid, 3);
        source.seam = diskSeam(3);
        EXPECT_LT(rmsDistance(decoded(encoded(source, {GIM_CODING_WAVELET, 0.01f, 0})), xyz), 0.006) << grid;
    }
}

TEST(Wavelet, LargeOffsetsCostFewBytesAndNoPrecision)
{
    const std::vector<float> near = torusImage(65), far = torusImage(65, 5.0e6);
    const Source nearSource = torusSource(near, 65), farSource = torusSource(far, 65);
    // Float32 has a spacing of 0.5 there, and the image is rounded to it already.
    const auto nearFile = encoded(nearSource, {GIM_CODING_WAVELET, 0.5f, 0});
    const auto farFile = encoded(farSource, {GIM_CODING_WAVELET, 0.5f, 0});
    EXPECT_LT(rmsDistance(decoded(farFile), far), 0.5);
    std::vector<float> flat(near.size(), 1.0f), flatFar(near.size(), 5.0e6f);
    const auto flatFile = encoded(torusSource(flat, 65), {GIM_CODING_WAVELET, 0.5f, 0});
    const auto flatFarFile = encoded(torusSource(flatFar, 65), {GIM_CODING_WAVELET, 0.5f, 0});
    EXPECT_LE(flatFarFile.size(), flatFile.size() + 12);
    EXPECT_EQ(decoded(flatFarFile), flatFar);
}

TEST(Wavelet, EncodingIsRepeatable)
{
    const std::vector<float> xyz = torusImage(65);
    const Source source = torusSource(xyz, 65);
    EXPECT_EQ(encoded(source, {GIM_CODING_WAVELET, 0.02f, 0}),
              encoded(source, {GIM_CODING_WAVELET, 0.02f, 0}));
}

TEST(Overhead, IsBelow48BytesInEveryCoding)
{
    const std::vector<float> xyz = torusImage(129);
    const Source source = torusSource(xyz, 129);
    const std::uint64_t expected[3] = {30, 41, 26};
    for (int coding = 0; coding < 3; ++coding) {
        const gim_info info = probed(encoded(source, {static_cast<gim_coding>(coding), 0.001f, 0}));
        EXPECT_LE(info.container_bytes, 48u);
        EXPECT_EQ(info.container_bytes, expected[coding]) << coding;
        EXPECT_EQ(info.other_bytes, 0u);
        EXPECT_LE(info.seam_bytes, 5u);
    }
}

TEST(Info, SaysWhatTheFileHolds)
{
    const std::vector<float> xyz = torusImage(65), normals = torusNormals(129);
    Source source = torusSource(xyz, 65);
    source.normalGrid = 129;
    source.normals = normals;
    const auto bytes = encoded(source, {GIM_CODING_WAVELET, 0.01f, 0.02f});
    const gim_info info = probed(bytes);
    EXPECT_EQ(info.grid, 65u);
    EXPECT_EQ(info.lowest, 17u);
    EXPECT_EQ(info.levels, 3u);
    EXPECT_EQ(info.step, 0.01f);
    EXPECT_EQ(info.normal_grid, 129u);
    EXPECT_EQ(info.normal_step, 0.02f);
    EXPECT_EQ(info.chunks, 3u);
    EXPECT_EQ(info.container_bytes + info.seam_bytes + info.geometry_bytes + info.normal_bytes, bytes.size());

    std::uint64_t total = 10;
    std::string types;
    for (std::uint32_t k = 0; k < info.chunks; ++k) {
        gim_chunk chunk{};
        chunk.size = sizeof chunk;
        ASSERT_EQ(gim_read_chunk(bytes.data(), bytes.size(), k, &chunk), GIM_OK);
        types += chunk.type;
        total += chunk.total;
    }
    EXPECT_EQ(types, "SGn");
    EXPECT_EQ(total, bytes.size());

    std::vector<unsigned char> work(gim_workspace_size(&info));
    gim_seam seam{};
    seam.size = sizeof seam;
    gim_side sides[4];
    ASSERT_EQ(gim_read_seam(bytes.data(), bytes.size(), nullptr, work.data(), work.size(), &seam, sides, 4),
              GIM_OK);
    EXPECT_EQ(seam.sides, 4u);
    EXPECT_EQ(seam.genus, 1u);
    EXPECT_EQ(seam.boundary_loops, 0u);
    EXPECT_EQ(seam.cut_nodes, 1u);
    EXPECT_EQ(sides[3].path, 1u);
    EXPECT_EQ(sides[3].kind, static_cast<std::uint32_t>(GIM_SIDE_MATE));
    EXPECT_EQ(gim_read_seam(bytes.data(), bytes.size(), nullptr, work.data(), work.size(), &seam, sides, 3),
              GIM_MISUSE);
}

TEST(Fuse, MakesMatesEqualToTheBitAndLeavesBoundariesAlone)
{
    const std::uint32_t grid = 65;
    const std::vector<float> xyz = bumpyImage(grid, 3); // its mates differ widely
    Source source = torusSource(xyz, grid);
    source.seam = {17, 5, {{0, 12, 1}, {1, 10, 0}, {2, 8, 1}, {0, 12, 2}, {2, 8, 2}, {3, 14, 0}}};
    ASSERT_EQ(seamFault(source.seam), "");
    const auto bytes = encoded(source, {GIM_CODING_WAVELET, 0.01f, 0});
    const std::vector<std::uint32_t> classes = borderClasses(source.seam, grid);
    std::vector<float> fused = decoded(bytes), open = decoded(bytes, GIM_NO_FUSE),
                       undiffused = decoded(bytes, GIM_NO_DIFFUSE);
    std::vector<int> members(classes.size());
    for (const std::uint32_t c : classes) ++members[c];
    int glued = 0;
    for (std::uint32_t k = 0; k < borderSize(grid); ++k) {
        const std::size_t here = 3 * std::size_t{borderSample(grid, k)},
                          first = 3 * std::size_t{borderSample(grid, classes[k])};
        EXPECT_EQ(std::memcmp(&fused[here], &fused[first], 12), 0) << k;
        EXPECT_EQ(std::memcmp(&fused[here], &undiffused[here], 12), 0) << k;
        if (members[classes[k]] == 1) {
            EXPECT_EQ(std::memcmp(&fused[here], &open[here], 12), 0) << k;
        }
        if (std::memcmp(&open[here], &open[first], 12) != 0) ++glued;
    }
    EXPECT_GT(glued, 50);
    // Without diffusion the inside is what was coded.
    for (std::uint32_t j = 1; j + 1 < grid; ++j)
        for (std::uint32_t i = 1; i + 1 < grid; ++i)
            ASSERT_EQ(std::memcmp(at(undiffused, grid, i, j), at(open, grid, i, j), 12), 0);
}

TEST(Diffuse, FollowsItsFormula)
{
    const std::uint32_t grid = 33;
    const std::vector<float> xyz = bumpyImage(grid, 8);
    const auto bytes = encoded(torusSource(xyz, grid), {GIM_CODING_WAVELET, 0.01f, 0});
    std::vector<float> fused = decoded(bytes), open = decoded(bytes, GIM_NO_FUSE);
    const std::uint32_t last = grid - 1, size = borderSize(grid);
    std::vector<double> d(size);
    for (std::uint32_t k = 0; k < size; ++k) {
        const std::size_t s = 3 * std::size_t{borderSample(grid, k)};
        d[k] = double{fused[s]} - open[s];
    }
    for (std::uint32_t r = 1; r < 16; ++r) {
        std::vector<double> next(size);
        for (std::uint32_t k = 0; k < size; ++k)
            next[k] = (d[(k + size - 1) % size] + 2 * d[k] + d[(k + 1) % size]) / 4;
        d = next;
        const double w = std::pow(1 - r / 16.0, 2);
        const auto moved = [&](std::uint32_t i, std::uint32_t j) {
            return double{*at(fused, grid, i, j)} - *at(open, grid, i, j);
        };
        EXPECT_NEAR(moved(16, r), w * d[16], 1e-6) << r;                       // over the bottom side
        EXPECT_NEAR(moved(last - r, 17 < r ? r : 16), w * d[last + 16], 1e-6); // right
        EXPECT_NEAR(moved(16, last - r), w * d[2 * last + (last - 16)], 1e-6); // top
        EXPECT_NEAR(moved(r, 16), w * d[3 * last + (last - 16)], 1e-6);        // left
        EXPECT_NEAR(moved(r, r), w * (d[r] + d[4 * last - r]) / 2, 1e-6);      // two feet
        EXPECT_NEAR(moved(last - r, r), w * (d[last - r] + d[last + r]) / 2, 1e-6);
    }
    EXPECT_EQ(*at(fused, grid, 16, 16), *at(open, grid, 16, 16));
}

TEST(Diffuse, ReducesTheStepNextToTheSeam)
{
    const std::uint32_t grid = 129;
    const std::vector<float> xyz = bumpyImage(grid, 5);
    const auto bytes = encoded(torusSource(xyz, grid), {GIM_CODING_WAVELET, 0.005f, 0});
    std::vector<float> smooth = decoded(bytes), plain = decoded(bytes, GIM_NO_DIFFUSE),
                       open = decoded(bytes, GIM_NO_FUSE);
    const auto step = [&](std::vector<float>& image) {
        double sum = 0;
        for (std::uint32_t i = 20; i + 20 < grid; ++i)
            for (int c = 0; c < 3; ++c) {
                const double added = (double{at(image, grid, i, 0)[c]} - at(image, grid, i, 1)[c]) -
                                     (double{at(open, grid, i, 0)[c]} - at(open, grid, i, 1)[c]);
                sum += added * added;
            }
        return std::sqrt(sum);
    };
    EXPECT_LT(step(smooth), 0.2 * step(plain));
}

TEST(TwelveBit, ErrsByHalfAStepAtMost)
{
    const std::vector<float> xyz = torusImage(65);
    const auto bytes = encoded(torusSource(xyz, 65), {GIM_CODING_RAW12, 0, 0});
    const double step = probed(bytes).step;
    EXPECT_NEAR(step, 8.0 / 4095, 1e-6); // the torus is 8 across
    const std::vector<float> out = decoded(bytes);
    for (std::size_t k = 0; k < xyz.size(); ++k) ASSERT_NEAR(out[k], xyz[k], step / 2 + 1e-6);
    // 12 bits a coordinate would be 19,013 bytes.
    EXPECT_LT(bytes.size(), 4200u);
}

TEST(TwelveBit, GluedSamplesAreOneAndAlwaysFused)
{
    const std::vector<float> bumpy = bumpyImage(33, 1); // its mates differ widely
    const Source source = torusSource(bumpy, 33);
    const auto bytes = encoded(source, {GIM_CODING_RAW12, 0, 0});
    const std::vector<float> out = decoded(bytes);
    EXPECT_EQ(decoded(bytes, GIM_NO_FUSE), out);
    const std::vector<std::uint32_t> classes = borderClasses(source.seam, 33);
    const double step = probed(bytes).step;
    for (std::uint32_t k = 0; k < borderSize(33); ++k) {
        const std::size_t here = 3 * std::size_t{borderSample(33, k)},
                          first = 3 * std::size_t{borderSample(33, classes[k])};
        EXPECT_EQ(std::memcmp(&out[here], &out[first], 12), 0);
        EXPECT_NEAR(out[here], bumpy[first], step / 2 + 1e-6);
    }
}

TEST(Float, IsExactToTheBit)
{
    std::vector<float> xyz = torusImage(65, 1000);
    xyz[3 * 100] = -0.0f;
    xyz[3 * 101] = std::numeric_limits<float>::denorm_min();
    xyz[3 * 102] = std::numeric_limits<float>::max();
    xyz[3 * 103] = std::numeric_limits<float>::lowest();
    const auto bytes = encoded(torusSource(xyz, 65), {GIM_CODING_FLOAT, 0, 0});
    for (const std::uint32_t flags : {0u, GIM_NO_FUSE, GIM_NO_DIFFUSE})
        EXPECT_EQ(std::memcmp(decoded(bytes, flags).data(), xyz.data(), 4 * xyz.size()), 0);
    // Mates that do not agree take the first's value.
    const std::vector<float> bumpy = bumpyImage(33, 1);
    const auto open = encoded(torusSource(bumpy, 33), {GIM_CODING_FLOAT, 0, 0});
    const std::vector<float> closed = decoded(open);
    EXPECT_EQ(decoded(open, GIM_NO_FUSE), closed);
    EXPECT_EQ(closed[3 * (33 * 32 + 5)], bumpy[3 * 5]);
    EXPECT_EQ(closed[3 * (33 * 5 + 5)], bumpy[3 * (33 * 5 + 5)]);
}

TEST(Float, SmoothImagesShrink)
{
    const std::vector<float> xyz = torusImage(129);
    EXPECT_LT(encoded(torusSource(xyz, 129), {GIM_CODING_FLOAT, 0, 0}).size(), 4 * xyz.size() * 2 / 5);
}

TEST(Normals, AreUnitFusedAndNear)
{
    const std::vector<float> xyz = torusImage(65), normals = torusNormals(129);
    Source source = torusSource(xyz, 65);
    source.normalGrid = 129;
    source.normals = normals;
    for (const gim_coding coding : {GIM_CODING_WAVELET, GIM_CODING_RAW12, GIM_CODING_FLOAT}) {
        const std::vector<float> out = decoded(encoded(source, {coding, 0.01f, 0.02f}), 0, true);
        const double worst = coding == GIM_CODING_WAVELET ? 0.02 : coding == GIM_CODING_RAW12 ? 0.0005 : 0;
        EXPECT_LE(rmsDistance(out, normals), worst);
        for (std::size_t k = 0; k < out.size(); k += 3)
            ASSERT_NEAR(out[k] * out[k] + out[k + 1] * out[k + 1] + out[k + 2] * out[k + 2], 1, 1e-6);
        for (std::uint32_t k = 0; k < 129; ++k)
            ASSERT_EQ(std::memcmp(&out[3 * k], &out[3 * (128 * 129 + k)], 12), 0);
    }
}

TEST(Mesh, OfEveryLevelIsATorus)
{
    const std::uint32_t grid = 65;
    const std::vector<float> xyz = torusImage(grid);
    const auto bytes = encoded(torusSource(xyz, grid), {GIM_CODING_WAVELET, 0.01f, 0});
    const gim_info info = probed(bytes);
    std::vector<unsigned char> work(info.workspace);
    const std::vector<float> out = decoded(bytes);
    for (std::uint32_t level = 0; level < info.levels; ++level) {
        gim_mesh_counts counts{sizeof counts, 0, 0, 0};
        ASSERT_EQ(
            gim_mesh_size(bytes.data(), bytes.size(), nullptr, 0, level, work.data(), work.size(), &counts),
            GIM_OK);
        const std::uint32_t cells = 64u >> level;
        EXPECT_EQ(counts.grid, cells + 1);
        EXPECT_EQ(counts.vertices, cells * cells);
        EXPECT_EQ(counts.triangles, 2 * cells * cells);
        std::vector<std::uint32_t> ofSample(counts.grid * counts.grid), ofVertex(counts.vertices),
            triangles(3 * counts.triangles);
        ASSERT_EQ(gim_build_mesh(bytes.data(), bytes.size(), nullptr, 0, level, work.data(), work.size(),
                                 out.data(), ofSample.data(), ofVertex.data(), triangles.data()),
                  GIM_OK);
        // Each directed edge once, and its reverse too: closed and oriented.
        std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
        for (std::size_t k = 0; k < triangles.size(); ++k) {
            ASSERT_LT(triangles[k], counts.vertices);
            EXPECT_TRUE(edges.insert({triangles[k], triangles[k % 3 == 2 ? k - 2 : k + 1]}).second);
        }
        for (const auto& [a, b] : edges) EXPECT_TRUE(edges.count({b, a}));
        EXPECT_EQ(edges.size(), 2 * 3 * cells * cells);
        for (std::uint32_t v = 0, next = 0; v < ofSample.size(); ++v) {
            ASSERT_LE(ofSample[v], next); // numbered by first appearance
            if (ofSample[v] == next) {
                EXPECT_EQ(ofVertex[next], (v / counts.grid << level) * grid + (v % counts.grid << level));
                ++next;
            }
        }
    }
}

TEST(Mesh, UnfusedKeepsEverySample)
{
    const std::vector<float> xyz = torusImage(33);
    const auto bytes = encoded(torusSource(xyz, 33), {GIM_CODING_WAVELET, 0.01f, 0});
    const gim_info info = probed(bytes);
    std::vector<unsigned char> work(info.workspace);
    gim_mesh_counts counts{sizeof counts, 0, 0, 0};
    ASSERT_EQ(
        gim_mesh_size(bytes.data(), bytes.size(), nullptr, GIM_NO_FUSE, 0, work.data(), work.size(), &counts),
        GIM_OK);
    EXPECT_EQ(counts.vertices, 33u * 33u);
    EXPECT_EQ(
        gim_mesh_size(bytes.data(), bytes.size(), nullptr, 0, info.levels, work.data(), work.size(), &counts),
        GIM_MISUSE);
}

TEST(Mesh, InteriorCellsUseTheShorterDiagonal)
{
    // A flat square sheared so that falling diagonals are shorter everywhere, but for one cell.
    const std::uint32_t grid = 9;
    std::vector<float> xyz;
    for (std::uint32_t j = 0; j < grid; ++j)
        for (std::uint32_t i = 0; i < grid; ++i)
            for (const double value : {i + 0.5 * j, 1.0 * j, 0.0}) xyz.push_back(static_cast<float>(value));
    Source source = torusSource(xyz, grid, 3);
    source.seam = diskSeam(3);
    const auto bytes = encoded(source, {GIM_CODING_FLOAT, 0, 0});
    std::vector<unsigned char> work(probed(bytes).workspace);
    std::vector<std::uint32_t> triangles(3 * 2 * 64), vertexOf(81);
    ASSERT_EQ(gim_build_mesh(bytes.data(), bytes.size(), nullptr, 0, 0, work.data(), work.size(), xyz.data(),
                             vertexOf.data(), nullptr, triangles.data()),
              GIM_OK);
    const auto rising = [&](std::uint32_t i, std::uint32_t j) {
        return triangles[6 * (j * 8 + i) + 2] == vertexOf[(j + 1) * grid + i + 1];
    };
    for (std::uint32_t j = 0; j < 8; ++j)
        for (std::uint32_t i = 0; i < 8; ++i) {
            const bool horizontalSide = j == 0 || j == 7, corner = horizontalSide && (i == 0 || i == 7);
            const bool expected = corner ? (i == 0) == (j == 0) : horizontalSide;
            EXPECT_EQ(rising(i, j), expected) << i << ' ' << j;
        }
}

TEST(Mesh, NormalsAreThoseOfTheTorusAtEveryLevelAndAcrossTheSeam)
{
    // Coordinates whose squares no float holds; errors fall with the square of the spacing.
    const std::uint32_t grid = 129;
    const std::vector<float> exact = torusNormals(grid);
    for (const float scale : {1.0f, 1e25f, 1e-25f}) {
        std::vector<float> xyz = torusImage(grid);
        for (float& value : xyz) value *= scale;
        const auto bytes = encoded(torusSource(xyz, grid), {GIM_CODING_FLOAT, 0, 0});
        const gim_info info = probed(bytes);
        std::vector<unsigned char> work(info.workspace);
        double before = 0;
        for (std::uint32_t level = 0; level < 3; ++level) {
            std::vector<float> normals(xyz.size(), 7);
            ASSERT_EQ(gim_estimate_normals(bytes.data(), bytes.size(), nullptr, 0, level, work.data(),
                                           work.size(), xyz.data(), normals.data()),
                      GIM_OK);
            double worst = 0;
            for (std::uint32_t j = 0; j < grid; ++j)
                for (std::uint32_t i = 0; i < grid; ++i) {
                    const float *n = &normals[3 * (j * std::size_t{grid} + i)],
                                *e = &exact[3 * (j * std::size_t{grid} + i)];
                    if (i % (1u << level) != 0 || j % (1u << level) != 0) {
                        ASSERT_EQ(n[0], 7) << "left alone";
                        continue;
                    }
                    const double x = n[1] * double{e[2]} - n[2] * double{e[1]},
                                 y = n[2] * double{e[0]} - n[0] * double{e[2]},
                                 z = n[0] * double{e[1]} - n[1] * double{e[0]};
                    worst = std::max(worst, std::sqrt(x * x + y * y + z * z));
                    EXPECT_GT(n[0] * e[0] + n[1] * e[1] + n[2] * e[2], 0.9);
                }
            if (level == 0)
                EXPECT_LT(worst, 1e-3);
            else
                EXPECT_NEAR(worst / before, 4, 0.4);
            before = worst;
        }
    }
}

TEST(RateControl, NeverExceedsAndComesClose)
{
    const std::vector<float> xyz = bumpyImage(129, 2);
    Source source = torusSource(xyz, 129);
    auto prepared = Encoder::prepare(source);
    const Encoder& encoder = std::get<Encoder>(prepared);
    double before = 1e9;
    for (const std::size_t target : {200u, 400u, 1000u, 1536u, 3000u, 6001u, 12000u, 24000u}) {
        auto outcome = encoder.encodeToBytes(target);
        ASSERT_TRUE(std::holds_alternative<EncodedFile>(outcome)) << target;
        const EncodedFile& file = std::get<EncodedFile>(outcome);
        EXPECT_LE(file.bytes.size(), target);
        EXPECT_GE(file.bytes.size() + std::max<std::size_t>(24, target / 100), target) << target;
        EXPECT_EQ(file.bytes,
                  std::get<EncodedFile>(encoder.encode({GIM_CODING_SURFACE, file.step, 0})).bytes);
        const double rms = rmsDistance(decoded(file.bytes, GIM_NO_FUSE), xyz);
        EXPECT_LT(rms, before);
        before = rms;
    }
}

TEST(RateControl, SaysWhatCanBeReached)
{
    const std::vector<float> xyz = torusImage(33);
    auto prepared = Encoder::prepare(torusSource(xyz, 33));
    const Encoder& encoder = std::get<Encoder>(prepared);
    auto small = encoder.encodeToBytes(20);
    ASSERT_TRUE(std::holds_alternative<EncodeError>(small));
    const EncodeError& tooSmall = std::get<EncodeError>(small);
    EXPECT_EQ(tooSmall.kind, EncodeError::Kind::TooSmall);
    EXPECT_TRUE(std::holds_alternative<EncodedFile>(encoder.encodeToBytes(tooSmall.reachable)));
    EXPECT_FALSE(std::holds_alternative<EncodedFile>(encoder.encodeToBytes(tooSmall.reachable - 1)));
    auto large = encoder.encodeToBytes(1000000);
    ASSERT_TRUE(std::holds_alternative<EncodeError>(large));
    EXPECT_EQ(std::get<EncodeError>(large).kind, EncodeError::Kind::TooLarge);
    EXPECT_LT(std::get<EncodeError>(large).reachable, 12u * 33 * 33);
    EXPECT_GT(std::get<EncodeError>(large).reachable, 1000u);
}

TEST(RateControl, NormalsGetAQuarter)
{
    const std::vector<float> xyz = bumpyImage(129, 2), normals = torusNormals(129);
    Source source = torusSource(xyz, 129);
    source.normalGrid = 129;
    source.normals = normals;
    auto prepared = Encoder::prepare(source);
    auto outcome = std::get<Encoder>(prepared).encodeToBytes(4000);
    ASSERT_TRUE(std::holds_alternative<EncodedFile>(outcome));
    const auto& file = std::get<EncodedFile>(outcome);
    EXPECT_LE(file.bytes.size(), 4000u);
    EXPECT_GE(file.bytes.size(), 3960u);
    const gim_info info = probed(file.bytes);
    EXPECT_NEAR(static_cast<double>(info.normal_bytes), 990, 24);
}

TEST(Encoder, RefusesBadSources)
{
    std::vector<float> xyz = torusImage(33);
    const auto messageOf = [](const Source& source) {
        auto outcome = Encoder::prepare(source);
        return std::holds_alternative<EncodeError>(outcome) ? std::get<EncodeError>(outcome).message
                                                            : std::string();
    };
    Source source = torusSource(xyz, 33);
    EXPECT_EQ(messageOf(source), "");
    source.grid = 34;
    EXPECT_NE(messageOf(source), "");
    source.grid = 65;
    EXPECT_EQ(messageOf(source), "geometry: the number of samples does not fit the grid");
    source.grid = 33;
    source.seam.sides.pop_back();
    EXPECT_EQ(messageOf(source), "seam: the sides are 48 long, the border 64");
    xyz[3 * 40 + 1] = std::nanf("");
    EXPECT_EQ(messageOf(torusSource(xyz, 33)), "geometry: sample 40 is not finite");
    auto prepared = Encoder::prepare(torusSource(torusImage(33), 33));
    EXPECT_TRUE(
        std::holds_alternative<EncodeError>(std::get<Encoder>(prepared).encode({GIM_CODING_WAVELET, 0, 0})));
    EXPECT_TRUE(std::holds_alternative<EncodeError>(
        std::get<Encoder>(prepared).encode({GIM_CODING_WAVELET, 1e-20f, 0})));
}

class Misuse : public testing::Test
{
protected:
    Misuse()
        : xyz(torusImage(33)), bytes(encoded(torusSource(xyz, 33), {GIM_CODING_WAVELET, 0.01f, 0})),
          info(probed(bytes)), work(info.workspace), out(xyz.size())
    {
    }
    gim_status decode(std::uint32_t flags, std::size_t workspace, float* to,
                      const gim_limits* limits = nullptr)
    {
        return gim_decode_geometry(bytes.data(), bytes.size(), limits, flags, work.data(), workspace, to);
    }
    std::vector<float> xyz;
    std::vector<std::uint8_t> bytes;
    gim_info info;
    std::vector<unsigned char> work;
    std::vector<float> out;
};

TEST_F(Misuse, IsToldFromDamage)
{
    EXPECT_EQ(decode(0, work.size(), out.data()), GIM_OK);
    EXPECT_EQ(decode(8, work.size(), out.data()), GIM_MISUSE);
    EXPECT_EQ(decode(0, work.size() - 1, out.data()), GIM_MISUSE);
    EXPECT_EQ(decode(0, work.size(), nullptr), GIM_MISUSE);
    EXPECT_EQ(
        gim_decode_normals(bytes.data(), bytes.size(), nullptr, 0, work.data(), work.size(), out.data()),
        GIM_MISUSE);
    gim_info unset{};
    EXPECT_EQ(gim_probe(bytes.data(), bytes.size(), nullptr, &unset), GIM_MISUSE);
    EXPECT_EQ(gim_probe(nullptr, 1, nullptr, &info), GIM_MISUSE);
    gim_chunk chunk{};
    chunk.size = sizeof chunk;
    EXPECT_EQ(gim_read_chunk(bytes.data(), bytes.size(), 2, &chunk), GIM_MISUSE);
    EXPECT_EQ(gim_workspace_size(nullptr), 0u);
    EXPECT_STREQ(gim_status_text(GIM_OK), "no error");
}

TEST_F(Misuse, LimitsAreKept)
{
    gim_limits limits{sizeof(gim_limits), 0, 0, 0};
    EXPECT_EQ(decode(0, work.size(), out.data(), &limits), GIM_OK); // zeros stand for the defaults
    limits.max_grid = 32;
    EXPECT_EQ(decode(0, work.size(), out.data(), &limits), GIM_LIMIT);
    limits = {sizeof(gim_limits), 0, 3, 0};
    EXPECT_EQ(decode(0, work.size(), out.data(), &limits), GIM_LIMIT);
    limits = {sizeof(gim_limits), 0, 4, 0};
    EXPECT_EQ(decode(0, work.size(), out.data(), &limits), GIM_OK);
    limits = {sizeof(gim_limits), 0, 0, info.workspace - 1};
    EXPECT_EQ(decode(0, work.size(), out.data(), &limits), GIM_LIMIT);
    limits = {1, 0, 0, 0};
    EXPECT_EQ(decode(0, work.size(), out.data(), &limits), GIM_MISUSE);
}

TEST_F(Misuse, UnalignedWorkspaceIsFine)
{
    std::vector<unsigned char> odd(info.workspace + 1);
    EXPECT_EQ(gim_decode_geometry(bytes.data(), bytes.size(), nullptr, 0, odd.data() + 1, info.workspace,
                                  out.data()),
              GIM_OK);
    EXPECT_EQ(out, decoded(bytes));
}

TEST_F(Misuse, EveryTruncationIsAnError)
{
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        EXPECT_EQ(gim_decode_geometry(bytes.data(), size, nullptr, 0, work.data(), work.size(), out.data()),
                  GIM_MORE_INPUT)
            << size;
    }
}

} // namespace
} // namespace gimg::codec

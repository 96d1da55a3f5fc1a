#include "codec/surface_encoder.h"
#include "sample_images.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace gimg::codec {
namespace {

// A sphere unfolded as an octahedron: each side of the square folds onto itself.
constexpr std::uint32_t kFoldedGrid = 33;

Seam foldedSeam()
{
    Seam seam{17, 0, {}};
    for (std::uint32_t side = 0; side < 4; ++side) {
        seam.sides.push_back({side, 8, GIM_SIDE_FIRST});
        seam.sides.push_back({side, 8, GIM_SIDE_MATE});
    }
    return seam;
}

std::vector<float> foldedSphere()
{
    std::vector<float> xyz;
    for (std::uint32_t j = 0; j < kFoldedGrid; ++j)
        for (std::uint32_t i = 0; i < kFoldedGrid; ++i) {
            double x = 2.0 * i / (kFoldedGrid - 1) - 1, y = 2.0 * j / (kFoldedGrid - 1) - 1;
            const double z = 1 - std::abs(x) - std::abs(y);
            if (z < 0) {
                const double u = x;
                x = (1 - std::abs(y)) * (x < 0 ? -1 : 1);
                y = (1 - std::abs(u)) * (y < 0 ? -1 : 1);
            }
            const double r = std::sqrt(x * x + y * y + z * z);
            for (const double value : {x / r, y / r, z / r}) xyz.push_back(static_cast<float>(value));
        }
    return xyz;
}

double largestDetail(const TransformedSurface& surface, bool onBorder)
{
    const TransformedSurface::Level& level = surface.levels.back();
    const std::uint32_t n = surface.grid;
    double largest = 0;
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t depth = std::min({i, j, n - 1 - i, n - 1 - j});
            if ((depth < 2) != onBorder) continue;
            const std::size_t k = j * std::size_t{n} + i;
            for (unsigned c = 0; c < kComponents; ++c)
                largest = std::max(largest, std::abs(level.detail[c][k]));
        }
    return largest;
}

TEST(SurfaceTransform, ASeamLeavesNoTrace)
{
    const std::vector<float> xyz = samples::torusImage(65);
    const TransformedSurface glued = SurfaceEncoder(samples::torusSeam(65), 65).transform(xyz);
    const TransformedSurface cut = SurfaceEncoder(samples::diskSeam(65), 65).transform(xyz);
    EXPECT_LT(largestDetail(glued, true), 1.05 * largestDetail(glued, false));
    EXPECT_GT(largestDetail(cut, true), 10 * largestDetail(cut, false));
}

TEST(SurfaceCoding, IsGluedFromTheCoarsestGridThatHoldsTheSeam)
{
    // Sides of half the square's are glued in the 3 x 3 grid already, and an odd length nowhere below its
    // own.
    const auto coarsest = [](const Seam& seam, std::uint32_t grid) {
        const std::vector<std::uint32_t> classes = borderClasses(seam, grid);
        std::vector<std::uint32_t> mates(classes.size());
        return GluedBorder({seam.sides.data(), static_cast<std::uint32_t>(seam.sides.size()), seam.start,
                            seam.lowest},
                           grid, classes.data(), mates.data())
            .coarsest();
    };
    EXPECT_EQ(coarsest(foldedSeam(), kFoldedGrid), 3u);
    EXPECT_EQ(coarsest(samples::torusSeam(9), 33), 3u);
    EXPECT_EQ(coarsest(samples::closedSeam(3, 33), 65), 17u); // lengths of 14 and 10
    EXPECT_EQ(coarsest(samples::closedSeam(3, 33, 1), 65), 33u);
    Seam turned = samples::torusSeam(33);
    turned.start = 4;
    EXPECT_EQ(coarsest(turned, 65), 9u);
}

TEST(SurfaceCoding, FineStepsGiveTheSamplesBack)
{
    struct Case
    {
        Source source;
        std::vector<float> xyz;
    };
    Case cases[3] = {{{}, foldedSphere()}, {{}, samples::torusImage(33)}, {{}, samples::torusImage(33)}};
    const Seam seams[3] = {foldedSeam(), samples::torusSeam(9), samples::diskSeam(17)};
    for (int k = 0; k < 3; ++k) {
        Source& source = cases[k].source;
        source.grid = 33;
        source.seam = seams[k];
        source.xyz = cases[k].xyz;
        for (const float step : {1e-2f, 1e-3f, 1e-4f, 1e-5f}) {
            const std::vector<float> back =
                samples::decoded(samples::encoded(source, {GIM_CODING_SURFACE, step, 0}));
            const double rms = samples::rmsDistance(back, cases[k].xyz);
            EXPECT_LT(rms, 6 * step) << "case " << k;
            EXPECT_GT(rms, 0.05 * step) << "case " << k;
        }
    }
}

TEST(SurfaceCoding, GluedSamplesAreEqualWhateverTheFlags)
{
    Source source;
    source.grid = kFoldedGrid;
    source.seam = foldedSeam();
    const std::vector<float> xyz = foldedSphere();
    source.xyz = xyz;
    const auto bytes = samples::encoded(source, {GIM_CODING_SURFACE, 0.05f, 0});
    for (const std::uint32_t flags : {0u, GIM_NO_FUSE, GIM_NO_DIFFUSE}) {
        const std::vector<float> back = samples::decoded(bytes, flags);
        for (std::uint32_t k = 0; k < kFoldedGrid; ++k)
            for (unsigned c = 0; c < 3; ++c) {
                const std::size_t mate = kFoldedGrid - 1 - k;
                EXPECT_EQ(back[3 * k + c], back[3 * mate + c]);
                EXPECT_EQ(back[3 * k * kFoldedGrid + c], back[3 * mate * kFoldedGrid + c]);
            }
    }
}

// Frames turn with the surface, so its bytes hardly depend on how it lies in space.
TEST(SurfaceCoding, SizeDoesNotDependOnTheAxes)
{
    const std::vector<float> xyz = samples::torusImage(65);
    std::vector<float> turned;
    for (std::size_t k = 0; k < xyz.size(); k += 3) {
        const double x = static_cast<double>(xyz[k]), y = static_cast<double>(xyz[k + 1]),
                     z = static_cast<double>(xyz[k + 2]);
        const double a = 0.6 * x - 0.8 * z, b = 0.8 * x + 0.6 * z;
        for (const double value : {0.28 * a + 0.96 * y, -0.96 * a + 0.28 * y, b})
            turned.push_back(static_cast<float>(value));
    }
    Source source;
    source.grid = 65;
    source.seam = samples::torusSeam(65);
    source.xyz = xyz;
    const auto straight = samples::encoded(source, {GIM_CODING_SURFACE, 1e-3f, 0});
    source.xyz = turned;
    const auto oblique = samples::encoded(source, {GIM_CODING_SURFACE, 1e-3f, 0});
    EXPECT_NEAR(static_cast<double>(oblique.size()), static_cast<double>(straight.size()),
                0.2 * static_cast<double>(straight.size()));
}

TEST(SurfaceCoding, TakesFewerBytesThanComponentsOnTheirOwn)
{
    const std::vector<float> xyz = samples::torusImage(65);
    Source source;
    source.grid = 65;
    source.seam = samples::torusSeam(65);
    source.xyz = xyz;
    const auto surface = samples::encoded(source, {GIM_CODING_SURFACE, 1e-3f, 0});
    const auto wavelet = samples::encoded(source, {GIM_CODING_WAVELET, 1e-3f, 0});
    EXPECT_LT(2 * surface.size(), wavelet.size());
}

// A cylinder of radius 1, cells of 0.5 rad by 0.2: second differences of 2 (1 - cos 0.5), cells of sin 0.5
// times 0.2.
TEST(SurfaceFrame, TangentialStepsFollowFlatnessUpToTheLevelsLimit)
{
    constexpr std::uint32_t n = 5;
    std::vector<double> plane[kComponents];
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            plane[0].push_back(std::cos(0.5 * i));
            plane[1].push_back(std::sin(0.5 * i));
            plane[2].push_back(0.2 * j);
        }
    const double* planes[kComponents] = {plane[0].data(), plane[1].data(), plane[2].data()};
    SurfaceLevel level;
    level.size = n;
    SurfaceParameters parameters;
    const auto ratio = [&](double flatness, double largest) {
        parameters.flatness = flatness;
        level.largestRatio = largest;
        const Frame frame = frameAt(planes, level, parameters, 1, 2);
        EXPECT_EQ(frame.step[1], frame.step[2]);
        return frame.step[1] / frame.step[0];
    };
    const double bend = 2 * (1 - std::cos(0.5));
    EXPECT_NEAR(ratio(4, 8), 4 * std::sqrt(0.2 * std::sin(0.5)) / bend, 1e-12);
    EXPECT_EQ(ratio(4, 2), 2);
    EXPECT_EQ(ratio(0.5, 8), 1);
}

// What a bump takes grows little with the plane around it: 64 times the samples, mostly in empty blocks.
// (Levels above, and the ends of the plane, take something.)
TEST(SurfaceCoding, EmptyBlocksTakeAlmostNothing)
{
    const auto bytes = [](std::uint32_t grid) {
        Source source;
        source.grid = grid;
        source.seam = samples::diskSeam(grid);
        std::vector<float> xyz;
        for (std::uint32_t j = 0; j < grid; ++j)
            for (std::uint32_t i = 0; i < grid; ++i) {
                const double x = i - 20.0, y = j - 20.0, height = 8 * std::exp(-(x * x + y * y) / 8);
                for (const double value : {x, y, height}) xyz.push_back(static_cast<float>(value));
            }
        source.xyz = xyz;
        return static_cast<double>(samples::encoded(source, {GIM_CODING_SURFACE, 0.01f, 0}).size());
    };
    EXPECT_LT(bytes(257), 2.3 * bytes(33));
}

// Samples that no detail was coded for lie as near to the torus as those between which they lie, across the
// seam too.
TEST(SurfaceSmoothLevels, LieBetweenTheCodedSamples)
{
    const std::uint32_t grid = 129, every = 4;
    const std::vector<float> xyz = samples::torusImage(grid);
    Source source;
    source.grid = grid;
    source.seam = samples::torusSeam(17);
    source.xyz = xyz;
    source.smoothLevels = 2;
    const Settings settings{GIM_CODING_SURFACE, 0.002f, 0};
    const auto smooth = samples::encoded(source, settings);
    const std::vector<float> out = samples::decoded(smooth);
    double sums[2] = {}, counts[2] = {};
    for (std::uint32_t j = 0; j < grid; ++j)
        for (std::uint32_t i = 0; i < grid; ++i) {
            const float* p = &out[3 * (j * std::size_t{grid} + i)];
            const double ring = std::hypot(p[0], p[1]) - 3, error = std::hypot(ring, p[2]) - 1;
            const int between = i % every != 0 || j % every != 0 ? 1 : 0;
            sums[between] += error * error;
            counts[between] += 1;
        }
    const double coded = std::sqrt(sums[0] / counts[0]), between = std::sqrt(sums[1] / counts[1]);
    EXPECT_GT(coded, 1e-5);
    EXPECT_LT(coded, 2e-3);
    EXPECT_NEAR(between / coded, 1, 0.5);
    // Where fine details are worth their bytes, there are none all the same.
    const std::vector<float> bumpy = samples::bumpyImage(grid, 7);
    source.xyz = bumpy;
    const Settings finer{GIM_CODING_SURFACE, 0.0004f, 0};
    const std::size_t without = samples::encoded(source, finer).size();
    source.smoothLevels = 0;
    EXPECT_LT(without, samples::encoded(source, finer).size() / 3);
    source.xyz = xyz;
    // As many as there are, or more: only the coarsest samples are left.
    source.smoothLevels = 99;
    EXPECT_LT(samples::encoded(source, settings).size(), 120u);
}

} // namespace
} // namespace gimg::codec

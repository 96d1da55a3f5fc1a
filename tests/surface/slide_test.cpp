#include "slide.h"

#include "../codec/sample_images.h"
#include "gimg/decode.h"
#include "gimg/distance.h"
#include "shapes.h"

#include <tbb/global_control.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gimg {
namespace {

using codec::samples::diskSeam;
using codec::samples::torusSeam;

constexpr int kGrid = 65;

// A torus of radii 3 and 1 whose samples crowd and thin out along it.
FloatImage unevenTorus()
{
    FloatImage image{kGrid, kGrid, {}};
    const auto angle = [](int k) { return 2 * std::numbers::pi * (k % (kGrid - 1)) / (kGrid - 1); };
    for (int j = 0; j < kGrid; ++j)
        for (int i = 0; i < kGrid; ++i) {
            const double u = angle(i) + 0.06 * std::sin(5 * angle(i) + 3 * angle(j));
            const double v = angle(j) + 0.1 * std::sin(4 * angle(i) - 5 * angle(j));
            for (const double x :
                 {(3 + std::cos(v)) * std::cos(u), (3 + std::cos(v)) * std::sin(u), std::sin(v)})
                image.samples.push_back(static_cast<float>(x));
        }
    return image;
}

struct Slid
{
    Slid(const Mesh& mesh, const FloatImage& image, codec::Seam seam, float step)
        : start(encoderOf(image, seam)), measure(mesh)
    {
        const auto surface = std::make_shared<const SlideSurface>(std::move(*SlideSurface::of(mesh)));
        const GridSeam gridSeam{static_cast<int>(seam.lowest), static_cast<int>(seam.start), seam.sides};
        SampleSlide slide = *SampleSlide::of(surface, gridSeam, image);
        end = std::get<codec::Encoder>(start.slid(step, {std::vector<int>(8, 0)}, slide));
    }

    static codec::Encoder encoderOf(const FloatImage& image, const codec::Seam& seam)
    {
        codec::Source source;
        source.grid = static_cast<uint32_t>(image.width);
        source.seam = seam;
        source.xyz = image.samples;
        return std::get<codec::Encoder>(codec::Encoder::prepare(source));
    }

    double psnr(const codec::Encoder& encoder, size_t bytes) const
    {
        const auto file = std::get<codec::EncodedFile>(encoder.encodeToBytes(bytes)).bytes;
        return measure.against(*levelMesh(file, *decodeImages(file), 0))->psnr();
    }

    codec::Encoder start;
    SurfaceMeasure measure;
    codec::Encoder end = start;
};

TEST(Slide, WhatSlidesNeedNotBeCoded)
{
    const Slid slid(shapes::torus(3, 1, 192, 96), unevenTorus(), torusSeam(kGrid), 0.1f);
    double gain = 0;
    for (const size_t bytes : {400, 450, 500, 600})
        gain += (slid.psnr(slid.end, bytes) - slid.psnr(slid.start, bytes)) / 4;
    EXPECT_GT(gain, 2.5);
}

TEST(Slide, SamplesStayOnTheSurfaceAndMatesTogether)
{
    const FloatImage image = unevenTorus();
    const Slid slid(shapes::torus(3, 1, 192, 96), image, torusSeam(kGrid), 0.01f);
    const std::span<const float> samples = slid.end.samples();
    double farthest = 0, longest = 0;
    for (size_t k = 0; k < samples.size(); k += 3) {
        const double x = samples[k], y = samples[k + 1], z = samples[k + 2];
        farthest = std::max(farthest, std::abs(std::hypot(std::hypot(x, y) - 3, z) - 1));
        longest = std::max(
            longest, std::hypot(x - image.samples[k], y - image.samples[k + 1], z - image.samples[k + 2]));
    }
    EXPECT_LT(farthest, 0.01);
    EXPECT_GT(longest, 0.01);
    EXPECT_LT(longest, 0.5);
    for (size_t k = 0; k < kGrid; ++k)
        for (size_t c = 0; c < 3; ++c) {
            EXPECT_EQ(samples[3 * k + c], samples[3 * ((kGrid - 1) * kGrid + k) + c]);
            EXPECT_EQ(samples[3 * k * kGrid + c], samples[3 * (k * kGrid + kGrid - 1) + c]);
        }
}

TEST(Slide, TheBoundaryStays)
{
    // A wavy sheet over the unit square.
    FloatImage image{33, 33, {}};
    Mesh mesh;
    constexpr int kFine = 129;
    const auto height = [](double s, double t) { return 0.1 * std::sin(6 * s) * std::cos(5 * t); };
    for (int j = 0; j < 33; ++j)
        for (int i = 0; i < 33; ++i)
            for (const double x : {i / 32.0, j / 32.0, height(i / 32.0, j / 32.0)})
                image.samples.push_back(static_cast<float>(x));
    for (int j = 0; j < kFine; ++j)
        for (int i = 0; i < kFine; ++i) {
            const double s = i / (kFine - 1.0), t = j / (kFine - 1.0);
            mesh.positions.emplace_back(s, t, height(s, t));
            const int k = j * kFine + i;
            if (i + 1 == kFine || j + 1 == kFine) continue;
            mesh.faces.push_back({k, k + 1, k + kFine + 1});
            mesh.faces.push_back({k, k + kFine + 1, k + kFine});
        }
    const Slid slid(mesh, image, diskSeam(33), 0.01f);
    const std::span<const float> samples = slid.end.samples();
    for (int k = 0; k < 33 * 33; ++k) {
        const int i = k % 33, j = k / 33;
        if (i > 0 && i < 32 && j > 0 && j < 32) continue;
        for (int c = 0; c < 3; ++c) EXPECT_EQ(samples[3 * k + c], image.samples[3 * k + c]);
    }
}

TEST(Slide, DoesNotDependOnThreads)
{
    std::vector<float> samples[2];
    for (const size_t threads : {1, 2}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const Slid slid(shapes::torus(3, 1, 96, 48), unevenTorus(), torusSeam(kGrid), 0.02f);
        samples[threads - 1].assign(slid.end.samples().begin(), slid.end.samples().end());
    }
    EXPECT_EQ(samples[0], samples[1]);
}

} // namespace
} // namespace gimg

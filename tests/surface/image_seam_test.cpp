// Seams of geometry images of surfaces whose gluing is known.
#include "gimg/image_seam.h"

#include "codec/border.h"
#include "gimg/decode.h"
#include "grid_images.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace gimg {
namespace {

using namespace test;

constexpr int kGrid = 33, kSide = kGrid - 1;
constexpr double kPi = std::numbers::pi;

Vec3 torus(double s, double t)
{
    const double u = 2 * kPi * s, v = 2 * kPi * t;
    return {(3 + std::cos(v)) * std::cos(u), (3 + std::cos(v)) * std::sin(u), std::sin(v)};
}

// The octahedral sphere: each side of the square folds onto itself about its middle.
Vec3 sphere(double s, double t)
{
    double x = 2 * s - 1, y = 2 * t - 1;
    const double z = 1 - std::abs(x) - std::abs(y);
    if (z < 0) {
        const double fold = std::copysign(1 - std::abs(y), x);
        y = std::copysign(1 - std::abs(x), y);
        x = fold;
    }
    return Vec3(x, y, z).normalized();
}

Vec3 tube(double s, double t) { return {std::cos(2 * kPi * s), std::sin(2 * kPi * s), 2 * t}; }
Vec3 plate(double s, double t) { return {s, 2 * t, 0.1 * s * t}; }

// A cone over a star of three legs in the plane, `turn` samples on from the corner: the border runs out and
// back along each leg, of 20, 24 and 20 steps.
FloatImage tripod(int turn, double apart = 2 * kPi / 3)
{
    FloatImage image{kGrid, kGrid, std::vector<float>(size_t{3} * kGrid * kGrid)};
    constexpr int kLegs[] = {20, 24, 20};
    const auto onStar = [&](int position) -> Vec3 {
        int at = (position + 8 * kSide - turn) % (4 * kSide);
        for (int leg = 0; leg < 3; ++leg) {
            if (at < 2 * kLegs[leg]) {
                const double out = std::min(at, 2 * kLegs[leg] - at), angle = apart * leg;
                return {out * std::cos(angle), out * std::sin(angle), 0};
            }
            at -= 2 * kLegs[leg];
        }
        return Vec3::Zero();
    };
    const double middle = 0.5 * kSide;
    for (int j = 0; j < kGrid; ++j)
        for (int i = 0; i < kGrid; ++i) {
            const double x = i - middle, y = j - middle, out = std::max(std::abs(x), std::abs(y));
            Vec3 p(0, 0, middle);
            if (out > 0) {
                const auto onBorder = [&](double c) {
                    return static_cast<uint32_t>(std::lround(middle + c * middle / out));
                };
                const uint32_t foot = codec::borderPosition(kGrid, onBorder(x), onBorder(y));
                p = out / middle * onStar(static_cast<int>(foot)) + Vec3(0, 0, middle - out);
            }
            for (int c = 0; c < 3; ++c)
                image.samples[size_t{3} * (j * kGrid + i) + c] = static_cast<float>(p[c]);
        }
    return image;
}

// Every sample off by up to `part` of the diagonal.
FloatImage shaken(FloatImage image, double part)
{
    double diagonal = boundingBoxDiagonal(gridMesh(image));
    std::mt19937 random(7);
    for (size_t k = 0; k < image.samples.size(); k += 3) {
        Vec3 off;
        for (double& c : off) c = static_cast<double>(random()) / 0x1p31 - 1;
        off *= part * diagonal / std::max(1.0, off.norm());
        for (int c = 0; c < 3; ++c) image.samples[k + c] += static_cast<float>(off[c]);
    }
    return image;
}

ImageSeam found(const FloatImage& image, double tolerance = kSeamTolerance)
{
    Result<ImageSeam> seam = findImageSeam(image, {tolerance});
    EXPECT_TRUE(seam.ok()) << seam.error().message;
    return seam ? std::move(*seam) : ImageSeam{};
}

// "2: 0+20 0-20 1=8": the start, then label, kind and length of each side, in steps of the image's grid.
std::string word(const ImageSeam& seam)
{
    const int unit = (seam.image.width - 1) / (seam.seam.lowest - 1);
    std::string text = std::to_string(seam.seam.start * unit) + ':';
    for (const gim_side& side : seam.seam.sides)
        text += ' ' + std::to_string(side.path) + "=+-"[side.kind] +
                std::to_string(static_cast<int>(side.length) * unit);
    return text;
}

constexpr const char* kTorus = "0: 0+32 1+32 0-32 1-32";
constexpr const char* kFolded = "0: 0+16 0-16 1+16 1-16 2+16 2-16 3+16 3-16";
constexpr const char* kTripod = "6: 0+20 0-20 1+24 1-24 2+20 2-20";

TEST(ImageSeam, IsThatOfTheSurfaceThatWasSampled)
{
    EXPECT_EQ(word(found(sampled(torus, kGrid))), kTorus);
    EXPECT_EQ(word(found(sampled(sphere, kGrid))), kFolded);
    EXPECT_EQ(word(found(sampled(tube, kGrid))), "0: 0=32 1+32 2=32 1-32");
    EXPECT_EQ(word(found(tripod(6))), kTripod);
    const ImageSeam open = found(sampled(plate, kGrid));
    EXPECT_EQ(word(open), "0: 0=128");
    EXPECT_EQ(open.glued, 0);
    EXPECT_EQ(open.objection, "");
}

TEST(ImageSeam, LowestLevelIsTheCoarsestThatItsSidesAndTheSurfaceAllow)
{
    EXPECT_EQ(found(tripod(6)).seam.lowest, 17); // starts at 6, sides of 20 and 24
    EXPECT_EQ(found(tripod(7)).seam.lowest, 33);
    EXPECT_EQ(found(sampled(plate, kGrid)).seam.lowest, 3);
    ImageSeamOptions options;
    options.lowest = 33;
    const Result<ImageSeam> fine = findImageSeam(tripod(6), options);
    ASSERT_TRUE(fine.ok());
    EXPECT_EQ(fine->seam.lowest, 33);
    EXPECT_EQ(word(*fine), kTripod);
    options.lowest = 9;
    const Result<ImageSeam> coarse = findImageSeam(tripod(6), options);
    ASSERT_FALSE(coarse.ok());
    EXPECT_EQ(coarse.error().kind, ErrorKind::TargetUnreachable);
    EXPECT_THAT(coarse.error().message, testing::HasSubstr("17"));
}

TEST(ImageSeam, HoldsForSamplesThatAreOffByLessThanTheTolerance)
{
    for (const double tolerance : {1e-4, 1e-3}) {
        const double off = 0.45 * tolerance; // of each of two
        EXPECT_EQ(word(found(shaken(sampled(torus, kGrid), off), tolerance)), kTorus);
        EXPECT_EQ(word(found(shaken(sampled(sphere, kGrid), off), tolerance)), kFolded);
        const ImageSeam seam = found(shaken(tripod(6), off), tolerance);
        EXPECT_EQ(word(seam), kTripod);
        EXPECT_GT(seam.widestGap, 0.2 * tolerance);
        EXPECT_LE(seam.widestGap, 2 * tolerance);
    }
}

TEST(ImageSeam, IsNotFoundForSamplesThatAreOffByMore)
{
    const ImageSeam seam = found(shaken(sampled(torus, kGrid), 1e-3), 1e-5);
    EXPECT_EQ(seam.glued, 0);
    EXPECT_EQ(word(seam), "0: 0=128");
}

TEST(ImageSeam, NodesAreExactWhereLegsPartSlowly)
{
    // One sample from the node they are half a step apart: within the tolerance.
    const FloatImage image = tripod(6, 0.5);
    EXPECT_EQ(word(found(image, 0.9 / boundingBoxDiagonal(gridMesh(image)))), kTripod);
}

TEST(ImageSeam, MatesBecomeTheirMean)
{
    const FloatImage off = shaken(sampled(torus, kGrid), 4e-5);
    const ImageSeam seam = found(off);
    for (int k = 1; k < kSide; ++k) {
        EXPECT_EQ(sampleAt(seam.image, k, 0), sampleAt(seam.image, k, kSide));
        const Vec3 mean = (sampleAt(off, k, 0) + sampleAt(off, k, kSide)) / 2;
        EXPECT_LT((sampleAt(seam.image, k, 0) - mean).norm(), 1e-6);
        EXPECT_EQ(sampleAt(seam.image, k, k), sampleAt(off, k, k));
    }
    EXPECT_EQ(sampleAt(seam.image, 0, 0), sampleAt(seam.image, kSide, kSide));
}

TEST(ImageSeam, ASlitThatALargerToleranceWouldCloseIsTold)
{
    FloatImage image = sampled(torus, kGrid);
    for (int i = 10; i < 13; ++i) image.samples[size_t{3} * i + 2] += 0.005f; // of a diagonal of 11.5
    const ImageSeam seam = found(image);
    EXPECT_EQ(seam.glued, 120);
    EXPECT_EQ(seam.slits, 1);
    EXPECT_NEAR(seam.widestSlit, 0.005 / 11.489, 1e-6);
    EXPECT_EQ(word(found(image, 5e-4)), kTorus);
    EXPECT_EQ(found(sampled(tube, kGrid)).slits, 0);
}

TEST(ImageSeam, WhatIsNoSimplicialSurfaceStaysOpenAndSaysSo)
{
    // Folded about its diagonal: at two corners the two triangles of a cell would become one.
    const ImageSeam seam =
        found(sampled([](double s, double t) { return Vec3(s + t, (s - t) * (s - t), s * t); }, kGrid));
    EXPECT_EQ(seam.glued, 0);
    EXPECT_THAT(seam.objection, testing::HasSubstr("simplicial"));
}

TEST(ImageSeam, RefusesWhatIsNoGeometryImage)
{
    const auto kindOf = [](const FloatImage& image, double tolerance = kSeamTolerance) {
        const Result<ImageSeam> seam = findImageSeam(image, {tolerance});
        return seam ? ErrorKind::CodecFailure : seam.error().kind;
    };
    EXPECT_EQ(kindOf(sampled(torus, 32)), ErrorKind::BadArgument);
    EXPECT_EQ(kindOf(sampled(torus, kGrid), 0), ErrorKind::BadArgument);
    EXPECT_EQ(kindOf(sampled(torus, kGrid), 0.2), ErrorKind::BadArgument);
    FloatImage image = sampled(torus, kGrid);
    image.samples[5] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(kindOf(image), ErrorKind::NotFinite);
    image.samples.assign(image.samples.size(), 1.0f);
    EXPECT_EQ(kindOf(image), ErrorKind::EmptyMesh);
}

} // namespace
} // namespace gimg

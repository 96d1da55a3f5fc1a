// Geometry images that come without a mesh.
#include "encoding.h"

#include "../surface/grid_images.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace gimg {
namespace {

using namespace test;

constexpr int kGrid = 65;

// A torus whose samples crowd and thin out along it.
FloatImage torus()
{
    return sampled(
        [](double s, double t) {
            const double a = 2 * std::numbers::pi * s, b = 2 * std::numbers::pi * t;
            const double u = a + 0.06 * std::sin(5 * a + 3 * b), v = b + 0.1 * std::sin(4 * a - 5 * b);
            return Vec3((3 + std::cos(v)) * std::cos(u), (3 + std::cos(v)) * std::sin(u), std::sin(v));
        },
        kGrid);
}

EncodedMesh encodeTorus(const EncodeOptions& options, double tolerance = kSeamTolerance)
{
    Result<EncodedMesh> encoded = encodeImage(torus(), options, tolerance);
    EXPECT_TRUE(encoded.ok()) << encoded.error().message;
    return encoded ? std::move(*encoded) : EncodedMesh{};
}

TEST(FromImage, SeamAndSlidingCountAgainstTheImagesOwnTriangles)
{
    const EncodedMesh slid = encodeTorus(forBytes(500));
    EXPECT_EQ(slid.topology.genus, 1);
    EXPECT_EQ(slid.topology.boundaries, 0);
    EXPECT_EQ(slid.cutPaths, 2);
    EXPECT_EQ(slid.image->glued, 4 * (kGrid - 1));
    EXPECT_NEAR(slid.psnr, psnrOf(gridMesh(torus()), decodedLevel(slid, 0)), 1e-9);
    EncodeOptions still = forBytes(500);
    still.effort = 1;
    const EncodedMesh glued = encodeTorus(still);
    EXPECT_GT(slid.psnr, glued.psnr + 0.5);

    FloatImage apart = torus(); // by more than the tolerance along the top and the right
    for (int k = 0; k < kGrid; ++k)
        for (const int sample : {(kGrid - 1) * kGrid + k, k * kGrid + kGrid - 1})
            for (int c = 0; c < 3; ++c) apart.samples[3 * sample + c] *= 1.002f;
    const Result<EncodedMesh> open = encodeImage(apart, still);
    ASSERT_TRUE(open.ok());
    EXPECT_EQ(open->image->glued, 0);
    EXPECT_EQ(open->topology.boundaries, 1);
    EXPECT_THAT(open->warnings, testing::Contains(testing::HasSubstr("coded as open")));
    EXPECT_GT(glued.psnr, open->psnr + 0.5);
}

TEST(FromImage, AllTargetsAreMet)
{
    EncodeOptions options = forTarget(EncodeTarget::RawFloat, 0);
    const EncodedMesh exact = encodeTorus(options);
    EXPECT_GT(exact.psnr, 130); // mates have been averaged
    const Result<DecodedImages> images = decodeImages(exact.file);
    ASSERT_TRUE(images.ok());
    for (int i = 1; i + 1 < kGrid; ++i)
        EXPECT_EQ(sampleAt(images->geometry, i, kGrid / 2), sampleAt(torus(), i, kGrid / 2));
    options.target = EncodeTarget::Raw12;
    EXPECT_GT(encodeTorus(options).psnr, 70);
    options.target = EncodeTarget::Psnr;
    options.psnr = 60;
    const double psnr = encodeTorus(options).psnr;
    EXPECT_GE(psnr, 60);
    EXPECT_LE(psnr, 60.2);
    options.target = EncodeTarget::MaxError;
    options.maxError = 0.004;
    const double error = encodeTorus(options).maxError;
    EXPECT_LE(error, 0.004);
    EXPECT_GE(error, 0.98 * 0.004);
}

TEST(FromImage, NormalsAreThoseOfItsTriangles)
{
    EncodeOptions options = forTarget(EncodeTarget::RawFloat, kGrid);
    options.normals = 33;
    const Result<DecodedImages> images = decodeImages(encodeTorus(options).file);
    ASSERT_TRUE(images.ok());
    ASSERT_EQ(images->normals.width, 33);
    for (int k = 0; k < 33; ++k) {
        const Vec3 p = sampleAt(images->geometry, 2 * k, 20), n = sampleAt(images->normals, k, 10);
        const Vec3 axis = 3 * Vec3(p[0], p[1], 0).normalized();
        EXPECT_GT(n.dot((p - axis).normalized()), std::cos(0.06));
    }
    options.grid = 33;
    EXPECT_EQ(encodeImage(torus(), options).error().kind, ErrorKind::BadArgument);
}

} // namespace
} // namespace gimg

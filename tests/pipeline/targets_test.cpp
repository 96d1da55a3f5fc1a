// What the targets promise: bytes, decibels, exact samples. Slow under sanitizers.
#include "encoding.h"

#include "corpus/shapes.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>

namespace gimg {
namespace {

using namespace test;

TEST(EncodeBytes, NeverOverAndAtMostOnePercentOr24Under)
{
    const Mesh mesh = shapes::wavySphere(1, 0.3, 5, 24);
    double last = 0;
    for (size_t bytes : {300, 1000, 3000}) {
        const EncodedMesh encoded = encode(mesh, forBytes(bytes, 129));
        EXPECT_LE(encoded.file.size(), bytes);
        EXPECT_GE(encoded.file.size() + std::max<size_t>(24, bytes / 100), bytes);
        EXPECT_GT(encoded.psnr, last + 3); // more bytes, a better surface
        last = encoded.psnr;
    }
    EXPECT_GT(last, 68);
    const EncodedMesh large = encode(mesh, forBytes(40000, 129));
    EXPECT_LE(large.file.size(), 40000u);
    EXPECT_GE(large.file.size(), 39600u);
}

TEST(EncodeBytes, ATargetBelowTheSmallestFileSaysWhatCanBeHad)
{
    const Result<EncodedMesh> encoded = encodeMesh(shapes::sphere(1, 8), forBytes(20, 65));
    ASSERT_FALSE(encoded.ok());
    EXPECT_EQ(encoded.error().kind, ErrorKind::TargetUnreachable);
    EXPECT_THAT(encoded.error().message, testing::ContainsRegex("[0-9]+ bytes"));
}

TEST(EncodePsnr, IsMetWithinAFifthOfADecibel)
{
    const Mesh mesh = shapes::torus(3, 1, 96, 48);
    EncodeOptions options = forTarget(EncodeTarget::Psnr, 65);
    for (double psnr : {45.0, 58.0}) {
        options.psnr = psnr;
        options.effort = psnr < 50 ? 6 : 1;
        const EncodedMesh encoded = encode(mesh, options);
        EXPECT_GE(encoded.psnr, psnr);
        EXPECT_LE(encoded.psnr, psnr + 0.2);
        EXPECT_NEAR(encoded.psnr, psnrOf(mesh, decodedLevel(encoded, 0)), 1e-9);
    }
}

TEST(EncodeMaxError, IsMetWithinTwoPercent)
{
    const Mesh mesh = shapes::torus(3, 1, 96, 48);
    EncodeOptions options = forTarget(EncodeTarget::MaxError, 129);
    options.effort = 1;
    options.maxError = 0.004;
    const EncodedMesh encoded = encode(mesh, options);
    EXPECT_LE(encoded.maxError, 0.004);
    EXPECT_GE(encoded.maxError, 0.98 * 0.004);
    EXPECT_TRUE(encoded.warnings.empty());
    const Result<SurfaceDistance> distance = compareSurfaces(mesh, decodedLevel(encoded, 0));
    ASSERT_TRUE(distance.ok());
    EXPECT_NEAR(encoded.maxError, distance->hausdorff() / distance->diagonal, 1e-12);
}

TEST(EncodeMaxError, WhereTheStepDoesNotDecideSaysSo)
{
    const Mesh mesh = shapes::torus(3, 1, 24, 12);
    EncodeOptions options = forTarget(EncodeTarget::MaxError, 17);
    options.effort = 1;
    options.maxError = 1e-6;
    const Result<EncodedMesh> fine = encodeMesh(mesh, options);
    ASSERT_FALSE(fine.ok());
    EXPECT_EQ(fine.error().kind, ErrorKind::TargetUnreachable);
    EXPECT_THAT(fine.error().message, testing::HasSubstr("larger --grid"));
    options.maxError = 0.99; // more than any surface inside the bounding box
    const EncodedMesh coarse = encode(mesh, options);
    EXPECT_LT(coarse.maxError, 0.97);
    EXPECT_THAT(coarse.warnings, testing::Contains(testing::HasSubstr("nearer to a largest error of 0.99")));
    for (double bad : {0.0, -0.1, 1.0, std::nan("")}) {
        options.maxError = bad;
        EXPECT_EQ(encodeMesh(mesh, options).error().kind, ErrorKind::BadArgument);
    }
}

TEST(EncodeEffort, BuysDecibels)
{
    const Mesh mesh = shapes::wavySphere(1, 0.3, 5, 24);
    EncodeOptions options = forBytes(1000, 65);
    double psnr[3];
    for (int k = 0; k < 3; ++k) {
        options.effort = std::array{1, 6, 8}[static_cast<size_t>(k)];
        psnr[k] = encode(mesh, options).psnr;
    }
    EXPECT_GT(psnr[1], psnr[0] + 0.2);
    EXPECT_GT(psnr[2], psnr[1] + 0.01);
    for (int bad : {0, 10, -1}) {
        options.effort = bad;
        EXPECT_EQ(encodeMesh(mesh, options).error().kind, ErrorKind::BadArgument);
    }
}

// PSNR of the first bytes of a file.
double prefixPsnr(const EncodedMesh& encoded, size_t bytes, const Mesh& reference)
{
    const std::span<const uint8_t> prefix(encoded.file.data(), bytes);
    const Result<DecodedImages> images = decodeImages(prefix, GIM_PREFIX);
    EXPECT_TRUE(images.ok());
    const Result<Mesh> mesh = levelMesh(prefix, *images, 0, GIM_PREFIX);
    EXPECT_TRUE(mesh.ok());
    return test::psnrOf(reference, *mesh);
}

TEST(EncodeProgressive, PrefixesAreWorthMore)
{
    const Mesh mesh = shapes::wavySphere(1, 0.3, 5, 24);
    EncodeOptions options = forBytes(2000, 65);
    options.effort = 6;
    const EncodedMesh plain = encode(mesh, options);
    options.progressive = true;
    const EncodedMesh progressive = encode(mesh, options);
    EXPECT_GT(progressive.psnr, plain.psnr - 1);
    for (size_t bytes : {500, 1000})
        EXPECT_GT(prefixPsnr(progressive, bytes, mesh), prefixPsnr(plain, bytes, mesh) + 0.8) << bytes;
    EXPECT_GT(prefixPsnr(progressive, 1000, mesh), encode(mesh, forBytes(1000, 65)).psnr - 1);
}

TEST(EncodePsnr, ATargetAboveTheGridSaysWhatItHolds)
{
    EncodeOptions options = forTarget(EncodeTarget::Psnr, 33);
    options.psnr = 100;
    const Result<EncodedMesh> encoded = encodeMesh(shapes::torus(3, 1, 64, 32), options);
    ASSERT_FALSE(encoded.ok());
    EXPECT_EQ(encoded.error().kind, ErrorKind::TargetUnreachable);
    EXPECT_THAT(encoded.error().message, testing::HasSubstr("larger --grid"));
}

TEST(EncodeGrid, LeftOpenGrowsWithTheGoal)
{
    const Mesh mesh = shapes::wavySphere(1, 0.3, 5, 16);
    EncodeOptions options = forBytes(12000, 129);
    options.effort = 2;
    const double at129 = encode(mesh, options).psnr;
    options.grid = 0;
    const Result<MeshEncoder> encoder = MeshEncoder::prepare(mesh, options);
    ASSERT_TRUE(encoder.ok());
    const Result<EncodedMesh> small = encoder->encode({EncodeTarget::Bytes, 300});
    const Result<EncodedMesh> large = encoder->encode({EncodeTarget::Bytes, 12000});
    ASSERT_TRUE(small.ok() && large.ok());
    EXPECT_EQ(small->grid, 129);
    EXPECT_GT(large->grid, 129);
    EXPECT_GT(large->psnr, at129 + 0.5);
    const Result<EncodedMesh> coarse = encoder->encode({EncodeTarget::Psnr, 0, 50});
    const Result<EncodedMesh> fine = encoder->encode({EncodeTarget::Psnr, 0, 80});
    const Result<EncodedMesh> near =
        encoder->encode({EncodeTarget::MaxError, 0, 0, LossyCoding::Surface, 0.01});
    ASSERT_TRUE(coarse.ok() && fine.ok() && near.ok());
    EXPECT_EQ(near->grid, 129);
    EXPECT_EQ(coarse->grid, 129);
    EXPECT_GT(fine->grid, 129);
    EXPECT_GE(fine->psnr, 80);
    EXPECT_EQ(encoder->encode({EncodeTarget::RawFloat})->grid, BorderOptions::kDefaultGrid);
}

TEST(EncodeRaw, FloatIsBetterThan12BitsAndBothCloseToTheSurface)
{
    const Mesh mesh = shapes::torus(3, 1, 96, 48);
    const EncodedMesh exact = encode(mesh, forTarget(EncodeTarget::RawFloat, 129));
    const EncodedMesh integers = encode(mesh, forTarget(EncodeTarget::Raw12, 129));
    EXPECT_GT(exact.psnr, integers.psnr);
    EXPECT_GT(integers.psnr, 60);
    EXPECT_GT(exact.file.size(), integers.file.size());
    EXPECT_LT(integers.file.size(), 129u * 129 * 9 / 2 * 3 / 10); // 36 bits a sample if they were packed
    EXPECT_LT(exact.file.size(), 129u * 129 * 12 * 6 / 10);
    // 12 bits over a cube of side 8: at most half a step off, 8 / 4095 / 2 a coordinate.
    const Mesh a = decodedLevel(exact, 0), b = decodedLevel(integers, 0);
    ASSERT_EQ(a.vertexCount(), b.vertexCount());
    for (int v = 0; v < a.vertexCount(); ++v)
        EXPECT_LE((a.positions[v] - b.positions[v]).cwiseAbs().maxCoeff(), 0.5 * 8 / 4095 * 1.0001);
}

TEST(EncodeRaw, FinerGridsConvergeQuadratically)
{
    // Linear interpolation of a smooth surface: the error falls by 4, 12 dB, when the grid doubles; the
    // facets of the reference bound it from below.
    const Mesh mesh = shapes::torus(3, 1, 144, 72);
    const double coarse = encode(mesh, forTarget(EncodeTarget::RawFloat, 33)).psnr;
    const double fine = encode(mesh, forTarget(EncodeTarget::RawFloat, 65)).psnr;
    EXPECT_GT(fine, coarse + 9.5);
    EXPECT_LT(fine, coarse + 14);
}

TEST(EncodeNormals, AreDecodedAtTheirOwnResolution)
{
    EncodeOptions options = forBytes(8000, 65);
    options.normals = 129;
    const EncodedMesh encoded = encode(shapes::sphere(1, 24), options);
    EXPECT_LE(encoded.file.size(), 8000u);
    const Result<DecodedImages> images = decodeImages(encoded.file);
    ASSERT_TRUE(images.ok());
    ASSERT_EQ(images->normals.width, 129);
    // The sphere's normals are its points.
    double worst = 1;
    for (int j = 0; j < 65; ++j)
        for (int i = 0; i < 65; ++i) {
            Vec3 p, n;
            for (int k = 0; k < 3; ++k)
                p[k] = images->geometry.at(i, j, k), n[k] = images->normals.at(2 * i, 2 * j, k);
            EXPECT_NEAR(n.norm(), 1, 1e-6);
            worst = std::min(worst, n.dot(p) / p.norm());
        }
    EXPECT_GT(worst, std::cos(5 * M_PI / 180));
}

} // namespace
} // namespace gimg

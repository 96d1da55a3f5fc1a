#include "encoding.h"

#include "corpus/shapes.h"
#include "manifold_check.h"

#include <gmock/gmock.h>

namespace gimg {
namespace {

using namespace test;

TEST(EncodeThreads, FileDoesNotDependOnThem)
{
    const Mesh mesh = shapes::surfaceOfGenus(2, 1, 8);
    EncodeOptions options = forBytes(3000);
    options.threads = 1;
    const EncodedMesh one = encode(mesh, options);
    options.threads = 2;
    const EncodedMesh two = encode(mesh, options);
    EXPECT_EQ(one.file, two.file);
}

TEST(MeshEncoder, OnePreparationServesEveryGoalAsEncodeMeshDoes)
{
    const Mesh mesh = shapes::surfaceOfGenus(2, 1, 8);
    const Result<MeshEncoder> encoder = MeshEncoder::prepare(mesh, forBytes(1, 65));
    ASSERT_TRUE(encoder.ok()) << encoder.error().message;
    EncodeOptions options = forBytes(2500, 65);
    for (EncodeTarget target : {EncodeTarget::Bytes, EncodeTarget::Raw12, EncodeTarget::RawFloat}) {
        options.target = target;
        const Result<EncodedMesh> again = encoder->encode(options);
        ASSERT_TRUE(again.ok()) << again.error().message;
        const EncodedMesh once = encode(mesh, options);
        EXPECT_EQ(again->file, once.file);
        EXPECT_EQ(again->psnr, once.psnr);
    }
    options.target = EncodeTarget::Bytes;
    options.bytes = 10;
    const Result<EncodedMesh> tooSmall = encoder->encode(options);
    ASSERT_FALSE(tooSmall.ok());
    EXPECT_EQ(tooSmall.error().kind, ErrorKind::TargetUnreachable);
}

TEST(EncodeScale, LargeOffsetsKeepTheirPrecision)
{
    // A survey's coordinates: millions of metres away, detail of a metre.
    Mesh mesh = shapes::sphere(100, 16);
    for (Vec3& p : mesh.positions) p += Vec3(5e5, 4.1e6, 200);
    const EncodedMesh encoded = encode(mesh, forTarget(EncodeTarget::RawFloat, 65));
    EXPECT_GT(encoded.psnr, 55);
    const EncodedMesh lossy = encode(mesh, forBytes(6000, 65));
    EXPECT_GT(lossy.psnr, 55);
}

TEST(EncodeScale, WhatFloat32CannotHoldIsRefusedAndWhatItHoldsBadlyIsSaid)
{
    const auto moved = [](double scale, double offset) {
        Mesh mesh = shapes::torus(2, 1, 16, 8);
        for (Vec3& p : mesh.positions) p = scale * p + Vec3(offset, 0, 0);
        return encodeMesh(mesh, forBytes(2000, 33));
    };
    for (const Result<EncodedMesh>& bad : {moved(1e30, 0), moved(1e-30, 0), moved(1e300, 0), moved(1, 1e9)}) {
        ASSERT_FALSE(bad.ok());
        EXPECT_EQ(bad.error().kind, ErrorKind::NotFinite);
    }
    const Result<EncodedMesh> doubtful = moved(1, 1e4);
    ASSERT_TRUE(doubtful.ok());
    ASSERT_EQ(doubtful->warnings.size(), 1u);
    EXPECT_THAT(doubtful->warnings[0], testing::HasSubstr("float32"));
    EXPECT_TRUE(moved(1, 10)->warnings.empty());
    EXPECT_TRUE(moved(1e9, 0).ok());

    Mesh point = shapes::torus(2, 1, 16, 8);
    for (Vec3& p : point.positions) p = Vec3(1, 2, 3);
    EXPECT_FALSE(encodeMesh(point, forBytes(2000, 33)).ok());
}

TEST(EncodeSmoothLevels, AreRefusedWhereThereAreNone)
{
    const Mesh torus = shapes::torus(3, 1, 24, 12);
    EncodeOptions options = forBytes(900, 33);
    options.smoothLevels = 5;
    EXPECT_EQ(encodeMesh(torus, options).error().kind, ErrorKind::BadArgument);
    options.smoothLevels = 1;
    options.target = EncodeTarget::Raw12;
    EXPECT_EQ(encodeMesh(torus, options).error().kind, ErrorKind::BadArgument);
}

TEST(EncodeTiny, ATetrahedronAndATriangleWork)
{
    Mesh tetrahedron;
    tetrahedron.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    tetrahedron.faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    const EncodedMesh closed = encode(tetrahedron, forBytes(3000, 33));
    EXPECT_EQ(test::checkManifold(decodedLevel(closed, 0).faces).boundaries, 0);
    EXPECT_GT(closed.psnr, 35);
    Mesh triangle;
    triangle.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    triangle.faces = {{0, 1, 2}};
    const EncodedMesh open = encode(triangle, forBytes(1000, 33));
    EXPECT_EQ(test::checkManifold(decodedLevel(open, 0).faces).boundaries, 1);
    EXPECT_GT(open.psnr, 35);
}

TEST(EncodeTiny, ATorusWithNormals)
{
    EncodeOptions options = forTarget(EncodeTarget::Raw12, 33);
    options.normals = 17;
    const EncodedMesh encoded = encode(shapes::torus(2, 1, 12, 8), options);
    EXPECT_GT(encoded.psnr, 40);
    const Result<DecodedImages> images = decodeImages(encoded.file);
    ASSERT_TRUE(images.ok());
    ASSERT_EQ(images->normals.width, 17);
    // Out of the tube, whose axis is the circle of radius 2 in the plane.
    const auto at = [](const FloatImage& image, int k) {
        return Vec3(image.at(k, k, 0), image.at(k, k, 1), image.at(k, k, 2));
    };
    for (int k = 0; k < 17; ++k) {
        const Vec3 p = at(images->geometry, 2 * k), n = at(images->normals, k);
        const Vec3 axis = Vec3(p.x(), p.y(), 0).normalized() * 2;
        EXPECT_NEAR(n.norm(), 1, 1e-6);
        EXPECT_GT(n.dot((p - axis).normalized()), 0.9); // facets of 45 degrees
    }
}

TEST(EncodeOptions, OutOfRangeIsRefused)
{
    const Mesh mesh = shapes::sphere(1, 4);
    EncodeOptions grid = forBytes(2000, 100), normals = forBytes(2000, 65), threads = forBytes(2000, 65);
    normals.normals = 100;
    threads.threads = -1;
    for (const EncodeOptions& bad : {grid, normals, threads}) {
        const Result<EncodedMesh> encoded = encodeMesh(mesh, bad);
        ASSERT_FALSE(encoded.ok());
        EXPECT_EQ(encoded.error().kind, ErrorKind::BadArgument) << encoded.error().message;
    }
}

} // namespace
} // namespace gimg

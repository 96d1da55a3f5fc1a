#include "corpus/shapes.h"
#include "encoding.h"

#include <cmath>

namespace gimg {
namespace {

using test::encode;
using test::forBytes;
using test::forTarget;

/// Between 0 and 1, and linear in the position on a torus of radii 3 and 1.
Vec3 colorAt(const Vec3& p) { return {(p.x() + 4) / 8, (p.y() + p.z() + 6) / 12, (p.z() + 1.5) / 3}; }

AttributedSurface colored(const Mesh& mesh)
{
    AttributedSurface surface{mesh, {{"color", 3, GIM_U8, true, {}}, {"height", 1, GIM_F32, false, {}}}};
    for (const Vec3& p : mesh.positions) {
        for (const double c : colorAt(p))
            surface.attributes[0].values.push_back(static_cast<float>(std::floor(255 * c + 0.5)));
        surface.attributes[1].values.push_back(static_cast<float>(p.z()));
    }
    return surface;
}

/// The largest and the mean difference of decoded colours from those of where the vertices are.
std::pair<double, double> colorErrors(const EncodedMesh& encoded, unsigned level)
{
    const Result<DecodedImages> images = decodeImages(encoded.file);
    EXPECT_TRUE(images.ok());
    const Result<Mesh> mesh = levelMesh(encoded.file, *images, level);
    const Result<std::vector<VertexAttribute>> attributes = levelAttributes(encoded.file, *images, level);
    EXPECT_TRUE(mesh.ok() && attributes.ok());
    const VertexAttribute* color = findAttribute(*attributes, "color");
    EXPECT_NE(color, nullptr);
    EXPECT_EQ(color->values.size(), 3 * mesh->positions.size());
    double worst = 0, sum = 0;
    for (int v = 0; v < mesh->vertexCount(); ++v) {
        const Vec3 expected = 255 * colorAt(mesh->positions[v]);
        for (int c = 0; c < 3; ++c) {
            const double off = std::abs(double{color->values[3 * v + c]} - expected[c]);
            worst = std::max(worst, off);
            sum += off;
        }
    }
    return {worst, sum / (3 * mesh->vertexCount())};
}

TEST(EncodeAttributes, ColorsBelongToWhereTheDecoderPutsTheSamples)
{
    const Mesh mesh = shapes::torus(3, 1, 96, 48);
    const AttributedSurface surface = colored(mesh);
    // At 65 samples a cell is 8 to 24 levels of colour wide: samples that slid by a quarter of one, with the
    // colours of where they were, would be off by 2 to 6.
    for (EncodeOptions options : {forBytes(9000, 65), forTarget(EncodeTarget::RawFloat, 65)}) {
        options.attributed = &surface;
        options.attributes = {{"color", 0, options.target == EncodeTarget::Bytes}};
        const EncodedMesh encoded = encode(mesh, options);
        const auto [worst, mean] = colorErrors(encoded, 0);
        EXPECT_LT(worst, 4.5);
        EXPECT_LT(mean, 0.7);
        if (options.target == EncodeTarget::Bytes) {
            EXPECT_LE(encoded.file.size(), 9000u);
        }
        EXPECT_LT(colorErrors(encoded, 1).second, 0.7);
    }
}

TEST(EncodeAttributes, LossyOnesShareTheBytesWithTheGeometry)
{
    const Mesh mesh = shapes::torus(3, 1, 96, 48);
    const AttributedSurface surface = colored(mesh);
    EncodeOptions options = forBytes(6000, 65);
    options.attributed = &surface;
    options.attributes = {{"color", 0, false}, {"height", 33, false}};
    options.normals = 65;
    const EncodedMesh encoded = encode(mesh, options);
    EXPECT_LE(encoded.file.size(), 6000u);
    EXPECT_GE(encoded.file.size(), 5900u);
    EXPECT_LT(colorErrors(encoded, 0).second, 3);
    const Result<DecodedImages> images = decodeImages(encoded.file);
    ASSERT_TRUE(images.ok());
    ASSERT_EQ(images->attributes.size(), 2u);
    EXPECT_EQ(images->attributes[1].info.grid, 33u);
    EXPECT_NEAR(static_cast<double>(images->attributes[0].info.coded_bytes), 6000.0 / 8, 100);
    EXPECT_NEAR(static_cast<double>(images->info.normal_bytes), 6000.0 / 4, 150);
}

TEST(EncodeAttributes, ThinWallsKeepTheirSides)
{
    // A flat box: the far side is nearer to a sample than the spacing of the samples.
    Mesh mesh = shapes::sphere(1, 32);
    for (Vec3& p : mesh.positions) p.z() *= 0.02;
    AttributedSurface surface{mesh, {{"side", 1, GIM_U8, false, {}}}};
    for (const Vec3& p : mesh.positions) surface.attributes[0].values.push_back(p.z() > 0 ? 200.0f : 0.0f);
    EncodeOptions options = forBytes(4000, 65);
    options.attributed = &surface;
    options.attributes = {{"side", 0, true}};
    const EncodedMesh encoded = encode(mesh, options);
    const Result<DecodedImages> images = decodeImages(encoded.file);
    const Result<Mesh> decoded = levelMesh(encoded.file, *images, 0);
    const Result<std::vector<VertexAttribute>> attributes = levelAttributes(encoded.file, *images, 0);
    ASSERT_TRUE(decoded.ok() && attributes.ok());
    const std::vector<Vec3> normals = vertexNormals(*decoded);
    int wrong = 0, judged = 0;
    for (int v = 0; v < decoded->vertexCount(); ++v) {
        const Vec3& p = decoded->positions[v];
        if (std::hypot(p.x(), p.y()) > 0.8 || std::abs(normals[v].z()) < 0.8) continue;
        ++judged;
        wrong += ((*attributes)[0].values[v] > 100) != (normals[v].z() > 0);
    }
    EXPECT_GT(judged, 1000);
    EXPECT_LE(wrong, judged / 100);
}

TEST(EncodeAttributes, WhatIsNotThereIsRefusedWithWhatIs)
{
    const Mesh mesh = shapes::torus(3, 1, 16, 8);
    AttributedSurface surface = colored(mesh);
    EncodeOptions options = forBytes(3000, 33);
    options.attributed = &surface;
    options.attributes = {{"colour", 0, false}};
    const Result<EncodedMesh> unknown = encodeMesh(mesh, options);
    ASSERT_FALSE(unknown.ok());
    EXPECT_EQ(unknown.error().kind, ErrorKind::BadArgument);
    EXPECT_EQ(unknown.error().message, "no attribute colour; the mesh has: color, height");
    options.attributes = {{"color", 100, false}};
    EXPECT_FALSE(encodeMesh(mesh, options).ok());
    options.attributes = {{"color", 0, false}, {"color", 33, false}};
    EXPECT_FALSE(encodeMesh(mesh, options).ok());
    surface.attributes[1].values[3] = NAN;
    options.attributes = {{"height", 0, false}};
    EXPECT_EQ(encodeMesh(mesh, options).error().kind, ErrorKind::NotFinite);
}

} // namespace
} // namespace gimg

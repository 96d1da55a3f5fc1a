#include "gimg/conformal_image.h"

#include "gimg/decode.h"
#include "gimg/encode.h"
#include "gimg/stretch.h"

#include "shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace gimg {
namespace {

Mesh lump(int n)
{
    Mesh mesh = shapes::sphere(1, n);
    for (Vec3& p : mesh.positions)
        p *= 1 + 0.6 * std::exp(-4 * (p - Vec3(0.6, 0, 0.8)).squaredNorm()) -
             0.3 * std::exp(-4 * (p - Vec3(0, -1, 0)).squaredNorm());
    return mesh;
}

std::vector<Vec2> gridOfSquare(int n)
{
    std::vector<Vec2> st;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) st.push_back(Vec2(i, j) / (n - 1));
    return st;
}

Conformality angles(const FloatImage& image)
{
    return conformality(gridMesh(image), gridOfSquare(image.width));
}

TEST(SphereOfSquare, FoldsEachSideInItsMiddle)
{
    EXPECT_LT((sphereOfSquare({0.5, 0.5}) - Vec3(0, 0, 1)).norm(), 1e-15);
    EXPECT_LT((sphereOfSquare({0.5, 0}) - Vec3(0, -1, 0)).norm(), 1e-15);
    EXPECT_LT((sphereOfSquare({1, 0.5}) - Vec3(1, 0, 0)).norm(), 1e-15);
    EXPECT_LT((sphereOfSquare({0.5, 1}) - Vec3(0, 1, 0)).norm(), 1e-15);
    EXPECT_LT((sphereOfSquare({0, 0.5}) - Vec3(-1, 0, 0)).norm(), 1e-15);
    for (double s : {0.0, 1.0})
        for (double t : {0.0, 1.0}) EXPECT_LT((sphereOfSquare({s, t}) - Vec3(0, 0, -1)).norm(), 1e-15);
    for (double along : {0.03, 0.2, 0.37, 0.499})
        for (double side : {0.0, 1.0}) {
            EXPECT_LT((sphereOfSquare({along, side}) - sphereOfSquare({1 - along, side})).norm(), 1e-14);
            EXPECT_LT((sphereOfSquare({side, along}) - sphereOfSquare({side, 1 - along})).norm(), 1e-14);
        }
    // On the real axis, the integral of 1 / sqrt(1 - r^4) is s: a third of the way to the middle.
    const double radius =
        sphereOfSquare({0.5 + 1.0 / 6, 0.5}).x() / (1 + sphereOfSquare({0.5 + 1.0 / 6, 0.5}).z());
    double integral = 0, whole = 0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
        const double r = radius * (i + 0.5) / kSteps, angle = std::numbers::pi / 2 * (i + 0.5) / kSteps;
        integral += radius / kSteps / std::sqrt(1 - r * r * r * r);
        whole += std::numbers::pi / 2 / kSteps / std::sqrt(1 + std::sin(angle) * std::sin(angle));
    }
    EXPECT_NEAR(integral / whole, 1.0 / 3, 1e-8);
}

TEST(SphereOfSquare, IsConformalWithTheDensityStated)
{
    constexpr double kStep = 1e-6;
    for (const Vec2& p : {Vec2(0.5, 0.5), Vec2(0.3, 0.4), Vec2(0.1, 0.07), Vec2(0.9, 0.2), Vec2(0.25, 0.25),
                          Vec2(0.4, 0.93), Vec2(0.8, 0.75)}) {
        const Vec3 ds =
            (sphereOfSquare(p + Vec2(kStep, 0)) - sphereOfSquare(p - Vec2(kStep, 0))) / (2 * kStep);
        const Vec3 dt =
            (sphereOfSquare(p + Vec2(0, kStep)) - sphereOfSquare(p - Vec2(0, kStep))) / (2 * kStep);
        EXPECT_NEAR(ds.norm() / dt.norm(), 1, 1e-8);
        EXPECT_NEAR(ds.normalized().dot(dt.normalized()), 0, 1e-8);
        EXPECT_GT(ds.cross(dt).dot(sphereOfSquare(p)), 0); // seen from outside
        EXPECT_NEAR(squareDensity(sphereOfSquare(p)) * ds.cross(dt).norm(), 1, 1e-6);
    }
    EXPECT_GT(squareDensity({1, 0, 0}), 1e12);
}

TEST(ConformalSquare, KeepsAnglesAndSeam)
{
    const Result<ConformalSquare> square = ConformalSquare::of(lump(40));
    ASSERT_TRUE(square.ok()) << square.error().message;
    const auto errorAt = [&](int n) {
        const Result<FloatImage> image = square->geometry(n);
        EXPECT_TRUE(image.ok());
        const auto sample = [&](int i, int j) {
            return &image->samples[3 * (static_cast<size_t>(j) * n + i)];
        };
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < 3; ++k) {
                EXPECT_EQ(sample(i, 0)[k], sample(n - 1 - i, 0)[k]);
                EXPECT_EQ(sample(n - 1, i)[k], sample(n - 1, n - 1 - i)[k]);
            }
        return angles(*image).medianAngleError;
    };
    const double coarse = errorAt(33), fine = errorAt(65);
    EXPECT_LT(coarse, 3.5);
    EXPECT_LT(fine, 2);
    EXPECT_LT(fine, coarse / 1.5);
    for (int n : {3, 34, 8193}) EXPECT_EQ(square->geometry(n).error().kind, ErrorKind::BadArgument);
    const Result<FloatImage> normals = square->normals(33);
    ASSERT_TRUE(normals.ok());
    for (size_t i = 0; i < normals->samples.size(); i += 3)
        EXPECT_NEAR(Vec3(normals->samples[i], normals->samples[i + 1], normals->samples[i + 2]).norm(), 1,
                    1e-6);
}

TEST(PlacementOnSquare, LowersTheStretchOfTheSamples)
{
    // A bulge where the square samples least, in its centre, and where it samples most.
    const Mesh mesh = lump(24);
    const Result<SphereMap> map = sphereMap(mesh);
    ASSERT_TRUE(map.ok());
    const std::vector<double> area = vertexMasses(mesh), onSphere = vertexMasses({map->position, mesh.faces});
    const auto stretch = [&](const Moebius& placed) {
        std::vector<Vec3> moved;
        for (const Vec3& p : map->position) moved.push_back(placed(p));
        const std::vector<double> after = vertexMasses({moved, mesh.faces});
        double sum = 0;
        for (size_t v = 0; v < area.size(); ++v)
            sum += area[v] * area[v] / (after[v] * squareDensity(moved[v]));
        return sum;
    };
    const double placed = stretch(placementOnSquare(mesh, map->position));
    EXPECT_LT(placed, 0.95 * stretch(Moebius()));
    for (int k = 0; k < 3; ++k)
        EXPECT_LE(placed, stretch(Moebius::rotating(
                              Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::Unit(k)).toRotationMatrix())));
}

TEST(ConformalImage, DecodesClosedAndKeepsAngles)
{
    EncodeOptions options;
    options.param = MapKind::Conformal;
    options.grid = 129;
    options.target = EncodeTarget::RawFloat;
    options.fit = false;
    const Mesh mesh = lump(40);
    const Result<EncodedMesh> encoded = encodeMesh(mesh, options);
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    EXPECT_EQ(encoded->param, MapKind::Conformal);
    EXPECT_EQ(encoded->layout, SquareLayout::Octahedral);
    EXPECT_EQ(encoded->cutPaths, 4);
    EXPECT_GT(encoded->psnr, 65);
    EXPECT_GT(encoded->stretchEfficiency, 0.5);
    EXPECT_LT(encoded->stretchEfficiency, 1);
    const Result<DecodedImages> images = decodeImages(encoded->file);
    ASSERT_TRUE(images.ok());
    EXPECT_LT(angles(images->geometry).medianAngleError, 1.5);
    for (unsigned level = 0; level < images->info.levels; ++level) {
        const Result<Mesh> decoded = levelMesh(encoded->file, *images, level);
        ASSERT_TRUE(decoded.ok());
        const Topology type = topology(*decoded);
        EXPECT_EQ(type.boundaries, 0);
        EXPECT_EQ(type.genus, 0);
    }
    // Lossy, fitted and slid: angles suffer a little.
    options.target = EncodeTarget::Bytes;
    options.bytes = 3000;
    options.fit = true;
    const Result<EncodedMesh> small = encodeMesh(mesh, options);
    ASSERT_TRUE(small.ok()) << small.error().message;
    EXPECT_LE(small->file.size(), 3000u);
    EXPECT_GT(small->psnr, 60);
}

TEST(ConformalImage, RefusesWhatItIsNotFor)
{
    EncodeOptions options;
    options.param = MapKind::Conformal;
    options.grid = 33;
    EXPECT_EQ(encodeMesh(shapes::surfaceOfGenus(2, 0, 4), options).error().kind, ErrorKind::WrongGenus);
    EXPECT_EQ(encodeMesh(shapes::disk(1, 4), options).error().kind, ErrorKind::NotClosed);
    options.layout = SquareLayout::Cut;
    EXPECT_EQ(encodeMesh(shapes::sphere(1, 4), options).error().kind, ErrorKind::BadArgument);
    options.layout = SquareLayout::Auto;
    options.grid = 40;
    EXPECT_EQ(encodeMesh(shapes::sphere(1, 4), options).error().kind, ErrorKind::BadArgument);
    options.grid = 33;
    options.lowest = 3;
    EXPECT_EQ(encodeMesh(shapes::sphere(1, 4), options).error().kind, ErrorKind::BadArgument);
}

} // namespace
} // namespace gimg

#include "gimg/fit.h"

#include "block_system.h"
#include "gimg/decode.h"
#include "glued_grid.h"
#include "grid_images.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace gimg {
namespace {

using test::openSeam;
using test::sampleAt;
using test::sampled;

/// Opposite sides of the square are glued.
GridSeam torusSeam(int lowest)
{
    const auto side = static_cast<uint32_t>(lowest - 1);
    return {lowest,
            0,
            {{0, side, GIM_SIDE_FIRST},
             {1, side, GIM_SIDE_FIRST},
             {0, side, GIM_SIDE_MATE},
             {1, side, GIM_SIDE_MATE}}};
}

// Radii 3 and 1; the last row and column repeat the first to the bit.
Vec3 onTorus(double s, double t)
{
    const double u = 2 * std::numbers::pi * (s - std::floor(s)),
                 v = 2 * std::numbers::pi * (t - std::floor(t));
    return {(3 + std::cos(v)) * std::cos(u), (3 + std::cos(v)) * std::sin(u), std::sin(v)};
}

Vec3 onCap(double s, double t)
{
    const double x = s - 0.5, y = t - 0.5;
    return {x, y, std::sqrt(4 - x * x - y * y)};
}

// Two planes at right angles. Their edge, s = 0.4, lies between samples.
Vec3 onRoof(double s, double t) { return {s, t, std::min(s - 0.4, 0.4 - s)}; }

double psnr(const Mesh& mesh, const FloatImage& image)
{
    return compareSurfaces(mesh, gridMesh(image))->psnr();
}

// Linear interpolation of z = k (x^2 + y^2) / 2 over right triangles of legs h leaves an error of mean k h^2
// / 6 and variance k^2 h^4 / 360. Samples raised by the mean gain 10 log10(11) = 10.4 dB, less at the fixed
// border.
TEST(Fit, TakesTheMeanErrorOfASphericalCapAway)
{
    const Mesh cap = gridMesh(sampled(onCap, 257));
    const FloatImage image = sampled(onCap, 65);
    const Result<FittedGeometry> fit = fitGeometry(cap, image, openSeam(9));
    ASSERT_TRUE(fit.ok()) << fit.error().message;
    EXPECT_GT(fit->psnrAfter, fit->psnrBefore + 9);
    double raised = 0;
    for (int j = 24; j <= 40; ++j)
        for (int i = 24; i <= 40; ++i) raised += (sampleAt(fit->image, i, j).norm() - 2) / (17 * 17);
    EXPECT_NEAR(raised / (0.5 / (64 * 64) / 6), 1, 0.1);
    EXPECT_NEAR(fit->psnrBefore, psnr(cap, image), 1e-6);
    EXPECT_NEAR(fit->psnrAfter, psnr(cap, fit->image), 1e-6);
    for (int k = 0; k < 65; ++k)
        for (const auto& [i, j] : {std::pair(k, 0), {k, 64}, {0, k}, {64, k}})
            EXPECT_EQ(sampleAt(fit->image, i, j), sampleAt(image, i, j));
}

TEST(Fit, KeepsGluedSamplesEqualAndCellsUnfolded)
{
    const Mesh torus = shapes::torus(3, 1, 200, 100);
    const FloatImage image = sampled(onTorus, 65);
    const Result<FittedGeometry> fit = fitGeometry(torus, image, torusSeam(9));
    ASSERT_TRUE(fit.ok()) << fit.error().message;
    EXPECT_GT(fit->psnrAfter, fit->psnrBefore + 5);
    for (int k = 0; k < 65; ++k) {
        EXPECT_EQ(sampleAt(fit->image, k, 0), sampleAt(fit->image, k, 64));
        EXPECT_EQ(sampleAt(fit->image, 0, k), sampleAt(fit->image, 64, k));
        EXPECT_NE(sampleAt(fit->image, k, 0), sampleAt(image, k, 0));
    }
    const Mesh grid = gridMesh(fit->image);
    for (const Triangle& t : grid.faces) {
        const Vec3 &a = grid.positions[t[0]], &b = grid.positions[t[1]], &c = grid.positions[t[2]];
        const Vec3 middle = (a + b + c) / 3, axis = 3 * Vec3(middle.x(), middle.y(), 0).normalized();
        EXPECT_GT((b - a).cross(c - a).normalized().dot((middle - axis).normalized()), 0.99);
    }
}

TEST(Fit, BringsSamplesToAnEdge)
{
    const Mesh roof = gridMesh(sampled(onRoof, 81)); // with vertices on the edge
    const FloatImage image = sampled(onRoof, 33);
    const Result<FittedGeometry> fit = fitGeometry(roof, image, openSeam(9), {.smoothing = 0});
    ASSERT_TRUE(fit.ok()) << fit.error().message;
    EXPECT_GT(fit->psnrAfter, fit->psnrBefore + 10);
    // In every row but those at the boundary a sample comes to lie on it.
    for (int j = 2; j < 31; ++j) {
        double nearest = 1;
        for (int i = 0; i < 33; ++i)
            nearest = std::min(nearest,
                               (Vec2(0.4, 0) - Vec2(fit->image.at(i, j, 0), fit->image.at(i, j, 2))).norm());
        EXPECT_LT(nearest, 0.1 / 32) << j;
    }
}

TEST(Fit, LeavesWhatIsRightAsItIs)
{
    const auto plane = [](double s, double t) { return Vec3(s, t, 0.5 * s); };
    const FloatImage image = sampled(plane, 33);
    const Result<FittedGeometry> fit = fitGeometry(gridMesh(sampled(plane, 3)), image, openSeam(9));
    ASSERT_TRUE(fit.ok()) << fit.error().message;
    EXPECT_EQ(fit->psnrBefore, std::numeric_limits<double>::infinity());
    EXPECT_EQ(fit->image.samples, image.samples);
}

TEST(Fit, DoesNotDependOnThreadsOrPlace)
{
    const Mesh torus = shapes::torus(3, 1, 60, 30);
    const FloatImage image = sampled(onTorus, 33);
    const Result<FittedGeometry> one = fitGeometry(torus, image, torusSeam(9), {.rounds = 1, .threads = 1});
    const Result<FittedGeometry> two = fitGeometry(torus, image, torusSeam(9), {.rounds = 1, .threads = 2});
    ASSERT_TRUE(one.ok() && two.ok());
    EXPECT_EQ(one->image.samples, two->image.samples);
    EXPECT_EQ(one->psnrAfter, two->psnrAfter);

    Mesh large = torus;
    for (Vec3& p : large.positions) p = 1024 * p;
    FloatImage largeImage = image;
    for (float& x : largeImage.samples) x *= 1024;
    const Result<FittedGeometry> scaled = fitGeometry(large, largeImage, torusSeam(9), {.rounds = 1});
    ASSERT_TRUE(scaled.ok());
    for (size_t k = 0; k < image.samples.size(); ++k)
        EXPECT_EQ(scaled->image.samples[k], 1024 * one->image.samples[k]);
}

TEST(Fit, RefusesBadArguments)
{
    const Mesh torus = shapes::torus(3, 1, 12, 6);
    const FloatImage image = sampled(onTorus, 17);
    const auto kind = [&](const Mesh& mesh, const FloatImage& samples, const GridSeam& seam,
                          const FitOptions& options = {}) {
        const Result<FittedGeometry> fit = fitGeometry(mesh, samples, seam, options);
        EXPECT_FALSE(fit.ok());
        return fit.ok() ? ErrorKind::CodecFailure : fit.error().kind;
    };
    const GridSeam seam = torusSeam(9);
    EXPECT_EQ(kind(torus, image, seam, {.rounds = 0}), ErrorKind::BadArgument);
    EXPECT_EQ(kind(torus, image, seam, {.rounds = 101}), ErrorKind::BadArgument);
    EXPECT_EQ(kind(torus, image, seam, {.smoothing = -0.1}), ErrorKind::BadArgument);
    EXPECT_EQ(kind(torus, image, seam, {.smoothing = std::nan("")}), ErrorKind::BadArgument);
    EXPECT_EQ(kind(torus, image, seam, {.threads = -1}), ErrorKind::BadArgument);
    EXPECT_EQ(kind(torus, image, torusSeam(33)), ErrorKind::BadArgument);
    EXPECT_EQ(kind(torus, image, {9, 0, {{0, 31, GIM_SIDE_BOUNDARY}}}), ErrorKind::BadArgument);
    EXPECT_EQ(kind(torus, image, {-9, 0, {}}), ErrorKind::BadArgument);
    EXPECT_EQ(kind(torus, {}, seam), ErrorKind::BadArgument);
    EXPECT_EQ(kind(torus, sampled(onTorus, 18), seam), ErrorKind::BadArgument);
    EXPECT_EQ(kind({}, image, seam), ErrorKind::EmptyMesh);

    FloatImage bad = image;
    bad.samples.pop_back();
    EXPECT_EQ(kind(torus, bad, seam), ErrorKind::BadArgument);
    bad = image;
    bad.samples[100] = std::nanf("");
    EXPECT_EQ(kind(torus, bad, seam), ErrorKind::NotFinite);
    bad = image;
    bad.samples[3 * 5] += 1e-3f; // (5, 0) is glued to (5, 16)
    EXPECT_EQ(kind(torus, bad, seam), ErrorKind::BadArgument);
}

TEST(FitNormals, FollowTheSamples)
{
    const Mesh torus = shapes::torus(3, 1, 200, 100);
    const auto normalAt = [](const Vec3& p) {
        const Vec3 axis = 3 * Vec3(p.x(), p.y(), 0).normalized();
        return Vec3((p - axis).normalized());
    };
    // Samples a tenth of a turn further around the tube than their normals.
    const auto shifted = [](double s, double t) { return onTorus(s, t + 0.1); };
    const FloatImage geometry = sampled(shifted, 65);
    const FloatImage normals = sampled([&](double s, double t) { return normalAt(onTorus(s, t)); }, 129);
    const Result<FloatImage> fitted = fitNormals(torus, geometry, torusSeam(9), normals);
    ASSERT_TRUE(fitted.ok()) << fitted.error().message;
    for (int j = 0; j < 129; ++j)
        for (int i = 0; i < 129; ++i) {
            const Vec3 expected = normalAt(shifted(i / 128.0, j / 128.0));
            EXPECT_LT((sampleAt(*fitted, i, j) - expected).norm(), 0.02);
        }
    for (int k = 0; k < 129; ++k) EXPECT_EQ(sampleAt(*fitted, k, 0), sampleAt(*fitted, k, 128));

    // Those of a surface that faces the other way stay.
    FloatImage inwards = normals;
    for (float& x : inwards.samples) x = -x;
    EXPECT_EQ(fitNormals(torus, geometry, torusSeam(9), inwards)->samples, inwards.samples);
}

TEST(GluedGrid, LinesRunOnAcrossTheSeam)
{
    const Result<GluedGrid> grid = GluedGrid::of(torusSeam(5), 9);
    ASSERT_TRUE(grid.ok());
    EXPECT_EQ(grid->vertexCount(), 64);
    const auto vertex = [&](int i, int j) { return grid->vertexOf(9 * j + i); };
    for (int v = 0; v < grid->vertexCount(); ++v) {
        EXPECT_FALSE(grid->onBoundary(v));
        const int i = grid->sampleOf(v) % 9, j = grid->sampleOf(v) / 9;
        if (i == 0 && j == 0) { // the cut-node
            EXPECT_EQ(grid->around(v)[0], GluedGrid::kNone);
            continue;
        }
        EXPECT_THAT(grid->around(v),
                    testing::UnorderedElementsAre(vertex((i + 1) % 8, j), vertex((i + 7) % 8, j),
                                                  vertex(i, (j + 1) % 8), vertex(i, (j + 7) % 8)));
    }
    const Result<GluedGrid> open = GluedGrid::of(openSeam(5), 9);
    for (int v = 0; v < 81; ++v) EXPECT_EQ(open->onBoundary(v), v % 9 == 0 || v % 9 == 8 || v < 9 || v >= 72);
}

TEST(BlockSystem, SolvesWhatADenseSolverDoes)
{
    const std::vector<Triangle> faces = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}, {2, 3, 4}};
    const std::vector<bool> fixed = {false, false, false, true, false};
    Eigen::MatrixXd dense = Eigen::MatrixXd::Identity(15, 15);
    Eigen::VectorXd right = Eigen::VectorXd::Constant(15, 0.5);
    std::vector<TriangleEquations> equations(faces.size());
    for (size_t f = 0; f < faces.size(); ++f) {
        const Vec3 n = Vec3(1 + static_cast<double>(f), -2, 0.5).normalized(),
                   gap(0.1, 0.2, -static_cast<double>(f));
        const Vec3 b(0.5, 0.3, 0.2);
        const Eigen::Matrix3d block = n * n.transpose() + 0.1 * Eigen::Matrix3d::Identity();
        for (int k = 0; k < 3; ++k) {
            equations[f].pair[k].add(b[k] * b[k], 1, n, 0.1);
            equations[f].pair[3 + k].add(b[k] * b[(k + 1) % 3], 1, n, 0.1);
            equations[f].right[k] = b[k] * (block * gap);
            right.segment<3>(3 * faces[f][k]) += b[k] * (block * gap);
            for (int l = 0; l < 3; ++l)
                dense.block<3, 3>(3 * faces[f][k], 3 * faces[f][l]) += b[k] * b[l] * block;
        }
    }
    dense.middleRows<3>(9).setZero();
    dense.middleCols<3>(9).setZero();
    dense.block<3, 3>(9, 9).setIdentity();
    right.segment<3>(9).setZero();
    const Eigen::VectorXd expected = dense.ldlt().solve(right);

    const BlockSystem system(faces, equations, std::vector<SymmetricBlock>(5, {1, 0, 0, 1, 0, 1}),
                             std::vector<Vec3>(5, Vec3::Constant(0.5)), fixed);
    const std::vector<Vec3> x = system.solve(1e-9, 100);
    for (int v = 0; v < 5; ++v) EXPECT_LT((x[v] - expected.segment<3>(3 * v)).norm(), 1e-6) << v;
    EXPECT_EQ(x[3], Vec3(0, 0, 0));
}

} // namespace
} // namespace gimg

#include "gimg/features.h"

#include "crease_net.h"
#include "gimg/decode.h"
#include "grid_images.h"
#include "grid_surface.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace gimg {
namespace {

using test::openSeam;
using test::sampleAt;
using test::sampled;

/// The octahedral layout: each side of the square folds onto itself.
GridSeam foldedSeam(int lowest)
{
    GridSeam seam{lowest, 0, {}};
    const auto half = static_cast<uint32_t>((lowest - 1) / 2);
    for (uint32_t path = 0; path < 4; ++path) {
        seam.sides.push_back({path, half, GIM_SIDE_FIRST});
        seam.sides.push_back({path, half, GIM_SIDE_MATE});
    }
    return seam;
}

const Vec3 kSides(1.0, 0.8, 0.6);

/// The box seen from its middle through an octahedron that is turned against it: its edges run across the
/// grid.
Vec3 onBox(double s, double t)
{
    static const Eigen::Matrix3d turn =
        (Eigen::AngleAxisd(0.4, Vec3::UnitZ()) * Eigen::AngleAxisd(0.3, Vec3::UnitX())).toRotationMatrix();
    const double u = 2 * s - 1, v = 2 * t - 1, z = 1 - std::abs(u) - std::abs(v);
    Vec3 p(u, v, z);
    if (z < 0) p = {(1 - std::abs(v)) * (u < 0 ? -1 : 1), (1 - std::abs(u)) * (v < 0 ? -1 : 1), z};
    p = turn * p;
    return p / (2 * p.cwiseQuotient(kSides).cwiseAbs().maxCoeff());
}

/// Two planes at right angles. Their edge runs across the cells.
Vec3 onRoof(double s, double t)
{
    const double x = s - 0.4 - 0.2 * t;
    return {s, t, -std::abs(x)};
}

double nearestSample(const FloatImage& image, const Vec3& p)
{
    double nearest = 1;
    for (int j = 0; j < image.height; ++j)
        for (int i = 0; i < image.width; ++i) nearest = std::min(nearest, (sampleAt(image, i, j) - p).norm());
    return nearest;
}

CreaseNet netOf(const Mesh& mesh, double angle, double shortest)
{
    return CreaseNet(mesh.positions, mesh.faces, angle, shortest);
}

TEST(CreaseNet, FindsTheEdgesAndCornersOfABox)
{
    const CreaseNet net = netOf(shapes::box(kSides, 6), 40, 0);
    EXPECT_EQ(net.segments().size(), 12u * 6);
    EXPECT_EQ(net.chainCount(), 12);
    EXPECT_EQ(net.corners().size(), 8u);
    EXPECT_NEAR(net.length(), 4 * kSides.sum(), 1e-12);
    for (const CreaseNet::Corner& corner : net.corners()) {
        EXPECT_LT((corner.at.cwiseAbs() - kSides / 2).norm(), 1e-12);
        EXPECT_EQ(corner.chains.size(), 3u);
        EXPECT_GT(corner.outwards.normalized().dot(corner.at.normalized()), 0.9);
    }
    for (const CreaseNet::Segment& s : net.segments()) {
        EXPECT_NEAR(s.side.dot(s.outwards), 0, 1e-12);
        EXPECT_NEAR(s.side.dot(s.direction()), 0, 1e-12);
    }
    EXPECT_TRUE(netOf(shapes::box(kSides, 6), 95, 0).segments().empty());
}

TEST(CreaseNet, WalksAlongAChainAndNotAroundItsCorner)
{
    const CreaseNet net = netOf(shapes::box(Vec3::Ones(), 8), 40, 0);
    const CreaseNet::Place start = net.nearest({-0.4, 0.6, 0.6});
    EXPECT_LT((start.point - Vec3(-0.4, 0.5, 0.5)).norm(), 1e-12);
    EXPECT_LT((net.nearestAlong({0.3, 0.6, 0.6}, start.segment).point - Vec3(0.3, 0.5, 0.5)).norm(), 1e-12);
    EXPECT_LT((net.nearestAlong({0.6, 0.1, 0.5}, start.segment).point - Vec3(0.5, 0.5, 0.5)).norm(), 1e-12);
}

TEST(CreaseNet, LeavesShortPiecesOut)
{
    const Mesh roof = gridMesh(sampled([](double s, double t) { return onRoof(s + 0.2 * t, t); }, 21));
    const double length = std::sqrt(1.04);
    EXPECT_NEAR(netOf(roof, 40, 0.9 * length).length(), netOf(roof, 40, 0).length(), 1e-12);
    EXPECT_TRUE(netOf(roof, 40, 1.3 * length).segments().empty());
}

// A box in a grid of 65: chords across its edges miss them by up to half a spacing.
TEST(Features, LayGridLinesAlongTheEdgesOfABox)
{
    const Mesh box = shapes::box(kSides, 4);
    const Result<FittedGeometry> fit = fitGeometry(box, sampled(onBox, 65), foldedSeam(9));
    ASSERT_TRUE(fit.ok()) << fit.error().message;
    const Result<FeatureGeometry> features = followFeatures(box, fit->image, foldedSeam(9), {.rounds = 2});
    ASSERT_TRUE(features.ok()) << features.error().message;
    const FeatureReport& report = features->report;
    EXPECT_TRUE(report.kept);
    EXPECT_NEAR(report.length, 4 * kSides.sum(), 1e-12);
    EXPECT_EQ(report.creases, 12);
    EXPECT_EQ(report.corners, 8);
    EXPECT_EQ(report.onCorners, 8);
    EXPECT_GT(report.onCreases, 200);
    EXPECT_EQ(report.psnrBefore, fit->psnrAfter);
    EXPECT_LT(report.maxAfter, report.maxBefore / 4);
    EXPECT_GT(report.psnrAfter, report.psnrBefore + 10);

    const FloatImage& image = features->image;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 sign(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
        EXPECT_LT(nearestSample(image, sign.cwiseProduct(kSides)), 1e-6);
    }
    const Result<GluedGrid> grid = GluedGrid::of(foldedSeam(9), 65);
    EXPECT_FALSE(objectionToMates(image, *grid).has_value());
    const Mesh surface = meshOf(*grid, image);
    const Result<SurfaceDistance> distance = compareSurfaces(box, surface);
    EXPECT_NEAR(distance->hausdorff(), report.maxAfter, 1e-9);
    for (const Triangle& t : surface.faces) { // none is folded over
        const Vec3 &a = surface.positions[t[0]], &b = surface.positions[t[1]], &c = surface.positions[t[2]];
        EXPECT_GT((b - a).cross(c - a).normalized().dot((a + b + c).normalized()), 0.1);
    }
}

TEST(Features, LeaveASphereAsItIs)
{
    const Mesh sphere = shapes::sphere(1, 12);
    const FloatImage image = sampled([](double s, double t) { return onBox(s, t).normalized(); }, 33);
    const Result<FeatureGeometry> features = followFeatures(sphere, image, foldedSeam(9));
    ASSERT_TRUE(features.ok()) << features.error().message;
    EXPECT_EQ(features->image.samples, image.samples);
    EXPECT_FALSE(features->report.kept);
    EXPECT_EQ(features->report.length, 0);
    EXPECT_EQ(features->report.maxAfter, features->report.maxBefore);
}

TEST(Features, KeepTheBoundaryAndMeetTheEdgeInEveryRow)
{
    const FloatImage image = sampled(onRoof, 33);
    // The mesh has vertices on the edge, which the image has not.
    const Mesh roof =
        gridMesh(sampled([](double s, double t) { return onRoof(s + 0.2 * (t - 0.5), t); }, 81));
    const Result<FeatureGeometry> features = followFeatures(roof, image, openSeam(9), {.rounds = 1});
    ASSERT_TRUE(features.ok()) << features.error().message;
    EXPECT_GT(features->report.onCreases, 30);
    for (int k = 0; k < 33; ++k)
        for (const auto& [i, j] : {std::pair(k, 0), {k, 32}, {0, k}, {32, k}})
            EXPECT_EQ(sampleAt(features->image, i, j), sampleAt(image, i, j));
    for (int j = 2; j < 31; ++j) {
        double nearest = 1;
        for (int i = 0; i < 33; ++i) {
            const Vec3 p = sampleAt(features->image, i, j);
            nearest = std::min(nearest, std::max(std::abs(p.x() - 0.4 - 0.2 * p.y()), std::abs(p.z())));
        }
        EXPECT_LT(nearest, 1e-3 / 32) << j;
    }
}

TEST(Features, DoNotDependOnThreadsOrUnit)
{
    const Mesh box = shapes::box(kSides, 3);
    const FloatImage image = sampled(onBox, 33);
    const FeatureOptions options{.rounds = 1};
    const Result<FeatureGeometry> one =
        followFeatures(box, image, foldedSeam(9), {.rounds = 1, .threads = 1});
    const Result<FeatureGeometry> two =
        followFeatures(box, image, foldedSeam(9), {.rounds = 1, .threads = 2});
    ASSERT_TRUE(one.ok() && two.ok());
    EXPECT_TRUE(one->report.kept);
    EXPECT_EQ(one->image.samples, two->image.samples);
    EXPECT_EQ(one->report.maxAfter, two->report.maxAfter);

    Mesh large = box;
    for (Vec3& p : large.positions) p *= 1024;
    FloatImage largeImage = image;
    for (float& x : largeImage.samples) x *= 1024;
    const Result<FeatureGeometry> scaled = followFeatures(large, largeImage, foldedSeam(9), options);
    ASSERT_TRUE(scaled.ok());
    EXPECT_NEAR(scaled->report.length, 1024 * one->report.length, 1e-9);
    for (size_t k = 0; k < image.samples.size(); ++k)
        EXPECT_EQ(scaled->image.samples[k], 1024 * one->image.samples[k]);
}

TEST(Features, RefuseBadArguments)
{
    const Mesh box = shapes::box(kSides, 2);
    const FloatImage image = sampled(onBox, 17);
    const auto kind = [&](const Mesh& mesh, const FloatImage& samples, const GridSeam& seam,
                          const FeatureOptions& options = {}) {
        const Result<FeatureGeometry> features = followFeatures(mesh, samples, seam, options);
        EXPECT_FALSE(features.ok());
        return features.ok() ? ErrorKind::CodecFailure : features.error().kind;
    };
    const GridSeam seam = foldedSeam(9);
    EXPECT_EQ(kind(box, image, seam, {.angle = 0}), ErrorKind::BadArgument);
    EXPECT_EQ(kind(box, image, seam, {.angle = 180}), ErrorKind::BadArgument);
    EXPECT_EQ(kind(box, image, seam, {.shortest = -1}), ErrorKind::BadArgument);
    EXPECT_EQ(kind(box, image, seam, {.rounds = 0}), ErrorKind::BadArgument);
    EXPECT_EQ(kind(box, image, seam, {.smoothing = 2}), ErrorKind::BadArgument);
    EXPECT_EQ(kind(box, image, seam, {.threads = -1}), ErrorKind::BadArgument);
    EXPECT_EQ(kind(box, image, foldedSeam(33)), ErrorKind::BadArgument);
    EXPECT_EQ(kind({}, image, seam), ErrorKind::EmptyMesh);
    FloatImage bad = image;
    bad.samples[3 * 2] += 1e-3f; // (2, 0) is glued to (14, 0)
    EXPECT_EQ(kind(box, bad, seam), ErrorKind::BadArgument);
    bad = image;
    bad.samples[100] = INFINITY;
    EXPECT_EQ(kind(box, bad, seam), ErrorKind::NotFinite);
}

} // namespace
} // namespace gimg

#include "gimg/extrema.h"
#include "gimg/sample.h"
#include "gimg/stretch.h"
#include "gimg/unfold.h"

#include "border_ties.h"
#include "lifts.h"
#include "manifold_check.h"
#include "shapes.h"
#include "stretch_element.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace gimg {
namespace {

SquareLayout kOctahedral = SquareLayout::Octahedral;

// A ball with a dent and a bulge, so that nothing is symmetric.
Mesh lump(int n)
{
    Mesh mesh = shapes::sphere(1, n);
    for (Vec3& p : mesh.positions)
        p *= 1 + 0.5 * std::exp(-4 * (p - Vec3(0.6, 0, 0.8)).squaredNorm()) -
             0.3 * std::exp(-4 * (p - Vec3(0, -1, 0)).squaredNorm());
    return mesh;
}

Unfolded unfoldedLump(int n)
{
    Result<Unfolded> unfolded = unfold(lump(n), {33, 0, kOctahedral});
    EXPECT_TRUE(unfolded.ok()) << unfolded.error().message;
    return std::move(*unfolded);
}

TEST(GridMotion, ComposesAndInverts)
{
    const GridMotion a{1, Vec2(0.25, -0.5)}, b{3, Vec2(1, 0.125)};
    const Vec2 p(0.3, 0.7);
    EXPECT_EQ(a(p), Vec2(-0.7 + 0.25, 0.3 - 0.5));
    EXPECT_LT(((a * b)(p)-a(b(p))).norm(), 1e-15);
    EXPECT_TRUE(a * a.inverse() == GridMotion{});
    EXPECT_TRUE(b.inverse() * b == GridMotion{});
}

TEST(BorderTies, OnlyTipsOfAStarStay)
{
    const Unfolded unfolded = unfoldedLump(12);
    const BorderTies ties = borderTies(unfolded.square);
    int fixed = 0;
    for (size_t v = 0; v < ties.leader.size(); ++v) {
        if (ties.leader[v] != static_cast<int>(v)) continue;
        EXPECT_EQ(ties.free[v][0], ties.free[v][1]);
        if (ties.free[v][0]) continue;
        ++fixed;
        // The middle of a side of the square.
        const Vec2 p = unfolded.square.borderPosition[v];
        EXPECT_DOUBLE_EQ((p - Vec2(0.5, 0.5)).norm(), 0.5);
    }
    EXPECT_EQ(fixed, 4);
}

TEST(BorderTies, VerticesOfABoundarySlideAlongTheirSide)
{
    const Mesh mesh = shapes::disk(1, 12);
    const Result<SquareDisk> square = layOutBorder(mesh, cutToDisk(mesh), {});
    ASSERT_TRUE(square.ok());
    const BorderTies ties = borderTies(*square);
    int corners = 0, sliding = 0;
    for (size_t v = 0; v < ties.leader.size(); ++v) {
        if (square->squareSides[v] == 0) continue;
        const Vec2 p = square->borderPosition[v];
        if (!ties.free[v][0] && !ties.free[v][1]) {
            ++corners;
            continue;
        }
        ++sliding;
        EXPECT_EQ(ties.free[v][0], p.y() == 0 || p.y() == 1);
        EXPECT_EQ(ties.free[v][1], p.x() == 0 || p.x() == 1);
    }
    EXPECT_GE(corners, 4);
    EXPECT_LE(corners, 5); // one more where the loop begins
    EXPECT_EQ(corners + sliding, square->disk.borderLength());
}

TEST(Octahedral, SidesFoldOntoThemselves)
{
    const Unfolded unfolded = unfoldedLump(12);
    EXPECT_EQ(unfolded.layout, kOctahedral);
    const SquareDisk& square = unfolded.square;
    const std::vector<gim_side> seam = square.seam();
    ASSERT_EQ(seam.size(), 8u);
    for (const gim_side& side : seam) EXPECT_EQ(2 * side.length, static_cast<uint32_t>(square.lowest - 1));
    const Result<FloatImage> image = sampleGeometry(square, unfolded.map, 33);
    ASSERT_TRUE(image.ok()) << image.error().message;
    for (int i = 0; i < 33; ++i)
        for (int c = 0; c < 3; ++c) {
            EXPECT_EQ(image->at(i, 0, c), image->at(32 - i, 0, c));
            EXPECT_EQ(image->at(i, 32, c), image->at(32 - i, 32, c));
            EXPECT_EQ(image->at(0, i, c), image->at(0, 32 - i, c));
            EXPECT_EQ(image->at(32, i, c), image->at(32, 32 - i, c));
        }
}

TEST(Octahedral, SpreadsSamplesOfALumpEvenly)
{
    const Unfolded octahedral = unfoldedLump(20);
    const Result<Unfolded> cut = unfold(lump(20), {33, 0, SquareLayout::Cut});
    ASSERT_TRUE(cut.ok());
    EXPECT_GT(octahedral.map.efficiency, 0.85);
    EXPECT_GT(octahedral.map.efficiency, cut->map.efficiency);
    EXPECT_EQ(flippedTriangles(octahedral.square.disk.mesh.faces, octahedral.map.st), 0);
    const Result<Unfolded> chosen = unfold(lump(20), {33, 0, SquareLayout::Auto});
    ASSERT_TRUE(chosen.ok());
    EXPECT_EQ(chosen->layout, kOctahedral);
    EXPECT_EQ(chosen->map.st, octahedral.map.st);
}

// Over every point of the square's border a triangle ends, and the one over the mate goes on at the same
// place of the surface.
TEST(Lifts, GoOnAcrossTheSeam)
{
    const Unfolded unfolded = unfoldedLump(12);
    const SquareDisk& square = unfolded.square;
    const BorderTies ties = borderTies(square);
    const Result<std::vector<Lift>> lifts = liftsOverSquare(square, ties, unfolded.map.st);
    ASSERT_TRUE(lifts.ok()) << lifts.error().message;
    EXPECT_GT(lifts->size(), square.disk.mesh.faces.size()); // some lie across the seam
    const auto surfaceAt = [&](const Vec2& p) {
        double deepest = -1;
        Vec3 at = Vec3::Constant(1e30);
        for (const Lift& lift : *lifts) {
            const Triangle& f = square.disk.mesh.faces[lift.face];
            std::array<Vec2, 3> c;
            for (int k = 0; k < 3; ++k) c[k] = lift.motion(unfolded.map.st[f[k]]);
            Vec3 weight;
            for (int k = 0; k < 3; ++k) weight[k] = doubleArea({p, c[(k + 1) % 3], c[(k + 2) % 3]});
            weight /= doubleArea(c);
            if (weight.minCoeff() < deepest) continue;
            deepest = weight.minCoeff();
            at = weight[0] * square.disk.mesh.positions[f[0]] + weight[1] * square.disk.mesh.positions[f[1]] +
                 weight[2] * square.disk.mesh.positions[f[2]];
        }
        EXPECT_GT(deepest, -1e-9);
        return at;
    };
    for (double u : {0.03, 0.2, 0.41}) {
        EXPECT_LT((surfaceAt({u, 0}) - surfaceAt({1 - u, 0})).norm(), 1e-9);
        EXPECT_LT((surfaceAt({1, u}) - surfaceAt({1, 1 - u})).norm(), 1e-9);
        EXPECT_LT((surfaceAt({u, 1}) - surfaceAt({1 - u, 1})).norm(), 1e-9);
        EXPECT_LT((surfaceAt({0, u}) - surfaceAt({0, 1 - u})).norm(), 1e-9);
    }
}

TEST(Lifts, ATorusSlidesFreely)
{
    // A flat torus would score 1; this one is 2 : 1 wide, and the seam of a fixed border costs more.
    const Mesh mesh = shapes::torus(1, 0.5, 48, 24);
    const Result<Unfolded> unfolded = unfold(mesh, {65, 0});
    ASSERT_TRUE(unfolded.ok());
    const Result<FloatImage> image = sampleGeometry(unfolded->square, unfolded->map, 65);
    ASSERT_TRUE(image.ok()) << image.error().message;
    for (size_t k = 0; k < image->samples.size(); k += 3) {
        const double x = image->samples[k], y = image->samples[k + 1], z = image->samples[k + 2];
        EXPECT_NEAR(std::hypot(std::hypot(x, y) - 1, z), 0.5, 0.01);
    }
    EXPECT_GT(unfolded->map.efficiency, 0.6);
}

TEST(Lifts, AMapThatMissesTheSquareIsAnError)
{
    Unfolded unfolded = unfoldedLump(8);
    const BorderTies ties = borderTies(unfolded.square);
    for (Vec2& p : unfolded.map.st) p = 0.5 * p + Vec2(0.1, 0.2);
    const Result<std::vector<Lift>> lifts = liftsOverSquare(unfolded.square, ties, unfolded.map.st);
    ASSERT_FALSE(lifts.ok());
    EXPECT_EQ(lifts.error().kind, ErrorKind::FlippedTriangle);
}

TEST(StarCut, OpensASphereToADiskWithFourTips)
{
    const Mesh mesh = lump(10);
    const std::vector<int> tips = findStarTips(simplify(mesh, 100000)).vertices;
    ASSERT_EQ(tips.size(), 4u);
    const CutGraph star = starCut(mesh, tips);
    ASSERT_EQ(star.paths.size(), 4u);
    std::map<int, int> valence;
    for (const CutPath& path : star.paths) ++valence[path.vertices.front()], ++valence[path.vertices.back()];
    for (int tip : tips) EXPECT_EQ(valence.at(tip), 1);
    const Result<DiskMesh> disk = openAlong(mesh, star);
    ASSERT_TRUE(disk.ok());
    const test::ManifoldCheck check = test::checkManifold(disk->mesh.faces);
    EXPECT_EQ(check.fault, "");
    EXPECT_EQ(check.genus, 0);
    EXPECT_EQ(check.boundaries, 1);
}

TEST(Octahedral, IsRefusedForOtherTopologies)
{
    for (const Mesh& mesh : {shapes::torus(1, 0.4, 16, 12), shapes::disk(1, 6)}) {
        const Result<Unfolded> unfolded = unfold(mesh, {33, 0, kOctahedral});
        ASSERT_FALSE(unfolded.ok());
        EXPECT_EQ(unfolded.error().kind, ErrorKind::BadArgument);
    }
    const Mesh ball = shapes::sphere(1, 6);
    const Result<SquareDisk> noStar = layOutBorder(ball, cutToDisk(ball), {33, 0, kOctahedral});
    ASSERT_FALSE(noStar.ok());
    EXPECT_EQ(noStar.error().kind, ErrorKind::TargetUnreachable);
}

} // namespace
} // namespace gimg

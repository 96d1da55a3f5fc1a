#include "gimg/extrema.h"

#include "gimg/cut.h"
#include "gimg/disk.h"
#include "gimg/unfold.h"
#include "manifold_check.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace gimg {
namespace {

// A ball with six arms, along the axes.
Mesh jack(int n)
{
    Mesh mesh = shapes::sphere(1, n);
    for (Vec3& p : mesh.positions) p *= 1 + 4 * std::pow(p.cwiseAbs().maxCoeff(), 24);
    return mesh;
}

std::set<int> verticesOf(const CutGraph& cut)
{
    std::set<int> vertices;
    for (const CutPath& path : cut.paths) vertices.insert(path.vertices.begin(), path.vertices.end());
    return vertices;
}

TEST(Extrema, TheFarEndOfALongBodyIsFoundAndWorthIt)
{
    Mesh body = shapes::sphere(1, 24);
    for (Vec3& p : body.positions) p[2] *= 6;
    const Extrema extrema = findExtrema(body);
    ASSERT_GE(extrema.vertices.size(), 1u);
    // The initial cut is at one end, the first extremum at the other.
    const double start = body.positions[cutToDisk(body).paths[0].vertices[1]][2];
    const double end = body.positions[extrema.vertices[0]][2];
    EXPECT_GT(std::abs(start), 5);
    EXPECT_GT(std::abs(end), 5);
    EXPECT_LT(start * end, 0);
    EXPECT_LT(extrema.energyWith, 0.2 * extrema.energyWithout);
}

TEST(Extrema, ArmsOfAJackAreReachedAsFarAsItPays)
{
    const Mesh mesh = jack(24);
    const Extrema extrema = findExtrema(mesh);
    const std::set<int> cut = verticesOf(cutToDisk(mesh, extrema.vertices));
    int reached = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (double sign : {-1.0, 1.0})
            reached += std::any_of(cut.begin(), cut.end(), [&](int v) { return sign * mesh.positions[v][axis] > 4.5; });
    EXPECT_GE(reached, 4);
    EXPECT_LT(extrema.energyWith, 0.5 * extrema.energyWithout);
}

TEST(Extrema, AFlatDiskHasNone) { EXPECT_TRUE(findExtrema(shapes::disk(1, 24)).vertices.empty()); }

TEST(Extrema, AnExtendedCutStillOpensToADisk)
{
    for (const auto& [genus, loops] : {std::pair(0, 0), {0, 2}, {1, 0}, {3, 1}}) {
        const Mesh mesh = shapes::surfaceOfGenus(genus, loops, 8);
        // Any vertices will do, on the cut, on the boundary, or given twice.
        const int n = mesh.vertexCount();
        const std::vector<int> vertices = {0,     n / 3, n / 2,
                                           n / 3, n - 1, cutToDisk(mesh).paths[0].vertices[0]};
        const CutGraph cut = cutToDisk(mesh, vertices);
        const std::set<int> passed = verticesOf(cut);
        for (int v : vertices) EXPECT_TRUE(passed.count(v)) << v;
        const Result<DiskMesh> disk = openAlong(mesh, cut);
        ASSERT_TRUE(disk.ok()) << disk.error().message;
        const test::ManifoldCheck check = test::checkManifold(disk->mesh.faces);
        EXPECT_EQ(check.fault, "");
        EXPECT_EQ(check.genus, 0);
        EXPECT_EQ(check.boundaries, 1);
    }
}

TEST(Unfold, ReachingTheArmsEvensTheSamplesOut)
{
    const Mesh mesh = jack(16);
    const Result<Unfolded> unfolded = unfold(mesh, {129, 0});
    ASSERT_TRUE(unfolded.ok()) << unfolded.error().message;
    EXPECT_GE(unfolded->extrema, 3);
    const Result<SquareDisk> square = layOutBorder(mesh, cutToDisk(mesh), {129, 0});
    const Result<Parameterization> plain = flattenToSquare(*square);
    ASSERT_TRUE(plain.ok());
    EXPECT_GT(unfolded->map.efficiency, 1.5 * plain->efficiency);
}

TEST(Unfold, TheCutGoesOnToTheFarEndOfALongBody)
{
    Mesh body = shapes::sphere(1, 6);
    for (Vec3& p : body.positions) p[2] *= 6;
    const UnfoldOptions options{{65, 0, SquareLayout::Cut}};
    const Result<Unfolded> unfolded = unfold(body, options);
    ASSERT_TRUE(unfolded.ok()) << unfolded.error().message;
    EXPECT_GE(unfolded->extrema, 1);
    const Result<SquareDisk> square = layOutBorder(body, cutToDisk(body), options);
    const Result<Parameterization> plain = flattenToSquare(*square);
    ASSERT_TRUE(plain.ok());
    EXPECT_GT(unfolded->map.efficiency, 2 * plain->efficiency);
}

TEST(Unfold, AskedForNumbersOfExtremaAreTheIterationsOfTheCut)
{
    const Mesh mesh = jack(10);
    UnfoldOptions options{{65, 0}};
    options.param = MapKind::Tutte; // quick; which vertices are extrema does not depend on it
    std::set<int> before;
    for (int count : {0, 2}) {
        options.extrema = count;
        const Result<Unfolded> unfolded = unfold(mesh, options);
        ASSERT_TRUE(unfolded.ok()) << unfolded.error().message;
        EXPECT_EQ(unfolded->layout, SquareLayout::Cut);
        EXPECT_EQ(unfolded->extrema, count);
        const std::set<int> cut = verticesOf(unfolded->cut);
        EXPECT_TRUE(std::includes(cut.begin(), cut.end(), before.begin(), before.end()));
        EXPECT_GT(cut.size(), before.size());
        before = cut;
    }
    options.layout = SquareLayout::Octahedral;
    EXPECT_EQ(unfold(mesh, options).error().kind, ErrorKind::BadArgument);
}

TEST(Unfold, ACutThatFitsNoBorderIsNotExtendedIntoAnError)
{
    // A grid of 5 has 16 units; a jack's extended cut needs more nodes than that on its border.
    const Mesh mesh = jack(4);
    const UnfoldOptions options{{5, 5, SquareLayout::Cut}};
    ASSERT_FALSE(layOutBorder(mesh, cutToDisk(mesh, findExtrema(mesh).vertices), options).ok());
    const Result<Unfolded> unfolded = unfold(mesh, options);
    ASSERT_TRUE(unfolded.ok()) << unfolded.error().message;
    EXPECT_EQ(unfolded->extrema, 0);
}

} // namespace
} // namespace gimg

#include "gimg/cut.h"

#include "gimg/disk.h"
#include "manifold_check.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <set>

namespace gimg {
namespace {

std::set<std::pair<int, int>> edgesOf(const std::vector<Triangle>& faces)
{
    std::set<std::pair<int, int>> edges;
    for (const Triangle& f : faces)
        for (int k = 0; k < 3; ++k) edges.insert(std::minmax(f[k], f[(k + 1) % 3]));
    return edges;
}

int pathEdges(const CutGraph& cut, bool boundary)
{
    int edges = 0;
    for (const CutPath& path : cut.paths)
        if (path.boundary == boundary) edges += static_cast<int>(path.vertices.size()) - 1;
    return edges;
}

class CutOfShape : public testing::TestWithParam<std::pair<int, int>>
{
};

TEST_P(CutOfShape, OpensToADiskAndKeepsTheBoundary)
{
    const auto [genus, loops] = GetParam();
    const Mesh mesh = shapes::surfaceOfGenus(genus, loops, 6);
    const CutGraph cut = cutToDisk(mesh);
    // Paths run along mesh edges and meet only in their ends.
    const auto edges = edgesOf(mesh.faces);
    std::set<int> inner;
    for (const CutPath& path : cut.paths) {
        ASSERT_GE(path.vertices.size(), 2u);
        for (size_t i = 0; i + 1 < path.vertices.size(); ++i)
            EXPECT_TRUE(edges.count(std::minmax(path.vertices[i], path.vertices[i + 1])));
        for (size_t i = 1; i + 1 < path.vertices.size(); ++i)
            EXPECT_TRUE(inner.insert(path.vertices[i]).second);
    }
    const Result<DiskMesh> disk = openAlong(mesh, cut);
    ASSERT_TRUE(disk.ok()) << disk.error().message;
    const test::ManifoldCheck check = test::checkManifold(disk->mesh.faces);
    EXPECT_EQ(check.fault, "");
    EXPECT_EQ(check.genus, 0);
    EXPECT_EQ(check.boundaries, 1);
    // Every original boundary edge once, every other cut edge twice.
    EXPECT_EQ(disk->borderLength(), pathEdges(cut, true) + 2 * pathEdges(cut, false));
    EXPECT_EQ(topology(mesh).boundaries == 0, pathEdges(cut, true) == 0);
    // The cut is a graph with chi = chi(surface) - 1; the disk's sides repeat the paths accordingly.
    EXPECT_EQ(cut.nodeCount() - static_cast<int>(cut.paths.size()), topology(mesh).euler() - 1);
}

std::vector<std::pair<int, int>> generaAndLoops()
{
    std::vector<std::pair<int, int>> all;
    for (int genus : {0, 1, 2, 3, 7})
        for (int loops = 0; loops <= 4; ++loops) all.emplace_back(genus, loops);
    return all;
}
INSTANTIATE_TEST_SUITE_P(AllTopologies, CutOfShape, testing::ValuesIn(generaAndLoops()));

TEST(Cut, SphereIsCutAlongTwoAdjacentEdges)
{
    const CutGraph cut = cutToDisk(shapes::sphere(1, 8));
    ASSERT_EQ(cut.paths.size(), 1u);
    EXPECT_EQ(cut.paths[0].vertices.size(), 3u);
    EXPECT_FALSE(cut.paths[0].boundary);
    EXPECT_EQ(cut.nodeCount(), 2);
}

TEST(Cut, DiskNeedsNoCutBesidesItsBoundary)
{
    const CutGraph cut = cutToDisk(shapes::disk(1, 5));
    ASSERT_EQ(cut.paths.size(), 1u);
    EXPECT_TRUE(cut.paths[0].boundary);
    EXPECT_EQ(cut.paths[0].vertices.size(), 31u); // 6 n edges, and back to the start
    EXPECT_EQ(cut.paths[0].vertices.front(), cut.paths[0].vertices.back());
}

TEST(Cut, CylinderIsCutByOneStraightPath)
{
    // Straightened, the path is hardly longer than the cylinder is high: its ends stay where they were.
    const Mesh mesh = shapes::cylinder(1, 5, 40, 30);
    const CutGraph cut = cutToDisk(mesh);
    double length = 0;
    int inner = 0;
    for (const CutPath& path : cut.paths)
        if (!path.boundary) {
            ++inner;
            length += cutLength(mesh, {{path}});
        }
    EXPECT_EQ(inner, 1);
    EXPECT_LT(length, 5 * 1.2);
}

TEST(Cut, TorusCutIsNearlyAsShortAsTheShortestLoops)
{
    // A meridian of 2 pi and a loop around the hole of at least 4 pi must both be crossed.
    const Mesh mesh = shapes::torus(3, 1, 96, 48);
    const CutGraph cut = cutToDisk(mesh);
    EXPECT_LT(cutLength(mesh, cut), 1.15 * (2 * M_PI + 4 * M_PI));
}

TEST(Disk, RefusesACutThatDoesNotOpenTheSurface)
{
    const Mesh mesh = shapes::torus(3, 1, 16, 8);
    CutGraph cut = cutToDisk(mesh);
    cut.paths.pop_back();
    const Result<DiskMesh> disk = openAlong(mesh, cut);
    ASSERT_FALSE(disk.ok());
    EXPECT_EQ(disk.error().kind, ErrorKind::NotADisk);
}

} // namespace
} // namespace gimg

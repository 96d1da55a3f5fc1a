#include "gimg/border.h"

#include "codec/seam.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <map>

namespace gimg {
namespace {

SquareDisk layOut(const Mesh& mesh, const BorderOptions& options = {})
{
    Result<SquareDisk> square = layOutBorder(mesh, cutToDisk(mesh), options);
    EXPECT_TRUE(square.ok()) << square.error().message;
    return std::move(*square);
}

// Position along the border in lowest-grid units, from (s,t).
double borderPosition(const Vec2& st, int lowest)
{
    const double side = lowest - 1;
    if (st.y() == 0) return st.x() * side;
    if (st.x() == 1) return side + st.y() * side;
    if (st.y() == 1) return 2 * side + (1 - st.x()) * side;
    return 3 * side + (1 - st.y()) * side;
}

class BorderOfShape : public testing::TestWithParam<std::pair<int, int>>
{
protected:
    void SetUp() override
    {
        mesh_ = shapes::surfaceOfGenus(GetParam().first, GetParam().second, 6);
        square_ = layOut(mesh_);
    }
    Mesh mesh_;
    SquareDisk square_;
};

TEST_P(BorderOfShape, SidesFillThePerimeterWithEqualMates)
{
    int total = 0;
    std::map<int, int> occurrences;
    for (const DiskSide& side : square_.disk.sides) {
        total += square_.pathLength[side.path];
        ++occurrences[side.path];
    }
    EXPECT_EQ(total, 4 * (square_.lowest - 1));
    for (size_t p = 0; p < square_.cut.paths.size(); ++p)
        EXPECT_EQ(occurrences[static_cast<int>(p)], square_.cut.paths[p].boundary ? 1 : 2);
    const codec::Seam seam{static_cast<uint32_t>(square_.lowest), static_cast<uint32_t>(square_.start),
                           square_.seam()};
    EXPECT_EQ(codec::seamFault(seam), "");
    EXPECT_EQ(static_cast<int>(codec::topologyOf(seam).genus), GetParam().first);
    EXPECT_EQ(static_cast<int>(codec::topologyOf(seam).boundaryLoops), GetParam().second);
}

TEST_P(BorderOfShape, CutNodesFallOnGridPointsOfTheLowestLevel)
{
    for (const DiskSide& side : square_.disk.sides) {
        const double position = borderPosition(square_.borderPosition[side.vertices.front()], square_.lowest);
        EXPECT_NEAR(position, std::round(position), 1e-12);
    }
}

TEST_P(BorderOfShape, LengthsFollowTheSurface)
{
    double total = 0;
    for (const DiskSide& side : square_.disk.sides)
        total += cutLength(square_.surface, {{square_.cut.paths[side.path]}});
    for (size_t p = 0; p < square_.cut.paths.size(); ++p) {
        const double share =
            cutLength(square_.surface, {{square_.cut.paths[p]}}) / total * 4 * (square_.lowest - 1);
        // Short paths may be stretched to what a simplicial seam needs; the others give way a little.
        EXPECT_LE(square_.pathLength[p], std::max(4.0, share + 1.5));
        EXPECT_GE(square_.pathLength[p], 0.6 * share - 1.5);
    }
}

TEST_P(BorderOfShape, CornersAreVerticesAndNoTipIsNear)
{
    std::vector<Vec2> corners = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (const Vec2& corner : corners) {
        int hits = 0;
        for (size_t v = 0; v < square_.squareSides.size(); ++v)
            hits += square_.squareSides[v] != 0 && square_.borderPosition[v] == corner;
        EXPECT_EQ(hits, 1);
    }
    std::map<int, int> valence;
    for (const CutPath& path : square_.cut.paths) {
        ++valence[path.vertices.front()];
        ++valence[path.vertices.back()];
    }
    for (const DiskSide& side : square_.disk.sides) {
        const int v = side.vertices.front();
        if (valence[square_.disk.origin[v]] != 1) continue;
        for (const Vec2& corner : corners)
            EXPECT_GT((square_.borderPosition[v] - corner).norm(), 1.0 / square_.lowest);
    }
}

TEST_P(BorderOfShape, NoInteriorEdgeJoinsTwoBorderVertices)
{
    const Halfedges he(square_.disk.mesh.faces, square_.disk.mesh.vertexCount());
    for (int h = 0; h < he.count(); ++h)
        EXPECT_FALSE(!he.onBoundary(h) && square_.squareSides[he.tail(h)] != 0 &&
                     square_.squareSides[he.head(h)] != 0);
    // Splitting changed neither the surface nor its topology.
    EXPECT_NEAR(surfaceArea(square_.surface), surfaceArea(mesh_), 1e-9 * surfaceArea(mesh_));
    EXPECT_EQ(topology(square_.surface).genus, GetParam().first);
    EXPECT_EQ(topology(square_.surface).boundaries, GetParam().second);
}

TEST_P(BorderOfShape, SeamIsSimplicialAtEveryLevel)
{
    const std::vector<gim_side> word = square_.seam();
    for (int n = square_.lowest; n <= square_.grid; n = 2 * n - 1)
        EXPECT_TRUE(codec::seamIsSimplicial(word.data(), static_cast<uint32_t>(word.size()),
                                            static_cast<uint32_t>(square_.start),
                                            static_cast<uint32_t>(square_.lowest), static_cast<uint32_t>(n)));
}

std::vector<std::pair<int, int>> generaAndLoops()
{
    std::vector<std::pair<int, int>> all;
    for (int genus : {0, 1, 2, 3, 7})
        for (int loops = 0; loops <= 4; ++loops) all.emplace_back(genus, loops);
    return all;
}
INSTANTIATE_TEST_SUITE_P(AllTopologies, BorderOfShape, testing::ValuesIn(generaAndLoops()));

TEST(Border, EdgesAcrossCornersAreSplitOnBothMates)
{
    // A sphere of 80 faces: two long edges carry the whole border, so all four corners fall inside edges.
    const Mesh mesh = shapes::sphere(1, 2);
    const SquareDisk square = layOut(mesh, {65, 9});
    EXPECT_EQ(square.cut.paths[0].vertices.size(), square.disk.sides[0].vertices.size());
    EXPECT_GE(square.cut.paths[0].vertices.size(), 5u);
    EXPECT_GT(square.surface.faceCount(), mesh.faceCount());
    ASSERT_EQ(square.disk.sides.size(), 2u);
    // Mates meet the same surface vertices in opposite order.
    std::vector<int> there, back;
    for (int v : square.disk.sides[0].vertices) there.push_back(square.disk.origin[v]);
    for (int v : square.disk.sides[1].vertices) back.insert(back.begin(), square.disk.origin[v]);
    EXPECT_EQ(there, back);
}

TEST(Border, TipsOfASphereCutSitInTheMiddleOfSides)
{
    const SquareDisk square = layOut(shapes::sphere(1, 6), {65, 17});
    for (const DiskSide& side : square.disk.sides) {
        const Vec2 st = square.borderPosition[side.vertices.front()];
        EXPECT_TRUE(st == Vec2(0.5, 0) || st == Vec2(0.5, 1)) << st.transpose();
    }
}

TEST(Border, AskedGridThatIsTooSmallIsRefused)
{
    const Mesh mesh = shapes::surfaceOfGenus(7, 4, 5);
    const Result<SquareDisk> square = layOutBorder(mesh, cutToDisk(mesh), {9, 9});
    ASSERT_FALSE(square.ok());
    EXPECT_EQ(square.error().kind, ErrorKind::TargetUnreachable);
}

TEST(Border, SizesMustBePowersOfTwoPlusOne)
{
    const Mesh mesh = shapes::sphere(1, 3);
    const CutGraph cut = cutToDisk(mesh);
    for (const BorderOptions& bad : {BorderOptions{256, 0}, BorderOptions{1, 0}, BorderOptions{65, 30},
                                     BorderOptions{33, 65}, BorderOptions{8193, 0}, BorderOptions{-3, 0}}) {
        const Result<SquareDisk> square = layOutBorder(mesh, cut, bad);
        ASSERT_FALSE(square.ok());
        EXPECT_EQ(square.error().kind, ErrorKind::BadArgument);
    }
}

} // namespace
} // namespace gimg

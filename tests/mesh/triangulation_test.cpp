#include "gimg/mesh_io.h"
#include "temporary_files.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <numbers>
#include <sstream>

using namespace gimg;
using ::testing::UnorderedElementsAre;

namespace {

class Triangulation : public test::TemporaryFiles
{
protected:
    Mesh polygon(const std::vector<Vec3>& corners)
    {
        std::ostringstream text;
        text.precision(17);
        for (const Vec3& p : corners) text << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
        text << "f";
        for (size_t k = 1; k <= corners.size(); ++k) text << ' ' << k;
        const Result<MeshFile> file = readMesh(write("polygon.obj", text.str() + "\n"));
        EXPECT_TRUE(file.ok()) << file.error().message;
        return file.ok() ? file->mesh : Mesh{};
    }
};

double polygonArea(const std::vector<Vec3>& corners)
{
    Vec3 twice = Vec3::Zero();
    for (size_t k = 0; k < corners.size(); ++k) twice += corners[k].cross(corners[(k + 1) % corners.size()]);
    return twice.norm() / 2;
}

// A flat polygon is covered exactly if and only if the areas add up and no triangle is turned over.
void expectExactCover(const Mesh& mesh, const std::vector<Vec3>& corners)
{
    ASSERT_EQ(mesh.faceCount(), static_cast<int>(corners.size()) - 2);
    EXPECT_NEAR(surfaceArea(mesh), polygonArea(corners), 1e-12 * polygonArea(corners));
    const Topology t = topology(mesh);
    EXPECT_EQ(t.boundaries, 1);
    EXPECT_EQ(t.euler(), 1);
}

std::vector<Vec3> star(int points)
{
    std::vector<Vec3> corners;
    for (int k = 0; k < 2 * points; ++k) {
        const double r = k % 2 ? 0.2 : 1.0, angle = std::numbers::pi * k / points;
        corners.emplace_back(r * std::cos(angle), r * std::sin(angle), r * std::cos(angle)); // a tilted plane
    }
    return corners;
}

std::vector<Vec3> comb(int teeth)
{
    std::vector<Vec3> corners;
    for (int k = 0; k < teeth; ++k) {
        corners.emplace_back(2 * k, 0, 0);
        corners.emplace_back(2 * k + 1, 10, 0);
    }
    corners.emplace_back(2 * teeth, 0, 0);
    corners.emplace_back(2 * teeth, -1, 0);
    corners.emplace_back(0, -1, 0);
    std::reverse(corners.begin(), corners.end());
    return corners;
}

} // namespace

TEST_F(Triangulation, AnArrowheadIsCutAtItsNotch)
{
    // A fan from the first corner would leave the polygon: only the diagonal 2-4 is inside.
    const std::vector<Vec3> arrow{{-1, -1, 0}, {0, 0, 0}, {1, -1, 0}, {0, 2, 0}};
    const Mesh mesh = polygon(arrow);
    expectExactCover(mesh, arrow);
    EXPECT_THAT(mesh.faces, UnorderedElementsAre(Triangle{0, 1, 3}, Triangle{1, 2, 3}));
}

TEST_F(Triangulation, AFlatConvexQuadTakesTheShorterDiagonal)
{
    const Mesh mesh = polygon({{0, 0, 0}, {4, 0, 0}, {5, 1, 0}, {1, 1, 0}});
    EXPECT_THAT(mesh.faces, UnorderedElementsAre(Triangle{0, 1, 3}, Triangle{1, 2, 3}));
}

TEST_F(Triangulation, AWarpedQuadTakesTheSmallerSurface)
{
    // Folded along 1-3 the areas are 2 x 0.5; along 0-2, much more.
    const Mesh mesh = polygon({{0, 0, 3}, {1, 0, 0}, {0, 0, -3.2}, {-1, 0.3, 0}});
    EXPECT_NEAR(surfaceArea(mesh),
                std::min(surfaceArea({mesh.positions, {{0, 1, 2}, {0, 2, 3}}}),
                         surfaceArea({mesh.positions, {{0, 1, 3}, {1, 2, 3}}})),
                1e-12);
}

TEST_F(Triangulation, NonConvexPolygonsOfEverySizeAreCoveredExactly)
{
    for (int points : {3, 5, 16, 32, 33, 100, 1000}) expectExactCover(polygon(star(points)), star(points));
    for (int teeth : {2, 10, 30, 31, 200}) expectExactCover(polygon(comb(teeth)), comb(teeth));
}

TEST_F(Triangulation, ARepeatedCornerCountsOnce)
{
    const Result<MeshFile> file =
        readMesh(write("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 2 3 4 1\nf 1 2 1 2\nf 1 1 1 1\n"));
    ASSERT_TRUE(file.ok()) << file.error().message;
    EXPECT_EQ(file->mesh.faceCount(), 2);
    EXPECT_EQ(file->report.polygonsSplit, 3);
    EXPECT_GE(file->report.repeatedVertexFaces, 2);
}

TEST_F(Triangulation, NoDiagonalDoublesAnEdge)
{
    // A pillow of two quads on the same four corners is a closed surface only if its sides are cut
    // differently.
    const Result<MeshFile> file =
        readMesh(write("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 4 3 2 1\n"));
    ASSERT_TRUE(file.ok()) << file.error().message;
    EXPECT_EQ(file->mesh.faceCount(), 4);
    EXPECT_EQ(topology(file->mesh).euler(), 2);
    EXPECT_EQ(topology(file->mesh).boundaries, 0);
}

TEST_F(Triangulation, ACubeOfQuadsIsASphere)
{
    const Result<MeshFile> file =
        readMesh(write("a.off", "OFF\n8 6 12\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
                                "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n"));
    ASSERT_TRUE(file.ok()) << file.error().message;
    EXPECT_EQ(file->mesh.faceCount(), 12);
    EXPECT_EQ(file->report.polygonsSplit, 6);
    EXPECT_EQ(topology(file->mesh).euler(), 2);
    EXPECT_EQ(warnings(file->report), std::vector<std::string>{"6 polygons split into triangles"});
}

TEST_F(Triangulation, AHugeHostilePolygonEndsSoon)
{
    // A saw with all teeth reflex to one another makes ear clipping quadratic; NaN makes every test fail.
    for (bool infinite : {false, true}) {
        std::vector<Vec3> corners = comb(50000);
        if (infinite) corners[7][0] = std::nan("");
        std::ostringstream text;
        for (const Vec3& p : corners) text << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
        text << "f";
        for (size_t k = 1; k <= corners.size(); ++k) text << ' ' << k;
        const auto start = std::chrono::steady_clock::now();
        const Result<MeshFile> file = readMesh(write("a.obj", text.str() + "\n"));
        EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
        EXPECT_EQ(file.ok(), !infinite);
        EXPECT_TRUE(infinite || file->mesh.faceCount() == 100001);
    }
}

#include "gimg/flatten.h"

#include "border_ties.h"
#include "curvature_importance.h"
#include "gimg/mean_value.h"
#include "gimg/stretch.h"
#include "hierarchy.h"
#include "shapes.h"
#include "stretch_element.h"

#include <gtest/gtest.h>

#include <random>

namespace gimg {
namespace {

// A flat n x n grid over the unit square, with its border vertices.
Mesh flatGrid(int n, std::vector<Vec2>& st)
{
    Mesh mesh;
    st.clear();
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            st.push_back(Vec2(i, j) / n);
            mesh.positions.emplace_back(st.back().x(), st.back().y(), 0);
        }
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const int a = j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
            mesh.faces.push_back({a, b, c});
            mesh.faces.push_back({a, c, d});
        }
    return mesh;
}

bool onSquareBorder(const Vec2& p) { return p.x() == 0 || p.x() == 1 || p.y() == 0 || p.y() == 1; }

TEST(Stretch, IsometryScoresOne)
{
    std::vector<Vec2> st;
    const Mesh mesh = flatGrid(5, st);
    EXPECT_NEAR(stretchEfficiency(mesh, st), 1.0, 1e-12);
}

TEST(Stretch, AnAffineMapScoresWhatItsSingularValuesSay)
{
    // (x, y) = (2 s, t / 2) has unit area and L2^2 = (4 + 1/4) / 2.
    std::vector<Vec2> st;
    Mesh mesh = flatGrid(4, st);
    for (Vec3& p : mesh.positions) p = Vec3(2 * p.x(), p.y() / 2, 0);
    EXPECT_NEAR(stretchEfficiency(mesh, st), 8.0 / 17, 1e-12);
}

TEST(Stretch, FlippedTriangleHasInfiniteEnergy)
{
    std::vector<Vec2> st;
    const Mesh mesh = flatGrid(2, st);
    EXPECT_EQ(flippedTriangles(mesh.faces, st), 0);
    st[4] = Vec2(1.2, 0.5); // the middle vertex leaves its ring
    EXPECT_GT(flippedTriangles(mesh.faces, st), 0);
    EXPECT_TRUE(std::isinf(stretchEnergy(mesh, st)));
}

TEST(StretchElement, DerivativesAgreeWithDifferences)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int trial = 0; trial < 20; ++trial) {
        const auto point = [&] { return Vec3(unit(random), unit(random), unit(random)); };
        const StretchElement element(point(), point(), point());
        std::array<Vec2, 3> p = {Vec2(0, 0), Vec2(1, 0.2 * unit(random)),
                                 Vec2(unit(random), 0.5 + unit(random))};
        const StretchElement::Derivatives d = element.derivatives(p);
        for (int k = 0; k < 6; ++k) {
            const double h = 1e-6;
            auto plus = p, minus = p;
            plus[k % 3][k / 3] += h;
            minus[k % 3][k / 3] -= h;
            const double difference = (element.energy(plus) - element.energy(minus)) / (2 * h);
            EXPECT_NEAR(d.gradient[k], difference, 1e-5 * (1 + std::abs(difference)));
        }
        // No eigenvalue is below -1e-10 |H|.
        const Eigen::Matrix<double, 6, 6> lifted =
            d.hessian + 1e-10 * d.hessian.norm() * Eigen::Matrix<double, 6, 6>::Identity();
        EXPECT_EQ(lifted.llt().info(), Eigen::Success);
    }
}

TEST(StretchElement, FirstCollapseIsWhereTheAreaVanishes)
{
    const std::array<Vec2, 3> p = {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)};
    // The apex comes down at unit speed: the area is gone at t = 1.
    EXPECT_NEAR(firstCollapse(p, {Vec2(0, 0), Vec2(0, 0), Vec2(0, -1)}), 1.0, 1e-15);
    EXPECT_TRUE(std::isinf(firstCollapse(p, {Vec2(0, 0), Vec2(0, 0), Vec2(1, 0)})));
}

TEST(MinimizeStretch, UndoesADistortionOfAFlatSquare)
{
    std::vector<Vec2> st;
    const Mesh mesh = flatGrid(16, st);
    std::vector<bool> fixed;
    std::vector<Vec2> bent = st;
    for (size_t v = 0; v < st.size(); ++v) {
        fixed.push_back(onSquareBorder(st[v]));
        const double bump = 0.1 * std::sin(M_PI * st[v].x()) * std::sin(M_PI * st[v].y());
        bent[v] += Vec2(bump, -bump);
    }
    ASSERT_EQ(flippedTriangles(mesh.faces, bent), 0);
    const double before = stretchEfficiency(mesh, bent);
    EXPECT_LT(before, 0.95);
    minimizeStretch(mesh, fixed, bent, {50, 1e-9});
    EXPECT_NEAR(stretchEfficiency(mesh, bent), 1.0, 1e-6);
}

TEST(MeanValue, ReproducesLinearFunctions)
{
    // Mean-value coordinates have linear precision: a planar mesh maps to itself.
    std::vector<Vec2> st;
    const Mesh mesh = flatGrid(6, st);
    std::vector<bool> fixed;
    std::vector<Vec2> position = st;
    for (size_t v = 0; v < st.size(); ++v) {
        fixed.push_back(onSquareBorder(st[v]));
        if (!fixed[v]) position[v] = Vec2(-7, 9);
    }
    ASSERT_TRUE(meanValueMap(mesh, fixed, position).ok());
    for (size_t v = 0; v < st.size(); ++v) EXPECT_LT((position[v] - st[v]).norm(), 1e-12);
}

TEST(Hierarchy, CoarsensToAWheelAndComesBackUnchanged)
{
    const Mesh mesh = shapes::surfaceOfGenus(2, 1, 5);
    Result<SquareDisk> square = layOutBorder(mesh, cutToDisk(mesh), {});
    ASSERT_TRUE(square.ok());
    Hierarchy hierarchy(square->disk.mesh, square->squareSides);
    const int interior = hierarchy.interiorCount();
    hierarchy.coarsen();
    EXPECT_EQ(hierarchy.interiorCount(), 1);
    std::vector<int> vertexOf;
    EXPECT_EQ(hierarchy.current(vertexOf).faceCount(), square->disk.borderLength());
    while (!hierarchy.isFull()) hierarchy.refine();
    EXPECT_EQ(hierarchy.interiorCount(), interior);
    EXPECT_EQ(hierarchy.current(vertexOf).faces, square->disk.mesh.faces);
}

TEST(CurvatureImportance, OfASphereIsOneAndOfTipsIsMore)
{
    Mesh mesh = shapes::sphere(1, 24);
    for (double x : curvatureImportance(mesh, 257)) EXPECT_NEAR(x, 1, 0.05);
    for (Vec3& p : mesh.positions) p.z() *= 3;
    const std::vector<double> importance = curvatureImportance(mesh, 257);
    double weighted = 0;
    for (const Triangle& f : mesh.faces) {
        const Vec3& p = mesh.positions[f[0]];
        const double area = 0.5 * (mesh.positions[f[1]] - p).cross(mesh.positions[f[2]] - p).norm();
        for (int v : f) weighted += importance[v] * area / 3;
    }
    EXPECT_NEAR(weighted / surfaceArea(mesh), 1, 1e-12);
    // Principal curvatures of the spheroid: 3 and 3 at a tip, 1 and 1/9 on the equator.
    double tip = 0, equator = 0;
    for (size_t v = 0; v < importance.size(); ++v) {
        if (mesh.positions[v].z() > 2.99) tip = importance[v];
        if (std::abs(mesh.positions[v].z()) < 0.01) equator = importance[v];
    }
    EXPECT_GT(tip, 2 * equator);
    for (double x : curvatureImportance(shapes::disk(1, 8), 257)) EXPECT_EQ(x, 1);
}

class FlattenShape : public testing::TestWithParam<std::pair<int, int>>
{
};

TEST_P(FlattenShape, EmbedsWithoutFlippedTriangles)
{
    const auto [genus, loops] = GetParam();
    const Mesh mesh = shapes::surfaceOfGenus(genus, loops, 6);
    Result<SquareDisk> square = layOutBorder(mesh, cutToDisk(mesh), {});
    ASSERT_TRUE(square.ok());
    const Result<Parameterization> map = flattenToSquare(*square);
    ASSERT_TRUE(map.ok()) << map.error().message;
    EXPECT_EQ(flippedTriangles(square->disk.mesh.faces, map->st), 0);
    double area = 0;
    for (const Triangle& f : square->disk.mesh.faces)
        area += doubleArea({map->st[f[0]], map->st[f[1]], map->st[f[2]]});
    EXPECT_NEAR(area / 2, 1.0, 1e-9);
    const BorderTies ties = borderTies(*square);
    for (size_t v = 0; v < map->st.size(); ++v) {
        const int leader = ties.leader[v];
        EXPECT_LT((ties.motion[v](map->st[leader]) - map->st[v]).norm(), 1e-12) << "vertex " << v;
        for (int c = 0; c < 2; ++c)
            EXPECT_TRUE(ties.free[leader][c] || map->st[leader][c] == square->borderPosition[leader][c]);
    }
    EXPECT_NEAR(map->efficiency, stretchEfficiency(square->disk.mesh, map->st), 1e-12);
    EXPECT_GT(map->efficiency, 0.15);
}

INSTANTIATE_TEST_SUITE_P(SomeTopologies, FlattenShape,
                         testing::Values(std::pair(0, 0), std::pair(0, 1), std::pair(0, 4), std::pair(1, 0),
                                         std::pair(1, 2), std::pair(2, 3), std::pair(3, 0), std::pair(7, 1)));

TEST(Flatten, ADiskGetsAnEvenMap)
{
    const Mesh mesh = shapes::disk(1, 24);
    Result<SquareDisk> square = layOutBorder(mesh, cutToDisk(mesh), {});
    ASSERT_TRUE(square.ok());
    const Result<Parameterization> map = flattenToSquare(*square);
    ASSERT_TRUE(map.ok());
    EXPECT_GT(map->efficiency, 0.85);
}

TEST(Flatten, ALongTubeClosedAtItsTopDoesNotShrinkAway)
{
    // Mean-value coordinates alone shrink the end of a tube of height h and radius r like exp(-h / r), here
    // to 1e-17 of the area; evenly spread it is one third of the surface.
    Mesh mesh = shapes::cylinder(0.25, 10, 24, 200);
    const int top = mesh.vertexCount();
    mesh.positions.emplace_back(0, 0, 10);
    std::vector<int> ring;
    for (int v = 0; v < top; ++v)
        if (mesh.positions[v].z() == 10) ring.push_back(v);
    const Halfedges he(mesh.faces, top);
    std::vector<Triangle> cap;
    for (int v : ring) cap.push_back({he.head(he.outgoing(v)), v, top});
    mesh.faces.insert(mesh.faces.end(), cap.begin(), cap.end());
    ASSERT_EQ(topology(mesh).boundaries, 1);
    Result<SquareDisk> square = layOutBorder(mesh, cutToDisk(mesh), {});
    ASSERT_TRUE(square.ok());
    const Result<Parameterization> map = flattenToSquare(*square);
    ASSERT_TRUE(map.ok()) << map.error().message;
    double upperThird = 0;
    const DiskMesh& disk = square->disk;
    for (const Triangle& f : disk.mesh.faces)
        if (disk.mesh.positions[f[0]].z() > 20.0 / 3)
            upperThird += 0.5 * doubleArea({map->st[f[0]], map->st[f[1]], map->st[f[2]]});
    EXPECT_GT(upperThird, 0.03);
}

} // namespace
} // namespace gimg

#include "gimg/intrinsic.h"

#include "shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace gimg {
namespace {

IntrinsicTriangulation intrinsic(const Mesh& mesh)
{
    Result<IntrinsicTriangulation> made = IntrinsicTriangulation::of(mesh);
    EXPECT_TRUE(made.ok());
    return std::move(*made);
}

// A grid of points in the unit square, each off its place, split along the same diagonal everywhere; sheared
// so that many diagonals are bad.
Mesh shearedGrid(int n, double shear)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> off(-0.3, 0.3);
    Mesh mesh;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const bool border = i == 0 || j == 0 || i == n || j == n;
            const double x = (i + (border ? 0 : off(random))) / n, y = (j + (border ? 0 : off(random))) / n;
            mesh.positions.emplace_back(x + shear * y, y, 0);
        }
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const int a = j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
            mesh.faces.push_back({a, b, c});
            mesh.faces.push_back({a, c, d});
        }
    return mesh;
}

// Triangles with obtuse angles on a curved surface.
Mesh sheared(Mesh mesh)
{
    for (Vec3& p : mesh.positions) p.x() += 3 * p.y() + 2 * p.z();
    return mesh;
}

std::vector<double> angleSums(const IntrinsicTriangulation& triangulation)
{
    std::vector<double> sums(static_cast<size_t>(triangulation.vertexCount()), 0.0);
    for (int h = 0; h < triangulation.halfedgeCount(); ++h)
        sums[triangulation.tail(h)] += triangulation.angle(h);
    return sums;
}

std::vector<double> sortedLengths(const IntrinsicTriangulation& triangulation)
{
    std::vector<double> lengths;
    for (int h = 0; h < triangulation.halfedgeCount(); ++h) lengths.push_back(triangulation.length(h));
    std::sort(lengths.begin(), lengths.end());
    return lengths;
}

double leastWeight(const IntrinsicTriangulation& triangulation)
{
    double least = 1e300;
    for (int h = 0; h < triangulation.halfedgeCount(); ++h)
        if (!triangulation.onBoundary(h)) least = std::min(least, triangulation.weight(h));
    return least;
}

TEST(Intrinsic, TheLongDiagonalOfARhombusIsFlipped)
{
    const Mesh rhombus{{{-2, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, -1, 0}}, {{0, 1, 2}, {1, 0, 3}}};
    IntrinsicTriangulation triangulation = intrinsic(rhombus);
    EXPECT_NEAR(triangulation.weight(0), -0.75, 1e-15); // both angles have the cotangent -3/4
    const DelaunayReport report = triangulation.makeDelaunay();
    EXPECT_EQ(report.negativeBefore, 1);
    EXPECT_EQ(report.negativeAfter, 0);
    EXPECT_EQ(report.flips, 1);
    EXPECT_NEAR(triangulation.length(0), 2, 1e-15);
    EXPECT_NEAR(triangulation.weight(0), 0.75, 1e-15);
    EXPECT_EQ(triangulation.addedLength(), 0);
}

TEST(Intrinsic, APlanarResultIsTheDelaunayTriangulationOfThePoints)
{
    const Mesh mesh = shearedGrid(9, 0.8);
    IntrinsicTriangulation triangulation = intrinsic(mesh);
    EXPECT_GT(triangulation.makeDelaunay().flips, 30);
    double area = 0;
    for (const Triangle& f : triangulation.faces()) {
        const Vec2 a = mesh.positions[f[0]].head<2>(), b = mesh.positions[f[1]].head<2>(),
                   c = mesh.positions[f[2]].head<2>();
        Eigen::Matrix2d edges;
        edges << (b - a).transpose(), (c - a).transpose();
        const Vec2 centre = edges.inverse() * Vec2((b - a).squaredNorm(), (c - a).squaredNorm()) / 2;
        for (const Vec3& p : mesh.positions)
            EXPECT_GT((p.head<2>() - a - centre).norm(), centre.norm() - 1e-9);
        EXPECT_GT(edges.determinant(), 0);
        area += edges.determinant() / 2;
    }
    EXPECT_NEAR(area, 1, 1e-12);
}

TEST(Intrinsic, FourPointsOnACircleAreLeftAsTheyAre)
{
    Mesh mesh = shapes::plate(0, 7);
    IntrinsicTriangulation triangulation = intrinsic(mesh);
    const DelaunayReport report = triangulation.makeDelaunay();
    EXPECT_EQ(report.flips, 0);
    EXPECT_EQ(report.negativeBefore, 0);
}

TEST(Intrinsic, FlipsKeepAreaAnglesAndGaussBonnet)
{
    for (const auto& [mesh, euler] :
         {std::pair(sheared(shapes::surfaceOfGenus(2, 0, 5)), -2),
          std::pair(sheared(shapes::trefoil(0.2, 60, 5)), 0), std::pair(sheared(shapes::sphere(1, 8)), 2)}) {
        IntrinsicTriangulation triangulation = intrinsic(mesh);
        const std::vector<double> before = angleSums(triangulation);
        EXPECT_GT(triangulation.makeDelaunay().flips, 20);
        EXPECT_GE(leastWeight(triangulation), 0);
        const std::vector<double> after = angleSums(triangulation);
        double curvature = 0;
        for (size_t v = 0; v < after.size(); ++v) {
            EXPECT_NEAR(after[v], before[v], 1e-10);
            curvature += 2 * M_PI - after[v];
        }
        EXPECT_NEAR(curvature, 2 * M_PI * euler, 1e-9);
        EXPECT_NEAR(triangulation.vertexAreas().sum(), surfaceArea(mesh), 1e-10 * surfaceArea(mesh));
    }
}

TEST(Intrinsic, TheResultDoesNotDependOnTheOrderOfFaces)
{
    Mesh mesh = sheared(shapes::surfaceOfGenus(1, 2, 6));
    IntrinsicTriangulation first = intrinsic(mesh);
    first.makeDelaunay();
    std::shuffle(mesh.faces.begin(), mesh.faces.end(), std::mt19937(2));
    IntrinsicTriangulation second = intrinsic(mesh);
    second.makeDelaunay();
    const std::vector<double> a = sortedLengths(first), b = sortedLengths(second);
    for (size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-12);
}

TEST(Intrinsic, TheTipOfANarrowConeEndsInsideALoop)
{
    // Three faces of 10 degrees at the apex, one vertex at distance 1 and two at 3. Two flips leave the apex
    // one edge, and around it a loop: the chord of 30 degrees in the unrolled cone.
    const double sine = std::sqrt((1 - std::cos(M_PI / 18)) / 1.5), cosine = std::sqrt(1 - sine * sine);
    Mesh cone{{{0, 0, 0}}, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}}};
    for (int k = 0; k < 3; ++k) {
        const double turn = 2 * M_PI * k / 3;
        cone.positions.push_back((k == 0 ? 1 : 3) *
                                 Vec3(sine * std::cos(turn), sine * std::sin(turn), cosine));
    }
    IntrinsicTriangulation triangulation = intrinsic(cone);
    EXPECT_EQ(triangulation.makeDelaunay().flips, 2);
    int loop = -1;
    for (int h = 0; h < triangulation.halfedgeCount(); ++h)
        if (triangulation.tail(h) == 1 && triangulation.head(h) == 1) loop = h;
    ASSERT_GE(loop, 0);
    EXPECT_NEAR(triangulation.length(loop), 2 * std::sin(M_PI / 12), 1e-12);
    const Eigen::SparseMatrix<double> laplacian = triangulation.cotangentLaplacian();
    EXPECT_NEAR(laplacian.coeff(0, 1), -1 / std::tan(75 * M_PI / 180), 1e-12);
    EXPECT_NEAR(laplacian.coeff(0, 0), 1 / std::tan(75 * M_PI / 180), 1e-12);
}

TEST(Laplacian, OfLinearFunctionsIsZeroInsideAndTheirEnergyIsTheArea)
{
    const Mesh mesh = shearedGrid(12, 0.5);
    std::vector<bool> inside(mesh.positions.size(), true);
    const Halfedges he(mesh.faces, mesh.vertexCount());
    for (int h = 0; h < he.count(); ++h)
        if (he.onBoundary(h)) inside[he.tail(h)] = false;
    IntrinsicTriangulation triangulation = intrinsic(mesh);
    for (int round = 0; round < 2; ++round, triangulation.makeDelaunay()) {
        const Eigen::SparseMatrix<double> laplacian = triangulation.cotangentLaplacian();
        Eigen::VectorXd x(mesh.vertexCount());
        for (int v = 0; v < mesh.vertexCount(); ++v) x[v] = mesh.positions[v].x();
        const Eigen::VectorXd lx = laplacian * x;
        for (int v = 0; v < mesh.vertexCount(); ++v) EXPECT_TRUE(!inside[v] || std::abs(lx[v]) < 1e-13);
        EXPECT_NEAR(x.dot(lx), 1, 1e-12);
        EXPECT_LT((laplacian * Eigen::VectorXd::Ones(mesh.vertexCount())).norm(), 1e-12);
    }
}

TEST(Laplacian, DelaunayLowersTheDirichletEnergyOfAnyFunction)
{
    // Rippa 1990; Bobenko and Springborn 2007 for surfaces.
    const Mesh mesh = sheared(shapes::trefoil(0.2, 60, 5));
    IntrinsicTriangulation triangulation = intrinsic(mesh);
    const Eigen::SparseMatrix<double> before = triangulation.cotangentLaplacian();
    triangulation.makeDelaunay();
    const Eigen::SparseMatrix<double> after = triangulation.cotangentLaplacian();
    std::mt19937 random(1);
    std::uniform_real_distribution<double> value(-1, 1);
    for (int trial = 0; trial < 10; ++trial) {
        Eigen::VectorXd u(mesh.vertexCount());
        for (double& x : u) x = value(random);
        EXPECT_LT(u.dot(after * u), u.dot(before * u));
    }
    for (int k = 0; k < after.outerSize(); ++k)
        for (Eigen::SparseMatrix<double>::InnerIterator it(after, k); it; ++it)
            EXPECT_TRUE(it.row() == it.col() || it.value() <= 0);
}

TEST(Laplacian, OfAnEquilateralTriangle)
{
    const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}}, {{0, 1, 2}}};
    const Eigen::SparseMatrix<double> laplacian = intrinsic(mesh).cotangentLaplacian();
    EXPECT_NEAR(laplacian.coeff(0, 1), -0.5 / std::sqrt(3), 1e-15);
    EXPECT_NEAR(laplacian.coeff(2, 2), 1 / std::sqrt(3), 1e-15);
}

TEST(Intrinsic, ACarriedFormIsThatOfTheSameFunction)
{
    const Mesh mesh = sheared(shapes::trefoil(0.2, 60, 5));
    IntrinsicTriangulation triangulation = intrinsic(mesh);
    std::vector<double> form;
    for (int h = 0; h < triangulation.halfedgeCount(); ++h)
        form.push_back(mesh.positions[triangulation.head(h)].x() - mesh.positions[triangulation.tail(h)].x());
    ASSERT_GT(triangulation.makeDelaunay().flips, 20);
    form = triangulation.carried(form);
    for (int h = 0; h < triangulation.halfedgeCount(); ++h)
        EXPECT_NEAR(form[h],
                    mesh.positions[triangulation.head(h)].x() - mesh.positions[triangulation.tail(h)].x(),
                    1e-12);
}

TEST(Intrinsic, SplitsKeepTheSurfaceAndHalveForms)
{
    const Mesh mesh = sheared(shapes::surfaceOfGenus(2, 1, 3));
    IntrinsicTriangulation triangulation = intrinsic(mesh);
    std::vector<double> form;
    for (int h = 0; h < triangulation.halfedgeCount(); ++h)
        form.push_back(mesh.positions[triangulation.head(h)].x() - mesh.positions[triangulation.tail(h)].x());
    const std::vector<double> angles = angleSums(triangulation);
    std::vector<double> x; // per vertex
    for (const Vec3& p : mesh.positions) x.push_back(p.x());
    std::mt19937 random(8);
    const int faces = triangulation.faceCount();
    int added = 0;
    for (int i = 0; i < 300; ++i) { // splits of splits, at the boundary too
        const int h = static_cast<int>(random() % static_cast<size_t>(triangulation.halfedgeCount()));
        const int tail = triangulation.tail(h), head = triangulation.head(h);
        const bool onBoundary = triangulation.onBoundary(h);
        const double length = triangulation.length(h);
        ASSERT_EQ(triangulation.split(h), static_cast<int>(x.size()));
        EXPECT_EQ(triangulation.tail(h), tail);
        EXPECT_EQ(triangulation.head(h), static_cast<int>(x.size()));
        EXPECT_EQ(triangulation.length(h), length / 2);
        x.push_back((x[tail] + x[head]) / 2);
        added += onBoundary ? 1 : 2;
    }
    EXPECT_EQ(triangulation.faceCount(), faces + added);
    EXPECT_EQ(triangulation.vertexCount(), mesh.vertexCount() + 300);
    for (int round = 0; round < 2; ++round, triangulation.makeDelaunay()) {
        const std::vector<double> carried = triangulation.carried(form);
        for (int h = 0; h < triangulation.halfedgeCount(); ++h) {
            EXPECT_NEAR(carried[h] + carried[triangulation.next(h)] + carried[triangulation.prev(h)], 0,
                        1e-12);
            if (round == 0) {
                EXPECT_NEAR(carried[h], x[triangulation.head(h)] - x[triangulation.tail(h)], 1e-12);
            }
            if (!triangulation.onBoundary(h)) {
                EXPECT_EQ(triangulation.twin(triangulation.twin(h)), h);
                EXPECT_EQ(triangulation.tail(triangulation.twin(h)), triangulation.head(h));
                EXPECT_EQ(triangulation.length(triangulation.twin(h)), triangulation.length(h));
            }
            EXPECT_EQ(triangulation.face(h), triangulation.face(triangulation.next(h)));
        }
        const std::vector<double> after = angleSums(triangulation);
        for (size_t v = 0; v < angles.size(); ++v) EXPECT_NEAR(after[v], angles[v], 1e-9);
        EXPECT_NEAR(triangulation.vertexAreas().sum(), surfaceArea(mesh), 1e-10 * surfaceArea(mesh));
    }
}

TEST(Intrinsic, DegenerateTrianglesGetFiniteWeights)
{
    Mesh mesh = shapes::torus(2, 1, 12, 8);
    mesh.positions[20] = mesh.positions[21];                              // edges without length
    mesh.positions[50] = 0.5 * (mesh.positions[49] + mesh.positions[51]); // corners of 180 degrees
    mesh.positions[70] = mesh.positions[71] + 1e-9 * (mesh.positions[70] - mesh.positions[71]); // needles
    IntrinsicTriangulation triangulation = intrinsic(mesh);
    EXPECT_GT(triangulation.addedLength(), 0);
    EXPECT_LT(triangulation.addedLength(), 2e-6);
    EXPECT_EQ(triangulation.makeDelaunay().negativeAfter, 0);
    EXPECT_GE(leastWeight(triangulation), 0);
    const Eigen::SparseMatrix<double> laplacian = triangulation.cotangentLaplacian();
    for (int k = 0; k < laplacian.nonZeros(); ++k) EXPECT_TRUE(std::isfinite(laplacian.valuePtr()[k]));
}

TEST(Intrinsic, RefusesWhatHasNoLengths)
{
    Mesh mesh = shapes::sphere(1, 2);
    mesh.positions[3].y() = std::nan("");
    EXPECT_EQ(IntrinsicTriangulation::of(mesh).error().kind, ErrorKind::NotFinite);
    for (Vec3& p : mesh.positions) p = Vec3(1, 2, 3);
    EXPECT_EQ(IntrinsicTriangulation::of(mesh).error().kind, ErrorKind::EmptyMesh);
    EXPECT_EQ(IntrinsicTriangulation::of(Mesh{}).error().kind, ErrorKind::EmptyMesh);
}

} // namespace
} // namespace gimg

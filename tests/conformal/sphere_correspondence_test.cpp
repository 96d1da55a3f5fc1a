#include "gimg/sphere_correspondence.h"

#include "shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gimg {
namespace {

// Bumps of three sizes, so that no rotation but one takes it to itself.
Mesh lump(int n)
{
    Mesh mesh = shapes::sphere(1, n);
    for (Vec3& p : mesh.positions)
        p *= 1 + 0.6 * std::exp(-4 * (p - Vec3(0.6, 0, 0.8)).squaredNorm()) +
             0.4 * std::exp(-8 * (p - Vec3(0, 0.8, -0.6)).squaredNorm()) -
             0.3 * std::exp(-4 * (p - Vec3(0, -1, 0)).squaredNorm());
    return mesh;
}

TEST(SphereLocator, FindsEveryVertexAndCentroid)
{
    const Mesh mesh = lump(12);
    const Result<SphereMap> map = sphereMap(mesh);
    ASSERT_TRUE(map.ok());
    const Result<SphereLocator> locator = SphereLocator::of(mesh.faces, map->position);
    ASSERT_TRUE(locator.ok());
    for (int v = 0; v < mesh.vertexCount(); ++v) {
        const SurfacePoint at = locator->locate(map->position[v], 17);
        EXPECT_LT((pointAt(mesh, at) - mesh.positions[v]).norm(), 1e-12);
    }
    for (int f = 0; f < mesh.faceCount(); ++f) {
        const Triangle& t = mesh.faces[f];
        const SurfacePoint at =
            locator->locate(map->position[t[0]] + map->position[t[1]] + map->position[t[2]], 17);
        EXPECT_EQ(at.face, f);
        EXPECT_LT((at.barycentric - Vec3::Constant(1.0 / 3)).norm(), 1e-12);
    }
}

TEST(SphereLocator, RefusesFoldedAndOpenMaps)
{
    const Mesh mesh = shapes::sphere(1, 4);
    std::vector<Vec3> folded = mesh.positions;
    folded[9] = -folded[9];
    EXPECT_EQ(SphereLocator::of(mesh.faces, folded).error().kind, ErrorKind::FlippedTriangle);
    Mesh open = mesh;
    open.faces.pop_back();
    EXPECT_EQ(SphereLocator::of(open.faces, open.positions).error().kind, ErrorKind::BadArgument);
}

TEST(MapThroughSphere, TakesAShapeToItsOtherMesh)
{
    // The same surface, meshed twice and turned: rotation found, points of one meet the other.
    const Mesh from = lump(14);
    Mesh to = lump(19);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.2, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
    for (Vec3& p : to.positions) p = turn * p;
    const Result<SphereMap> a = sphereMap(from), b = sphereMap(to);
    ASSERT_TRUE(a.ok() && b.ok());
    double correlation = 0;
    const Result<Eigen::Matrix3d> rotation = alignRotation(from, *a, to, *b, &correlation);
    ASSERT_TRUE(rotation.ok());
    EXPECT_GT(correlation, 0.999);
    EXPECT_LT((*rotation - turn).norm(), 0.02);
    const auto points = mapThroughSphere(a->position, Moebius::rotating(*rotation), to, *b);
    ASSERT_TRUE(points.ok());
    double worst = 0;
    for (int v = 0; v < from.vertexCount(); ++v)
        worst = std::max(worst, (pointAt(to, (*points)[v]) - turn * from.positions[v]).norm());
    EXPECT_LT(worst, 0.05);
}

TEST(AlignLandmarks, ThreeExactlyMoreInTheMean)
{
    const Mesh mesh = lump(10);
    const Result<SphereMap> map = sphereMap(mesh);
    ASSERT_TRUE(map.ok());
    SphereMap moved = *map;
    const Moebius by = Moebius::centring({0.3, 0.2, -0.4});
    for (Vec3& p : moved.position) p = by(p);
    for (const std::vector<std::pair<int, int>>& pairs :
         {std::vector<std::pair<int, int>>{{3, 3}, {70, 70}, {200, 200}},
          std::vector<std::pair<int, int>>{{3, 3}, {70, 70}, {200, 200}, {300, 300}, {411, 411}}}) {
        const Result<Moebius> found = alignLandmarks(*map, moved, pairs);
        ASSERT_TRUE(found.ok());
        for (size_t v = 0; v < map->position.size(); ++v)
            ASSERT_LT(((*found)(map->position[v]) - moved.position[v]).norm(), 1e-8);
    }
    EXPECT_EQ(alignLandmarks(*map, moved, {{0, 0}, {1, 1}}).error().kind, ErrorKind::BadArgument);
    EXPECT_EQ(alignLandmarks(*map, moved, {{0, 0}, {1, 1}, {1, 1}}).error().kind, ErrorKind::BadArgument);
    EXPECT_EQ(alignLandmarks(*map, moved, {{0, 0}, {1, 1}, {2, 99999}}).error().kind, ErrorKind::BadArgument);
}

TEST(StereographicCharts, AreConformalAndCoverTheSphereOnce)
{
    const Mesh mesh = shapes::sphere(1, 20);
    const auto charts = stereographicCharts(mesh.faces, mesh.positions);
    EXPECT_EQ(charts[0].faces.size() + charts[1].faces.size(), mesh.faces.size());
    for (const PlanarChart& chart : charts) {
        Mesh part{mesh.positions, {}};
        for (int f : chart.faces) part.faces.push_back(mesh.faces[f]);
        EXPECT_LT(conformality(part, chart.corners).largestAngleError, 3);
        double area = 0;
        for (const auto& c : chart.corners) {
            const Vec2 u = c[1] - c[0], v = c[2] - c[0];
            const double doubled = u.x() * v.y() - u.y() * v.x();
            EXPECT_GT(doubled, 0);
            area += doubled / 2;
            for (const Vec2& p : c) EXPECT_LT(p.norm(), 1.1);
        }
        EXPECT_NEAR(area, 3.1416, 0.1);
    }
}

} // namespace
} // namespace gimg

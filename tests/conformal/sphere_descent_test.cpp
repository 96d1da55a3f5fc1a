#include "gimg/sphere_descent.h"

#include "shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace gimg {
namespace {

TEST(GaussMap, FallsBackToTheDirectionFromTheMiddle)
{
    Mesh mesh = shapes::sphere(2, 3);
    for (const auto& [v, normal] : {std::pair{0, 1.0}, {5, 1.0}})
        EXPECT_GT(gaussMap(mesh)[v].dot(mesh.positions[v]) / 2, 0.99 * normal);
    mesh.positions.push_back({0, 0, 9}); // in no face: no normal
    EXPECT_GT(gaussMap(mesh).back().z(), 0.99);
}

TEST(SphereDescent, EnergyOfTheRoundSphereIsItsArea)
{
    // Half of the Dirichlet integral of the identity is the area, 4 pi; here of triangles inside it.
    const Mesh mesh = shapes::sphere(1, 24);
    const Result<SphereDescent> descent = descendOnSphere(mesh, gaussMap(mesh), SphereEnergy::Harmonic);
    ASSERT_TRUE(descent.ok()) << descent.error().message;
    EXPECT_NEAR(descent->energyBefore, 4 * std::numbers::pi, 0.02);
    EXPECT_NEAR(descent->energy, 4 * std::numbers::pi, 0.02);
    EXPECT_LE(descent->energy, descent->energyBefore);
    EXPECT_LT(descent->residual, 0.01);
}

TEST(SphereDescent, UnfoldsTheGaussMap)
{
    // Waves whose Gauss map folds: Algorithm 1, then Algorithm 2 from there, end where sphereMap() does.
    const Mesh mesh = shapes::wavySphere(1, 0.5, 4, 24);
    const std::vector<Vec3> gauss = gaussMap(mesh);
    ASSERT_GT(flippedOnSphere(mesh.faces, gauss), 100);
    const Result<SphereDescent> barycentric = descendOnSphere(mesh, gauss, SphereEnergy::Barycentric);
    ASSERT_TRUE(barycentric.ok()) << barycentric.error().message;
    EXPECT_EQ(barycentric->map.flipped, 0);
    EXPECT_LT(barycentric->map.massCentre.norm(), 1e-10);
    const Result<SphereDescent> harmonic =
        descendOnSphere(mesh, barycentric->map.position, SphereEnergy::Harmonic);
    ASSERT_TRUE(harmonic.ok()) << harmonic.error().message;
    EXPECT_EQ(harmonic->map.flipped, 0);
    EXPECT_LT(harmonic->steps, 60);
    EXPECT_NEAR(harmonic->energy, 4 * std::numbers::pi, 0.05);
    const Result<SphereMap> direct = sphereMap(mesh);
    ASSERT_TRUE(direct.ok());
    EXPECT_NEAR(harmonic->map.quality.medianAngleError, direct->quality.medianAngleError, 0.1);
    const Eigen::Matrix3d rotation = bestRotation(harmonic->map.position, direct->position);
    double worst = 0;
    for (int v = 0; v < mesh.vertexCount(); ++v)
        worst = std::max(worst, (rotation * harmonic->map.position[v] - direct->position[v]).norm());
    EXPECT_LT(worst, 0.02);
}

TEST(SphereDescent, ChangesSphereMapsLittle)
{
    const Mesh mesh = shapes::wavySphere(1, 0.3, 5, 20);
    SphereMapOptions options;
    options.smoothing = 0;
    const Result<SphereMap> map = sphereMap(mesh, options);
    ASSERT_TRUE(map.ok());
    const Result<SphereDescent> descent = descendOnSphere(mesh, map->position, SphereEnergy::Harmonic);
    ASSERT_TRUE(descent.ok());
    EXPECT_LT(descent->energyBefore, 1.001 * descent->energy);
}

TEST(SphereDescent, RefusesABadStart)
{
    const Mesh mesh = shapes::sphere(1, 3);
    std::vector<Vec3> start = gaussMap(mesh);
    start.pop_back();
    EXPECT_EQ(descendOnSphere(mesh, start, SphereEnergy::Harmonic).error().kind, ErrorKind::BadArgument);
    start.push_back({0, 0, 2});
    EXPECT_EQ(descendOnSphere(mesh, start, SphereEnergy::Harmonic).error().kind, ErrorKind::BadArgument);
    start.assign(start.size(), Vec3::UnitX());
    EXPECT_EQ(descendOnSphere(mesh, start, SphereEnergy::Harmonic).error().kind, ErrorKind::BadArgument);
    EXPECT_EQ(descendOnSphere(shapes::torus(3, 1, 9, 9), gaussMap(shapes::torus(3, 1, 9, 9)),
                              SphereEnergy::Harmonic)
                  .error()
                  .kind,
              ErrorKind::WrongGenus);
}

} // namespace
} // namespace gimg

#include "gimg/torus_map.h"

#include "gimg/conformality.h"
#include "gimg/sample.h"
#include "gimg/unfold.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gimg {
namespace {

BorderOptions grid(int n, int lowest)
{
    BorderOptions options;
    options.grid = n;
    options.lowest = lowest;
    return options;
}

TorusMap mapOf(const Mesh& mesh)
{
    Result<TorusMap> torus = torusToSquare(mesh, grid(65, 9));
    EXPECT_TRUE(torus.ok()) << torus.error().message;
    return std::move(*torus);
}

TEST(TorusMap, HasTheModulusAndIsConformalInTheParallelogram)
{
    const TorusMap torus = mapOf(shapes::torus(3, 1, 128, 64));
    // The short side goes around the tube: tau = i sqrt(R^2 - r^2) / r.
    EXPECT_NEAR(torus.tau.imag(), std::sqrt(8), 0.003);
    EXPECT_NEAR(torus.tau.real(), 0, 0.003);
    std::vector<Vec2> plane;
    for (const Vec2& st : torus.map.st)
        plane.emplace_back(st[0] + torus.tau.real() * st[1], torus.tau.imag() * st[1]);
    EXPECT_LT(conformality(torus.square.disk.mesh, plane).medianAngleError, 0.75);
}

TEST(TorusMap, MatesDifferByTheSidesOfTheSquare)
{
    const TorusMap torus = mapOf(shapes::trefoil(0.4, 120, 16));
    const std::vector<DiskSide>& sides = torus.square.disk.sides;
    ASSERT_EQ(sides.size(), 4u);
    for (int side : {0, 1}) {
        const std::vector<int>&here = sides[side].vertices, &mate = sides[side + 2].vertices;
        ASSERT_EQ(here.size(), mate.size());
        const Vec2 shift = side == 0 ? Vec2(0, 1) : Vec2(-1, 0);
        for (size_t i = 0; i < here.size(); ++i)
            EXPECT_LT((torus.map.st[mate[mate.size() - 1 - i]] - torus.map.st[here[i]] - shift).norm(), 1e-9);
    }
    EXPECT_EQ(torus.map.st[sides[0].vertices[0]], Vec2::Zero());
}

// Sampled, the image closes up to a torus of about the same area and volume.
TEST(TorusMap, GeometryImageIsTheTorus)
{
    const Mesh mesh = shapes::torus(3, 1, 64, 32);
    const TorusMap torus = mapOf(mesh);
    const Result<FloatImage> image = sampleGeometry(torus.square, torus.map, 65);
    ASSERT_TRUE(image.ok()) << image.error().message;
    const auto at = [&](int i, int j) {
        return Vec3(image->at(i, j, 0), image->at(i, j, 1), image->at(i, j, 2));
    };
    Mesh sampled;
    for (int j = 0; j < 65; ++j)
        for (int i = 0; i < 65; ++i) {
            sampled.positions.push_back(at(i, j));
            if (i == 64 || j == 64) continue;
            const int v = 65 * j + i;
            sampled.faces.push_back({v, v + 1, v + 66});
            sampled.faces.push_back({v, v + 66, v + 65});
        }
    for (int k = 0; k < 65; ++k) {
        EXPECT_EQ(at(k, 0), at(k, 64));
        EXPECT_EQ(at(0, k), at(64, k));
    }
    EXPECT_NEAR(surfaceArea(sampled), surfaceArea(mesh), 0.01 * surfaceArea(mesh));
    EXPECT_NEAR(shapes::volume(sampled), shapes::volume(mesh), 0.01 * shapes::volume(mesh));
}

// Asked for a conformal map, unfold takes this one; the harmonic map of a square is another.
TEST(TorusMap, IsWhatUnfoldTakes)
{
    const Mesh mesh = shapes::torus(3, 1, 48, 24);
    UnfoldOptions options;
    options.param = MapKind::Conformal;
    const Result<Unfolded> torus = unfold(mesh, options);
    ASSERT_TRUE(torus.ok()) << torus.error().message;
    EXPECT_EQ(torus->square.disk.sides.size(), 4u);
    options.extrema = 2;
    EXPECT_EQ(unfold(mesh, options).error().kind, ErrorKind::BadArgument);
    options.extrema = 0;
    options.param = MapKind::Harmonic;
    const Result<Unfolded> harmonic = unfold(mesh, options);
    ASSERT_TRUE(harmonic.ok()) << harmonic.error().message;
    const auto energy = [](const Unfolded& unfolded) { // of the torus: tau + 1 / tau for a rectangle, squared
        const Mesh& disk = unfolded.square.disk.mesh;
        double sum = 0;
        for (const Triangle& f : disk.faces) {
            const Vec3 a = disk.positions[f[1]] - disk.positions[f[0]],
                       b = disk.positions[f[2]] - disk.positions[f[0]];
            const Vec2 u = unfolded.map.st[f[1]] - unfolded.map.st[f[0]],
                       v = unfolded.map.st[f[2]] - unfolded.map.st[f[0]];
            const double area = a.cross(b).norm();
            sum += (u.squaredNorm() * b.squaredNorm() - 2 * u.dot(v) * a.dot(b) +
                    v.squaredNorm() * a.squaredNorm()) /
                   (2 * area);
        }
        return sum;
    };
    EXPECT_NEAR(energy(*torus), std::sqrt(8) + 1 / std::sqrt(8), 0.02); // the least of all maps of this torus
    EXPECT_GT(energy(*harmonic), 1.02 * energy(*torus));
}

TEST(TorusMap, Refusals)
{
    EXPECT_EQ(torusToSquare(shapes::sphere(1, 3), {}).error().kind, ErrorKind::WrongGenus);
    EXPECT_EQ(torusToSquare(shapes::cylinder(1, 1, 9, 4), {}).error().kind, ErrorKind::NotClosed);
    EXPECT_EQ(torusToSquare(shapes::torus(2, 1, 16, 8), grid(100, 0)).error().kind, ErrorKind::BadArgument);
}

} // namespace
} // namespace gimg

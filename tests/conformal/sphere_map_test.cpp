#include "gimg/sphere_map.h"

#include "gimg/mesh_io.h"
#include "gimg/topology_noise.h"

#include "shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>

namespace gimg {
namespace {

// A surface of revolution about z, from the lower to the upper end of a profile of (radius, height).
Mesh revolved(const std::vector<Vec2>& profile, int around)
{
    Mesh mesh;
    const int rings = static_cast<int>(profile.size()) - 2;
    mesh.positions.push_back({0, 0, profile.front().y()});
    for (int ring = 1; ring <= rings; ++ring)
        for (int k = 0; k < around; ++k) {
            const double angle = 2 * std::numbers::pi * (k + 0.5 * (ring % 2)) / around;
            mesh.positions.push_back({profile[ring].x() * std::cos(angle),
                                      profile[ring].x() * std::sin(angle), profile[ring].y()});
        }
    mesh.positions.push_back({0, 0, profile.back().y()});
    const int top = mesh.vertexCount() - 1;
    const auto at = [&](int ring, int k) { return 1 + (ring - 1) * around + k % around; };
    for (int k = 0; k < around; ++k) mesh.faces.push_back({0, at(1, k + 1), at(1, k)});
    for (int ring = 1; ring < rings; ++ring)
        for (int k = 0; k < around; ++k) {
            const int odd = ring % 2; // shifted by half a step
            mesh.faces.push_back({at(ring, k), at(ring, k + 1), at(ring + 1, k + odd)});
            mesh.faces.push_back({at(ring, k + 1 - odd), at(ring + 1, k + 1), at(ring + 1, k)});
        }
    for (int k = 0; k < around; ++k) mesh.faces.push_back({top, at(rings, k), at(rings, k + 1)});
    return mesh;
}

// A tube of radius 1 between two half spheres.
Mesh capsule(double length, int around)
{
    const double step = 2 * std::numbers::pi / around * 0.87;
    const int cap = static_cast<int>(std::numbers::pi / 2 / step),
              along = static_cast<int>(length / step) + 1;
    std::vector<Vec2> profile;
    for (int i = 0; i < cap; ++i) {
        const double angle = std::numbers::pi / 2 * i / cap;
        profile.push_back({std::sin(angle), -length / 2 - std::cos(angle)});
    }
    for (int i = 0; i <= along; ++i) profile.push_back({1, -length / 2 + length * i / along});
    for (int i = cap - 1; i >= 0; --i) {
        const double angle = std::numbers::pi / 2 * i / cap;
        profile.push_back({std::sin(angle), length / 2 + std::cos(angle)});
    }
    return revolved(profile, around);
}

void expectClean(const Mesh& mesh, const Result<SphereMap>& map)
{
    ASSERT_TRUE(map.ok()) << map.error().message;
    EXPECT_EQ(flippedOnSphere(mesh.faces, map->position), 0);
    EXPECT_LT(map->massCentre.norm(), 1e-9);
    EXPECT_LT((massCentre(map->position, vertexMasses(mesh)) - map->massCentre).norm(), 1e-15);
    for (const Vec3& p : map->position) ASSERT_NEAR(p.norm(), 1, 1e-15);
}

TEST(SphereOrientation, IsExactNextToAGreatCircle)
{
    // c = (a + b) / 2 exactly: on their great circle. One bit decides on which side it lies.
    const Vec3 a(0.75, 0.5, 0.25), b(0.25, 0.5, -0.75);
    Vec3 c = (a + b) / 2;
    EXPECT_EQ(sphereOrientation(a, b, c), 0);
    const double up = std::nextafter(c.z(), 1.0), down = std::nextafter(c.z(), -1.0);
    const int side = a.cross(b).z() > 0 ? 1 : -1;
    EXPECT_EQ(sphereOrientation(a, b, {c.x(), c.y(), up}), side);
    EXPECT_EQ(sphereOrientation(a, b, {c.x(), c.y(), down}), -side);
    EXPECT_EQ(sphereOrientation(b, a, {c.x(), c.y(), up}), -side);
    // Far below what doubles resolve in the determinant.
    const Vec3 tiny(1e-20, 1e-20, 1);
    EXPECT_EQ(sphereOrientation(tiny, {3e-20, 1e-20, 1}, {1e-20, 2e-20, 1}), 1);
    EXPECT_EQ(sphereOrientation(tiny, {1e-20, 2e-20, 1}, {3e-20, 1e-20, 1}), -1);
}

TEST(SphereMap, TakesASphereToItself)
{
    const auto worst = [](int n) {
        Mesh mesh = shapes::sphere(2.5, n);
        for (Vec3& p : mesh.positions) p += Vec3(3, -1, 7);
        const Result<SphereMap> map = sphereMap(mesh);
        expectClean(mesh, map);
        double error = 0;
        for (int v = 0; v < mesh.vertexCount(); ++v)
            error = std::max(error, (map->position[v] - (mesh.positions[v] - Vec3(3, -1, 7)) / 2.5).norm());
        return error;
    };
    const double coarse = worst(8), fine = worst(16);
    EXPECT_LT(coarse, 0.02);
    EXPECT_LT(fine, coarse / 2);
}

// On a surface of revolution the map is known: with the arc length l of the profile and its radius r, heights
// on the sphere are tanh(the integral of dl / r).
TEST(SphereMap, OfAnEllipsoidConverges)
{
    const double longAxis = 3;
    const auto error = [&](int around) {
        std::vector<Vec2> profile;
        for (int i = 0; i <= around; ++i) {
            const double angle = std::numbers::pi * i / around;
            profile.push_back({std::sin(angle), -longAxis * std::cos(angle)});
        }
        const Mesh mesh = revolved(profile, around);
        SphereMapOptions options;
        options.smoothing = 0; // which is for shapes of single triangles
        const Result<SphereMap> map = sphereMap(mesh, options);
        expectClean(mesh, map);
        double sum = 0;
        for (int v = 0; v < mesh.vertexCount(); ++v) {
            const double end = std::acos(std::clamp(-mesh.positions[v].z() / longAxis, -1.0, 1.0));
            if (end < 0.01 || end > std::numbers::pi - 0.01) continue; // dl / r grows without bound
            constexpr int kSteps = 400;                                // midpoints, from the equator
            double integral = 0;
            for (int i = 0; i < kSteps; ++i) {
                const double width = (end - std::numbers::pi / 2) / kSteps,
                             angle = std::numbers::pi / 2 + width * (i + 0.5);
                integral += width * std::hypot(std::cos(angle), longAxis * std::sin(angle)) / std::sin(angle);
            }
            const double off = map->position[v].z() - std::tanh(integral);
            sum += off * off;
        }
        return std::sqrt(sum / mesh.vertexCount());
    };
    const double coarse = error(24), fine = error(48);
    EXPECT_LT(coarse, 0.02);
    EXPECT_LT(fine, coarse / 3.5);
}

TEST(SphereMap, AnglesConvergeOnAWavySurface)
{
    const auto median = [](int n) {
        const Mesh mesh = shapes::wavySphere(1, 0.4, 3, n);
        const Result<SphereMap> map = sphereMap(mesh);
        expectClean(mesh, map);
        return map->quality.medianAngleError;
    };
    const double coarse = median(10), fine = median(20);
    EXPECT_LT(coarse, 3);
    EXPECT_LT(fine, coarse / 1.7);
}

TEST(SphereMap, LimbsShrinkByTheExponentialOfTheirLength)
{
    // Along a tube of radius 1 lengths fall by e each: rings at 4 and 8 from the middle.
    const Mesh mesh = capsule(20, 48);
    const Result<SphereMap> map = sphereMap(mesh);
    expectClean(mesh, map);
    const auto radiusAt = [&](double height) {
        double sum = 0;
        int count = 0;
        for (int v = 0; v < mesh.vertexCount(); ++v)
            if (std::abs(mesh.positions[v].z() - height) < 0.06) {
                sum += std::hypot(map->position[v].x(), map->position[v].y()) /
                       std::exp(-(mesh.positions[v].z() - height));
                ++count;
            }
        EXPECT_GE(count, 48);
        return sum / count;
    };
    EXPECT_NEAR(std::log(radiusAt(4) / radiusAt(8)), 4, 0.02);
    EXPECT_EQ(map->inflated, 0);
}

TEST(SphereMap, LimbsBelowTheResolutionOfDoublesAreWidenedAndReported)
{
    // exp(-75) is far below 1e-16.
    const Mesh mesh = capsule(150, 8);
    const Result<SphereMap> map = sphereMap(mesh);
    expectClean(mesh, map);
    EXPECT_GT(map->inflated, 500);
    // Where the limbs are not that small yet, angles are those of a short tube.
    const Mesh shorter = capsule(16, 8);
    const Result<SphereMap> plain = sphereMap(shorter);
    expectClean(shorter, plain);
    EXPECT_EQ(plain->inflated, 0);
    const auto middle = [](const Mesh& whole, const SphereMap& sphere) {
        Mesh part{whole.positions, {}};
        for (const Triangle& t : whole.faces)
            if (std::abs(whole.positions[t[0]].z()) < 6) part.faces.push_back(t);
        return conformality(part, sphere.position).medianAngleError;
    };
    EXPECT_NEAR(middle(mesh, *map), middle(shorter, *plain), 1);
}

TEST(SphereMap, MapsTheSmallestSurface)
{
    const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                    {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
    expectClean(mesh, sphereMap(mesh));
}

TEST(SphereMap, DoesNotDependOnTheFirstFace)
{
    // Other numbers, another triangle outside, other rounding: the same map.
    const Mesh mesh = shapes::wavySphere(1, 0.3, 4, 12);
    Mesh other = mesh;
    std::reverse(other.faces.begin(), other.faces.end());
    std::reverse(other.positions.begin(), other.positions.end());
    for (Triangle& t : other.faces)
        for (int& v : t) v = mesh.vertexCount() - 1 - v;
    SphereMapOptions options;
    options.smoothing = 0;
    const Result<SphereMap> a = sphereMap(mesh, options), b = sphereMap(other, options);
    ASSERT_TRUE(a.ok() && b.ok());
    double worst = 0;
    for (int v = 0; v < mesh.vertexCount(); ++v)
        worst = std::max(worst, (a->position[v] - b->position[mesh.vertexCount() - 1 - v]).norm());
    EXPECT_LT(worst, 0.01);
}

TEST(SphereMap, CanLeaveTheMassCentreWhereItIs)
{
    const Mesh mesh = shapes::wavySphere(1, 0.5, 1, 10);
    SphereMapOptions options;
    options.centre = false;
    const Result<SphereMap> map = sphereMap(mesh, options);
    ASSERT_TRUE(map.ok());
    EXPECT_EQ(flippedOnSphere(mesh.faces, map->position), 0);
    EXPECT_LT(map->massCentre.norm(), 0.2);
    EXPECT_GT(map->massCentre.norm(), 1e-7);
}

// What real scans and machine parts demand.
class SphereMapOfCorpus : public testing::TestWithParam<std::pair<std::string, double>>
{
};

TEST_P(SphereMapOfCorpus, HasNoFlipAndKeepsAngles)
{
    const char* folder = std::getenv("GIMG_CORPUS_DIR");
    const std::string cache = folder != nullptr ? folder : GIMG_SOURCE_CORPUS "/cache";
    const auto& [name, median] = GetParam();
    const Result<MeshFile> file = readMesh(cache + "/" + name);
    ASSERT_TRUE(file.ok()) << file.error().message << " (corpus/fetch brings it)";
    const Result<HoleClosing> closed = closeHoles(file->mesh, std::numeric_limits<double>::infinity());
    ASSERT_TRUE(closed.ok());
    const Result<SphereMap> map = sphereMap(closed->mesh);
    expectClean(closed->mesh, map);
    ASSERT_TRUE(map.ok());
    EXPECT_LT(map->quality.medianAngleError, median);
}

using NameAndMedian = std::pair<std::string, double>;
INSTANTIATE_TEST_SUITE_P(Meshes, SphereMapOfCorpus,
                         testing::Values(NameAndMedian{"bunny.obj", 0.5}, NameAndMedian{"fandisk.off", 1.0},
                                         NameAndMedian{"camel.off", 3.0}, NameAndMedian{"mannequin.off", 1.1},
                                         NameAndMedian{"head.off", 1.3}));

TEST(SphereMap, RefusesWhatIsNoSphere)
{
    const auto errorOf = [](const Mesh& mesh) {
        const Result<SphereMap> map = sphereMap(mesh);
        EXPECT_FALSE(map.ok());
        return map.ok() ? Error{} : map.error();
    };
    const Error torus = errorOf(shapes::torus(3, 1, 12, 8));
    EXPECT_EQ(torus.kind, ErrorKind::WrongGenus);
    EXPECT_EQ(torus.message, "the surface has genus 1; only genus 0 maps to the sphere");
    const Error open = errorOf(shapes::cylinder(1, 1, 12, 2));
    EXPECT_EQ(open.kind, ErrorKind::NotClosed);
    EXPECT_EQ(open.message, "the surface is not closed: it has 24 boundary edges");

    const Mesh ball = shapes::sphere(1, 3);
    Mesh two = ball;
    for (Triangle t : ball.faces) {
        for (int& v : t) v += ball.vertexCount();
        two.faces.push_back(t);
    }
    for (const Vec3& p : ball.positions) two.positions.push_back(p + Vec3(3, 0, 0));
    EXPECT_EQ(errorOf(two).kind, ErrorKind::SeveralComponents);

    Mesh flat = ball;
    const Triangle t = flat.faces[7];
    flat.positions[t[2]] = (flat.positions[t[0]] + flat.positions[t[1]]) / 2;
    const Error flatError = errorOf(flat);
    EXPECT_EQ(flatError.kind, ErrorKind::ZeroAreaFace);
    EXPECT_NE(flatError.message.find("face 7 "), std::string::npos) << flatError.message;

    Mesh loose = ball;
    loose.positions.push_back({5, 5, 5});
    EXPECT_EQ(errorOf(loose).kind, ErrorKind::BadArgument);
    Mesh notFinite = ball;
    notFinite.positions[3].x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(errorOf(notFinite).kind, ErrorKind::NotFinite);
    Mesh doubled = ball;
    doubled.faces.push_back(doubled.faces[0]);
    EXPECT_FALSE(sphereMap(doubled).ok());
    EXPECT_EQ(errorOf(Mesh{}).kind, ErrorKind::EmptyMesh);

    // Two balls that share a vertex.
    Mesh pinched = two;
    for (Triangle& f : pinched.faces)
        for (int& v : f)
            if (v == ball.vertexCount()) v = 0;
    pinched.positions.erase(pinched.positions.begin() + ball.vertexCount());
    for (Triangle& f : pinched.faces)
        for (int& v : f)
            if (v > ball.vertexCount()) --v;
    EXPECT_EQ(errorOf(pinched).kind, ErrorKind::NonManifoldVertex);
}

} // namespace
} // namespace gimg

#include "brute_force.h"
#include "gimg/nearest.h"
#include "shapes.h"

#include <gmock/gmock.h>

#include <array>
#include <random>

using namespace gimg;

namespace {

NearestSurface surfaceOf(const Mesh& mesh)
{
    Result<NearestSurface> surface = NearestSurface::of(mesh);
    EXPECT_TRUE(surface.ok()) << surface.error().message;
    return std::move(*surface);
}

Mesh moved(Mesh mesh, const Vec3& offset)
{
    for (Vec3& p : mesh.positions) p += offset;
    return mesh;
}

/// Small and large triangles, some of which are points or, with `segments`, segments; faces back to back and
/// faces twice.
Mesh soup(int count, unsigned seed, bool segments = true)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-1, 1);
    const auto vec = [&] { return Vec3(place(random), place(random), place(random)); };
    Mesh mesh;
    for (int f = 0; f < count; ++f) {
        const Vec3 p = vec();
        for (int k = 0; k < 3; ++k) mesh.positions.push_back(p + (f % 3 ? 0.3 : 1e-3) * vec());
        if (segments && f % 7 == 0)
            mesh.positions.back() = (mesh.positions[3 * f] + mesh.positions[3 * f + 1]) / 2;
        if (f % 11 == 0) mesh.positions.back() = mesh.positions[3 * f];
        mesh.faces.push_back({3 * f, 3 * f + 1, 3 * f + 2});
        if (f % 13 == 0) mesh.faces.push_back({3 * f + 1, 3 * f, 3 * f + 2});
        if (f % 17 == 0) mesh.faces.push_back({3 * f + 1, 3 * f + 2, 3 * f});
    }
    return mesh;
}

/// Each face with vertices of its own.
Mesh shattered(const Mesh& mesh)
{
    Mesh result;
    for (const Triangle& t : mesh.faces) {
        const int v = result.vertexCount();
        for (int k : t) result.positions.push_back(mesh.positions[k]);
        result.faces.push_back({v, v + 1, v + 2});
    }
    return result;
}

Mesh cube()
{
    Mesh mesh;
    for (int v = 0; v < 8; ++v) mesh.positions.emplace_back(v & 1, v >> 1 & 1, v >> 2);
    for (const std::array<int, 4>& s :
         {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
        mesh.faces.push_back({s[0], s[1], s[2]});
        mesh.faces.push_back({s[0], s[2], s[3]});
    }
    return mesh;
}

/// Points in the space around a mesh, near its vertices, and on it.
std::vector<Vec3> queries(const Mesh& mesh, int count)
{
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(0, 1);
    const auto vec = [&] { return Vec3(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5); };
    Vec3 middle = Vec3::Zero();
    for (const Vec3& p : mesh.positions) middle += p / mesh.vertexCount();
    const double size = boundingBoxDiagonal(mesh);
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) {
        const Triangle& t = mesh.faces[static_cast<size_t>(unit(random) * mesh.faceCount())];
        const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
        const Vec3 cases[] = {middle + 2 * size * vec(), a + 1e-3 * size * vec(), b,
                              a + unit(random) * 0.5 * (b - a) + unit(random) * 0.5 * (c - a)};
        points.push_back(cases[i % 4]);
    }
    return points;
}

} // namespace

TEST(NearestSurface, AgreesWithBruteForce)
{
    struct Case
    {
        const char* name;
        Mesh mesh;
    };
    const Case cases[] = {{"soup", soup(300, 5)},
                          {"soup far off", moved(soup(300, 6, false), {1 << 17, -(1 << 18), 1 << 16})},
                          {"torus", test::torus(2, 0.7, 33, 21)},
                          {"sphere in eight parts", test::sphere(1, 3)},
                          {"shattered torus", shattered(test::torus(1, 0.4, 20, 15))},
                          {"tetrahedron", test::tetrahedron()},
                          {"band", test::band(40, true)}};
    int onEdge = 0;
    for (const auto& [name, mesh] : cases) {
        const NearestSurface surface = surfaceOf(mesh);
        const double size = boundingBoxDiagonal(mesh);
        for (const Vec3& q : queries(mesh, 400)) {
            const NearestPoint found = surface.to(q);
            const test::BruteForceNearest expected = test::bruteForceNearest(q, mesh, size);
            const double distance = static_cast<double>(expected.distance);
            EXPECT_NEAR(found.distance, distance, 1e-12 * distance + 1e-14 * size) << name;
            const double rounded = 4e-16 * q.norm(); // a point far off is rounded, its distance is not
            EXPECT_NEAR((found.point - expected.point.cast<double>()).norm(), 0, 1e-12 * size + rounded)
                << name;
            Vec3 point = Vec3::Zero();
            for (int k = 0; k < 3; ++k)
                point += found.barycentric[k] * mesh.positions[mesh.faces[found.face][k]];
            EXPECT_NEAR((found.point - point).norm(), 0, 1e-14 * (size + point.norm())) << name;
            EXPECT_GE(found.barycentric.minCoeff(), 0) << name;
            EXPECT_NEAR(found.barycentric.sum(), 1, 1e-14) << name;
            EXPECT_NEAR((surface.normalNearest(q) - expected.normal.cast<double>()).norm(), 0, 1e-9) << name;
            onEdge += found.barycentric.minCoeff() == 0;
        }
    }
    EXPECT_GT(onEdge, 1000); // the normals of edges and vertices were looked at, too
}

TEST(NearestSurface, NormalsAtTheCornersOfACubeDoNotDependOnHowItIsCut)
{
    for (const Mesh& mesh : {cube(), shattered(cube())}) {
        const NearestSurface surface = surfaceOf(mesh);
        for (int v = 0; v < 8; ++v) {
            const Vec3 outward = 2 * cube().positions[v] - Vec3::Ones();
            for (double away : {0.0, 1e-6, 0.5})
                EXPECT_NEAR(
                    (surface.normalNearest(cube().positions[v] + away * outward) - outward.normalized())
                        .norm(),
                    0, 1e-14);
        }
        EXPECT_NEAR((surface.normalNearest({0.3, 1.2, 1.7}) - Vec3(0, 1, 1).normalized()).norm(), 0, 1e-14);
        EXPECT_EQ(surface.normalNearest({0.5, 0.5, 3}), Vec3(0, 0, 1)); // on the diagonal of a side
        EXPECT_EQ(surface.normalNearest({0.25, 0.5, 0.9}), Vec3(0, 0, 1));
    }
}

TEST(NearestSurface, FacesBackToBackAndFacesWithoutAreaHaveNoNormal)
{
    Mesh sheet = test::square(2);
    const size_t n = sheet.faces.size();
    for (size_t f = 0; f < n; ++f) {
        const Triangle t = sheet.faces[f];
        sheet.faces.push_back({t[0], t[2], t[1]});
    }
    EXPECT_EQ(surfaceOf(sheet).normalNearest({0.3, 0.4, 1}), Vec3(0, 0, 0));
    const Mesh segment{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
    EXPECT_EQ(surfaceOf(segment).normalNearest({1, 1, 0}), Vec3(0, 0, 0));
    EXPECT_EQ(surfaceOf(segment).to({1.5, 2, 0}).distance, 2);
    const Mesh point{{{3, 4, 0}}, {{0, 0, 0}}};
    EXPECT_EQ(surfaceOf(point).to({0, 0, 0}).distance, 5);
}

TEST(NearestSurface, NoGuessChangesTheAnswer)
{
    const Mesh mesh = test::torus(2, 0.7, 30, 20);
    const NearestSurface surface = surfaceOf(mesh);
    for (const Vec3& q : queries(mesh, 40)) {
        const NearestPoint first = surface.to(q);
        for (int guess : {-5, 1, 600, mesh.faceCount() - 1, mesh.faceCount(), 1 << 30}) {
            const NearestPoint other = surface.to(q, guess);
            EXPECT_EQ(other.face, first.face);
            EXPECT_EQ(other.point, first.point);
            EXPECT_EQ(other.distance, first.distance);
            EXPECT_EQ(surface.normalNearest(q, guess), surface.normalNearest(q));
        }
    }
}

TEST(NearestSurface, OfFacesAtOneDistanceTheFirstIsGiven)
{
    const NearestSurface surface = surfaceOf(test::square(4));
    EXPECT_EQ(surface.to({0.5, 0.5, 1}, 31).face, 10); // where six faces meet
}

TEST(NearestSurface, DistancesOfManyPointsAreThoseOfEach)
{
    const Mesh mesh = test::torus(2, 0.7, 30, 20);
    const NearestSurface surface = surfaceOf(mesh);
    const std::vector<Vec3> points = queries(mesh, 3000);
    const std::vector<double> distances = surface.distances(points);
    ASSERT_EQ(distances.size(), points.size());
    for (size_t i = 0; i < points.size(); ++i) EXPECT_EQ(distances[i], surface.to(points[i]).distance);
    EXPECT_EQ(surface.distances(points, 1), distances);
    EXPECT_TRUE(surface.distances({}).empty());
}

TEST(NearestSurface, RefusesWhatHasNoTriangles)
{
    EXPECT_EQ(NearestSurface::of({}).error().kind, ErrorKind::EmptyMesh);
    EXPECT_EQ(NearestSurface::of({{{0, 0, 0}}, {{0, 0, 1}}}).error().message,
              "the mesh: face 0 names vertex 1 of 1");
    EXPECT_EQ(NearestSurface::of({{{0, std::nan(""), 0}}, {{0, 0, 0}}}).error().kind, ErrorKind::NotFinite);
}

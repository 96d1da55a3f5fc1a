#include "shapes.h"

#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <numbers>
#include <set>

using namespace gimg;
using std::numbers::pi;

namespace {

// Consistently oriented, at most two faces an edge, one fan of faces a vertex, connected, every vertex used.
::testing::AssertionResult isOrientedManifold(const Mesh& mesh)
{
    std::set<std::pair<int, int>> directed;
    std::vector<int> facesAt(mesh.positions.size());
    for (const Triangle& f : mesh.faces)
        for (int k = 0; k < 3; ++k) {
            ++facesAt[f[k]];
            if (!directed.insert({f[k], f[(k + 1) % 3]}).second)
                return ::testing::AssertionFailure()
                       << "edge " << f[k] << "-" << f[(k + 1) % 3] << " repeats";
        }

    const Halfedges he(mesh.faces, mesh.vertexCount());
    for (int v = 0; v < mesh.vertexCount(); ++v) {
        const int first = he.outgoing(v);
        if (first < 0) return ::testing::AssertionFailure() << "vertex " << v << " is unused";
        int fan = 0;
        for (int h = first; h >= 0 && (fan == 0 || h != first); h = he.rotateCcw(h)) ++fan;
        if (fan != facesAt[v]) return ::testing::AssertionFailure() << "vertex " << v << " has several fans";
    }

    std::vector<bool> reached(mesh.faces.size());
    std::vector<int> open{0};
    reached[0] = true;
    size_t count = 0;
    while (!open.empty()) {
        const int f = open.back();
        open.pop_back();
        ++count;
        for (int h = 3 * f; h < 3 * f + 3; ++h)
            if (!he.onBoundary(h) && !reached[Halfedges::face(he.twin(h))]) {
                reached[Halfedges::face(he.twin(h))] = true;
                open.push_back(Halfedges::face(he.twin(h)));
            }
    }
    if (count != mesh.faces.size()) return ::testing::AssertionFailure() << "several components";
    return ::testing::AssertionSuccess();
}

void expectShape(const Mesh& mesh, int genus, int loops, double minAngle)
{
    ASSERT_TRUE(isOrientedManifold(mesh));
    const Topology t = topology(mesh);
    EXPECT_EQ(t.genus, genus);
    EXPECT_EQ(t.boundaries, loops);
    EXPECT_EQ(t.euler(), 2 - 2 * genus - loops);
    EXPECT_GT(shapes::smallestAngle(mesh), minAngle);
    if (loops == 0) {
        EXPECT_GT(shapes::volume(mesh), 0);
    }
}

// How many times smaller the error gets when the resolution doubles; 4 for a second-order approximation.
template <class Measure> double gain(double exact, Measure measure, int n)
{
    return std::abs(measure(n) - exact) / std::abs(measure(2 * n) - exact);
}

Vec3 vectorArea(const Mesh& mesh)
{
    Vec3 sum = Vec3::Zero();
    for (const Triangle& f : mesh.faces) {
        const Vec3& p = mesh.positions[f[0]];
        const Vec3 u = mesh.positions[f[1]] - p, v = mesh.positions[f[2]] - p;
        sum += 0.5 * Vec3(u.y() * v.z() - u.z() * v.y(), u.z() * v.x() - u.x() * v.z(),
                          u.x() * v.y() - u.y() * v.x());
    }
    return sum;
}

} // namespace

TEST(Shapes, TopologyAndAnglesAtSeveralResolutions)
{
    for (const int n : {4, 7, 24}) {
        SCOPED_TRACE(n);
        expectShape(shapes::sphere(1, n), 0, 0, 50);
        expectShape(shapes::wavySphere(1, 0.3, 5, n), 0, 0, 25);
        expectShape(shapes::torus(1, 0.4, 2 * n, n), 1, 0, 20);
        expectShape(shapes::trefoil(0.4, 10 * n, n), 1, 0, 20);
        expectShape(shapes::cylinder(1, 2, 3 * n, n), 0, 2, 35);
        expectShape(shapes::disk(1, n), 0, 1, 40);
        expectShape(shapes::box(Vec3::Ones(), n), 0, 0, 44);
        for (const int holes : {0, 1, 2, 6}) expectShape(shapes::plate(holes, n), 0, holes + 1, 12);
    }
}

TEST(Shapes, CoarsestResolutions)
{
    expectShape(shapes::sphere(1, 1), 0, 0, 59);
    expectShape(shapes::torus(2, 1, 3, 3), 1, 0, 15);
    expectShape(shapes::cylinder(1, 1, 3, 1), 0, 2, 15);
    expectShape(shapes::disk(1, 1), 0, 1, 59);
    expectShape(shapes::plate(0, 1), 0, 1, 40);
    expectShape(shapes::plate(2, 1), 0, 3, 5);
    for (const int genus : {0, 1, 2}) expectShape(shapes::surfaceOfGenus(genus, 0, 1), genus, 0, 10);
}

TEST(Shapes, FacesAndVerticesCount)
{
    EXPECT_EQ(shapes::sphere(1, 9).faceCount(), 20 * 81);
    EXPECT_EQ(shapes::sphere(1, 9).vertexCount(), 10 * 81 + 2);
    EXPECT_EQ(shapes::torus(2, 1, 12, 7).faceCount(), 2 * 12 * 7);
    EXPECT_EQ(shapes::disk(1, 9).faceCount(), 6 * 81);
    // The ladder of genus 2 has 13 cells with 12 sides between them: 6 * 13 - 2 * 14 free sides.
    EXPECT_EQ(shapes::surfaceOfGenus(2, 0, 6).faceCount(), 2 * 36 * (6 * 13 - 2 * 14));
}

TEST(Shapes, ClosedSurfacesConvergeToTheirVolume)
{
    const double bumps = 2 * (2. * 4 * 6 * 8 * 10) / (3. * 5 * 7 * 9 * 11); // integral of sin^11 over [0, pi]
    const struct
    {
        const char* name;
        double exact;
        std::function<Mesh(int)> make;
    } cases[] = {
        {"sphere", 4 * pi / 3 * 8, [](int n) { return shapes::sphere(2, n); }},
        {"wavy sphere", (4 * pi + 3 * 0.3 * 0.3 * pi * bumps) / 3,
         [](int n) { return shapes::wavySphere(1, 0.3, 5, n); }},
        {"torus", 2 * pi * pi * 3 * 1.5 * 1.5, [](int n) { return shapes::torus(3, 1.5, 2 * n, n); }},
        {"trefoil", pi * 0.4 * 0.4 * shapes::trefoilLength(),
         [](int n) { return shapes::trefoil(0.4, 10 * n, n); }},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.name);
        EXPECT_NEAR(shapes::volume(c.make(48)) / c.exact, 1, 4e-3);
        EXPECT_NEAR(gain(
                        c.exact, [&](int n) { return shapes::volume(c.make(n)); }, 24),
                    4, 0.3);
    }
}

TEST(Shapes, SurfacesConvergeToTheirArea)
{
    const struct
    {
        const char* name;
        double exact;
        std::function<Mesh(int)> make;
    } cases[] = {
        {"sphere", 4 * pi * 4, [](int n) { return shapes::sphere(2, n); }},
        {"torus", 4 * pi * pi * 3 * 1.5, [](int n) { return shapes::torus(3, 1.5, 2 * n, n); }},
        {"trefoil", 2 * pi * 0.4 * shapes::trefoilLength(),
         [](int n) { return shapes::trefoil(0.4, 10 * n, n); }},
        {"cylinder", 2 * pi * 1.5 * 2, [](int n) { return shapes::cylinder(1.5, 2, n, n); }},
        {"disk", pi * 2.25, [](int n) { return shapes::disk(1.5, n); }},
        {"plate", 3 * (4 - pi * 0.36), [](int n) { return shapes::plate(3, n); }},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.name);
        EXPECT_NEAR(surfaceArea(c.make(48)) / c.exact, 1, 4e-3);
        EXPECT_NEAR(gain(
                        c.exact, [&](int n) { return surfaceArea(c.make(n)); }, 24),
                    4, 0.3);
    }
    EXPECT_NEAR(surfaceArea(shapes::plate(0, 5)), 4, 1e-12);
    EXPECT_NEAR(surfaceArea(shapes::box(Vec3(3, 2, 1), 5)), 22, 1e-12);
    EXPECT_NEAR(shapes::volume(shapes::box(Vec3(3, 2, 1), 5)), 6, 1e-12);
}

TEST(Shapes, OpenSurfacesFaceAsDocumented)
{
    EXPECT_NEAR(vectorArea(shapes::disk(1, 16)).z(), surfaceArea(shapes::disk(1, 16)), 1e-12);
    EXPECT_NEAR(vectorArea(shapes::plate(2, 8)).z(), surfaceArea(shapes::plate(2, 8)), 1e-12);
    const Mesh cylinder = shapes::cylinder(1, 1, 24, 4);
    const std::vector<Vec3> normals = vertexNormals(cylinder);
    for (int v = 0; v < cylinder.vertexCount(); ++v) {
        const Vec3& p = cylinder.positions[v];
        EXPECT_GT(normals[v].dot(Vec3(p.x(), p.y(), 0)), 0.99);
    }
}

TEST(SurfaceOfGenus, EveryGenusAndLoopCount)
{
    for (const int n : {2, 5, 8})
        for (const int genus : {0, 1, 2, 3, 7})
            for (const int loops : {0, 1, 2, 3, 4}) {
                SCOPED_TRACE(testing::Message() << "genus " << genus << " loops " << loops << " n " << n);
                expectShape(shapes::surfaceOfGenus(genus, loops, n), genus, loops, 12);
            }
    expectShape(shapes::surfaceOfGenus(3, 16, 4), 3, 16, 12);
}

TEST(SurfaceOfGenus, VerticesLieOnTheSmoothSurface)
{
    for (const int genus : {0, 1, 3}) {
        double worst = 0;
        for (const Vec3& p : shapes::surfaceOfGenus(genus, 2, 12).positions)
            worst = std::max(worst, shapes::surfaceOfGenusResidual(genus, p));
        EXPECT_LT(worst, 1e-9) << genus;
    }
}

TEST(SurfaceOfGenus, AreaAndVolumeConvergeQuadratically)
{
    for (const int genus : {0, 2}) {
        SCOPED_TRACE(genus);
        const auto make = [&](int n) { return shapes::surfaceOfGenus(genus, 0, n); };
        const Mesh coarse = make(8), middle = make(16), fine = make(32);
        const double volumes = (shapes::volume(middle) - shapes::volume(coarse)) /
                               (shapes::volume(fine) - shapes::volume(middle));
        const double areas =
            (surfaceArea(middle) - surfaceArea(coarse)) / (surfaceArea(fine) - surfaceArea(middle));
        EXPECT_NEAR(volumes, 4, 0.4);
        EXPECT_NEAR(areas, 4, 0.4);
    }
}

TEST(SurfaceOfGenus, TrianglesStayEvenInSize)
{
    const Mesh mesh = shapes::surfaceOfGenus(3, 0, 10);
    double smallest = 1e9, largest = 0;
    for (const Triangle& f : mesh.faces) {
        const double area =
            surfaceArea({{mesh.positions[f[0]], mesh.positions[f[1]], mesh.positions[f[2]]}, {{0, 1, 2}}});
        smallest = std::min(smallest, area);
        largest = std::max(largest, area);
    }
    EXPECT_LT(largest / smallest, 25);
}

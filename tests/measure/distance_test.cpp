#include "gimg/distance.h"
#include "shapes.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

using namespace gimg;
using ::testing::HasSubstr;

namespace {

SurfaceDistance compare(const Mesh& reference, const Mesh& test, const DistanceOptions& options = {})
{
    const Result<SurfaceDistance> d = compareSurfaces(reference, test, options);
    EXPECT_TRUE(d.ok()) << d.error().message;
    return d.ok() ? *d : SurfaceDistance{};
}

Mesh moved(Mesh mesh, const Vec3& offset)
{
    for (Vec3& p : mesh.positions) p += offset;
    return mesh;
}

Mesh randomTriangles(int count, unsigned seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-1, 1);
    Mesh mesh;
    for (int f = 0; f < count; ++f) {
        const Vec3 p(place(random), place(random), place(random));
        const double size = f % 3 ? 0.2 : 1e-4; // small ones among large ones, and slivers
        for (int k = 0; k < 3; ++k)
            mesh.positions.push_back(p +
                                     size * Vec3(place(random), place(random), f % 5 ? place(random) : 0));
        if (f % 7 == 0) mesh.positions.back() = (mesh.positions[3 * f] + mesh.positions[3 * f + 1]) / 2;
        if (f % 11 == 0) mesh.positions.back() = mesh.positions[3 * f];
        mesh.faces.push_back({3 * f, 3 * f + 1, 3 * f + 2});
    }
    return mesh;
}

// Another way to the same number: the region of the triangle in which q lies, in barycentric terms (Eberly).
double bruteForceDistance(const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c)
{
    const Vec3 e0 = b - a, e1 = c - a, d = a - q;
    const double a00 = e0.dot(e0), a01 = e0.dot(e1), a11 = e1.dot(e1), b0 = e0.dot(d), b1 = e1.dot(d);
    const auto at = [&](double s, double t) { return (d + s * e0 + t * e1).norm(); };
    const auto unit = [](double x) { return std::clamp(std::isfinite(x) ? x : 0.0, 0.0, 1.0); };
    const double det = a00 * a11 - a01 * a01;
    double best = std::min({at(unit(-b0 / a00), 0), at(0, unit(-b1 / a11))});
    const double along = unit((a11 + b1 - a01 - b0) / (a00 - 2 * a01 + a11));
    best = std::min(best, at(along, 1 - along));
    const double s = (a01 * b1 - a11 * b0) / det, t = (a01 * b0 - a00 * b1) / det;
    if (det > 1e-12 * a00 * a11 && s >= 0 && t >= 0 && s + t <= 1) best = std::min(best, at(s, t));
    return best;
}

double bruteForceDistance(const Vec3& q, const Mesh& mesh)
{
    double best = std::numeric_limits<double>::infinity();
    for (const Triangle& t : mesh.faces)
        best = std::min(
            best, bruteForceDistance(q, mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]));
    return best;
}

} // namespace

TEST(SurfaceDistance, OfConcentricSpheresIsTheDifferenceOfRadii)
{
    const SurfaceDistance d = compare(test::sphere(1, 6), test::sphere(1.1, 6));
    EXPECT_NEAR(d.diagonal, 2 * std::sqrt(3), 1e-12);
    EXPECT_NEAR(d.rmsRefToTest, 0.1, 1e-3);
    EXPECT_NEAR(d.rmsTestToRef, 0.1, 1e-3);
    EXPECT_NEAR(d.hausdorff(), 0.1, 1e-3);
    EXPECT_NEAR(d.maxRefToTestAt.norm(), 1.0, 1e-3);
    EXPECT_NEAR(d.maxTestToRefAt.norm(), 1.1, 1e-3);
    EXPECT_NEAR(d.psnr(), 20 * std::log10(2 * std::sqrt(3) / 0.1), 0.09);
}

TEST(SurfaceDistance, OfAShiftedSquareIsTheShift)
{
    const SurfaceDistance d = compare(test::square(3), moved(test::square(7), {0, 0, -0.25}));
    for (double x : {d.rmsRefToTest, d.rmsTestToRef, d.maxRefToTest, d.maxTestToRef, d.rms(), d.hausdorff()})
        EXPECT_NEAR(x, 0.25, 1e-14);
    EXPECT_NEAR(d.psnr(), 20 * std::log10(std::sqrt(2) / 0.25), 1e-12);
}

TEST(SurfaceDistance, OfASquareAndItsHalfIsOneSided)
{
    Mesh half = test::square(4);
    for (Vec3& p : half.positions) p[0] /= 2;
    const SurfaceDistance d = compare(test::square(4), half);
    EXPECT_NEAR(d.rmsRefToTest, std::sqrt(1.0 / 24), 2e-4); // the mean of max(0, x - 1/2)^2
    EXPECT_EQ(d.maxRefToTest, 0.5);                         // at vertices, which are looked at too
    EXPECT_EQ(d.maxRefToTestAt[0], 1);
    EXPECT_EQ(d.rmsTestToRef, 0);
    EXPECT_EQ(d.maxTestToRef, 0);
    EXPECT_EQ(d.rms(), d.rmsRefToTest);
    const SurfaceDistance swapped = compare(half, test::square(4));
    EXPECT_NEAR(swapped.rmsTestToRef, d.rmsRefToTest, 2e-4);
    EXPECT_NEAR(swapped.diagonal, std::sqrt(1.25), 1e-15);
}

/// The root mean square of f over the unit sphere, f a function of the height z = cos(theta).
template <class F> double rmsOverSphere(F f)
{
    constexpr int kSlices = 20000; // of equal area, by Archimedes
    double sum = 0;
    for (int i = 0; i < kSlices; ++i) sum += std::pow(f(-1 + (2 * i + 1.0) / kSlices), 2);
    return std::sqrt(sum / kSlices);
}

// The point of the unit sphere at height z is |sqrt(1 + d^2 - 2 d z) - 1| from the one shifted up by d.
TEST(SurfaceDistance, OfAShiftedSphereIsTheIntegral)
{
    for (double shift : {0.05, 0.4}) {
        const double expected =
            rmsOverSphere([shift](double z) { return std::sqrt(1 + shift * shift - 2 * shift * z) - 1; });
        const SurfaceDistance d =
            compare(test::sphere(1, 6), moved(test::sphere(1, 6), {0, 0, shift}), {.samples = 50000});
        EXPECT_NEAR(d.rmsRefToTest, expected, 0.01 * expected);
        EXPECT_NEAR(d.rmsTestToRef, expected, 0.01 * expected);
        EXPECT_NEAR(d.hausdorff(), shift, 0.01 * shift);
        EXPECT_NEAR(std::abs(d.maxRefToTestAt[2]), 1, 1e-6);
    }
}

TEST(SurfaceDistance, OfASurfaceToItselfIsZero)
{
    for (const Mesh& mesh :
         {test::sphere(3, 4), randomTriangles(200, 5), moved(test::torus(2, 1, 30, 20), {1e4, 0, 0})}) {
        const SurfaceDistance d = compare(mesh, mesh, {.samples = 20000});
        EXPECT_EQ(d.rms(), 0);
        EXPECT_EQ(d.hausdorff(), 0);
        EXPECT_EQ(d.psnr(), std::numeric_limits<double>::infinity());
    }
}

TEST(SurfaceDistance, SamplesSpreadEvenlyOverTheArea)
{
    // One big and many small triangles of the same area as it: how they are cut must not matter.
    const Mesh coarse = test::square(1), fine = test::square(60);
    Mesh wedge{{{0, 0, 0}, {0, 1, 0}, {1, 0, 1}, {1, 1, 1}},
               {{0, 2, 1}, {1, 2, 3}}}; // height x above the square
    EXPECT_NEAR(compare(coarse, wedge).rmsRefToTest, std::sqrt(1.0 / 3) / std::sqrt(2.0), 2e-4);
    EXPECT_NEAR(compare(fine, wedge).rmsRefToTest, std::sqrt(1.0 / 3) / std::sqrt(2.0), 2e-4);
}

// A triangle of almost no size measures the distance of a point.
TEST(SurfaceDistance, AgreesWithBruteForceOnRandomTriangles)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-2, 2);
    // Far from zero the tree's floats would be coarse, were it not for the frame.
    for (const Vec3& offset : {Vec3(0, 0, 0), Vec3(1e5, -3e5, 2e5)}) {
        const Mesh reference = moved(randomTriangles(300, 7), offset);
        const SurfaceMeasure measure(reference, {.samples = 16});
        for (int round = 0; round < 300; ++round) {
            Vec3 q = Vec3(place(random), place(random), place(random)) + offset;
            if (round % 3 == 0) // very near the surface, where culling errors show
                q = reference.positions[static_cast<size_t>(round)] + Vec3(1e-7, 2e-7, -1e-7);
            const Mesh point{{q, q + Vec3(1e-9, 0, 0), q + Vec3(0, 1e-9, 0)}, {{0, 1, 2}}};
            const Result<SurfaceDistance> d = measure.against(point);
            ASSERT_TRUE(d.ok()) << d.error().message;
            const double expected = bruteForceDistance(q, reference);
            EXPECT_NEAR(d->maxTestToRef, expected, 3e-9 + 1e-9 * expected) << round;
            EXPECT_NEAR(d->rmsTestToRef, expected, 3e-9 + 1e-9 * expected) << round;
        }
    }
}

TEST(SurfaceDistance, AgreesWithBruteForceOnSampledSurfaces)
{
    const Mesh a = randomTriangles(60, 1), b = randomTriangles(60, 2);
    double sum = 0, weight = 0;
    std::mt19937 random(9);
    std::uniform_real_distribution<double> unit(0, 1);
    for (const Triangle& t : a.faces) {
        const Vec3 &p = a.positions[t[0]], &q = a.positions[t[1]], &r = a.positions[t[2]];
        const double area = (q - p).cross(r - p).norm();
        constexpr int kSamples = 600;
        for (int i = 0; i < kSamples; ++i) {
            double u = unit(random), v = unit(random);
            if (u + v > 1) u = 1 - u, v = 1 - v;
            sum += area / kSamples * std::pow(bruteForceDistance(p + u * (q - p) + v * (r - p), b), 2);
        }
        weight += area;
    }
    const double expected = std::sqrt(sum / weight);
    EXPECT_NEAR(compare(a, b).rmsRefToTest, expected, 0.01 * expected);
    EXPECT_NEAR(compare(b, a).rmsTestToRef, expected, 0.01 * expected);
}

TEST(SurfaceDistance, QuantilesAreThoseOfTheSamples)
{
    Mesh wedge = test::square(1); // at height x, and x is spread evenly
    for (Vec3& p : wedge.positions) p[2] = p[0];
    for (double q : {0.001, 0.25, 0.5, 0.999, 1.0}) {
        const SurfaceDistance d = compare(wedge, test::square(1), {.samples = 100000, .quantile = q});
        EXPECT_NEAR(d.quantileRefToTest, q, 4e-3) << q;
        EXPECT_LE(d.quantileRefToTest, d.maxRefToTest);
    }
    EXPECT_EQ(compare(wedge, test::square(1)).quantileRefToTest, 0);
    EXPECT_FALSE(compareSurfaces(wedge, wedge, {.quantile = 1.1}).ok());
}

TEST(SurfaceDistance, DoesNotDependOnThreads)
{
    const Mesh a = test::torus(2, 1, 40, 30), b = test::torus(2.02, 0.98, 33, 27);
    const SurfaceDistance one = compare(a, b, {.samples = 30000, .threads = 1});
    for (int threads : {0, 2, 7}) {
        const SurfaceDistance d = compare(a, b, {.samples = 30000, .threads = threads});
        EXPECT_EQ(d.rmsRefToTest, one.rmsRefToTest);
        EXPECT_EQ(d.rmsTestToRef, one.rmsTestToRef);
        EXPECT_EQ(d.maxRefToTest, one.maxRefToTest);
        EXPECT_EQ(d.maxTestToRef, one.maxTestToRef);
        EXPECT_EQ(d.maxRefToTestAt, one.maxRefToTestAt);
        EXPECT_EQ(d.maxTestToRefAt, one.maxTestToRefAt);
    }
    const SurfaceDistance other = compare(a, b, {.samples = 30000, .seed = 2});
    EXPECT_NE(other.rmsRefToTest, one.rmsRefToTest);
    EXPECT_NEAR(other.rmsRefToTest, one.rmsRefToTest, 0.01 * one.rmsRefToTest);
}

TEST(SurfaceDistance, ScalesWithTheUnitAndIgnoresPlace)
{
    const Mesh a = test::torus(2, 1, 40, 30), b = test::torus(2.02, 0.98, 33, 27);
    const SurfaceDistance d = compare(a, b, {.samples = 20000});
    for (double scale : {1e-12, 1e12}) {
        Mesh scaledA = a, scaledB = b;
        for (Mesh* mesh : {&scaledA, &scaledB})
            for (Vec3& p : mesh->positions) p *= scale;
        const SurfaceDistance s = compare(scaledA, scaledB, {.samples = 20000});
        EXPECT_NEAR(s.rms() / scale, d.rms(), 1e-9 * d.rms());
        EXPECT_NEAR(s.psnr(), d.psnr(), 1e-8);
    }
    const Vec3 far(1e8, -1e8, 1e8);
    EXPECT_NEAR(compare(moved(a, far), moved(b, far), {.samples = 20000}).psnr(), d.psnr(), 1e-4);
}

namespace {

SurfaceDistance compareNormals(const Mesh& reference, const Mesh& test)
{
    return compare(reference, test, {.samples = 20000, .normals = true});
}

Mesh inverted(Mesh mesh)
{
    for (Triangle& t : mesh.faces) std::swap(t[1], t[2]);
    return mesh;
}

Mesh tilted(Mesh mesh, double degrees)
{
    const Eigen::AngleAxisd turn(degrees * std::numbers::pi / 180, Vec3::UnitX());
    for (Vec3& p : mesh.positions) p = turn * p;
    return mesh;
}

} // namespace

TEST(NormalError, OfATiltedSquareIsTheAngle)
{
    for (double degrees : {1e-6, 0.3, 12.5, 90.0, 135.0, 179.0}) {
        const SurfaceDistance d = compareNormals(test::square(3), tilted(test::square(5), degrees));
        for (const auto& error : {d.normalsRefToTest, d.normalsTestToRef}) {
            ASSERT_TRUE(error);
            EXPECT_NEAR(error->rms, degrees, 1e-12 * degrees + 1e-13);
            EXPECT_NEAR(error->mean, degrees, 1e-12 * degrees + 1e-13);
        }
        EXPECT_NEAR(*d.normalRms(), degrees, 1e-12 * degrees + 1e-13);
    }
}

TEST(NormalError, OfASurfaceToItselfIsZeroAndInsideOut180)
{
    for (const Mesh& mesh : {test::sphere(3, 4), test::torus(2, 1, 30, 20), test::band(30, true)}) {
        const SurfaceDistance same = compareNormals(mesh, mesh);
        EXPECT_NEAR(*same.normalRms(), 0, 1e-6);
        const SurfaceDistance other = compareNormals(mesh, inverted(mesh));
        EXPECT_NEAR(other.normalsRefToTest->mean, 180, 1e-6);
        EXPECT_NEAR(other.normalsTestToRef->rms, 180, 1e-6);
        EXPECT_EQ(other.rms(), 0);
    }
}

// A point p of the unit sphere and the centre of the one shifted by d span the angle of the normals.
TEST(NormalError, OfAShiftedSphereIsTheIntegral)
{
    for (double shift : {0.2, 0.4}) {
        const double expected = rmsOverSphere([shift](double z) {
            return std::atan2(shift * std::sqrt(1 - z * z), 1 - shift * z) * 180 / std::numbers::pi;
        });
        const SurfaceDistance d =
            compareNormals(test::sphere(1, 6), moved(test::sphere(1, 6), {0, 0, shift}));
        EXPECT_NEAR(d.normalsRefToTest->rms, expected, 0.01 * expected);
        EXPECT_NEAR(d.normalsTestToRef->rms, expected, 0.01 * expected);
        EXPECT_EQ(*d.normalRms(), std::max(d.normalsRefToTest->rms, d.normalsTestToRef->rms));
    }
}

TEST(NormalError, OfACoarseSphereHalvesWithItsEdges)
{
    const Mesh fine = test::sphere(1, 7);
    double last = *compareNormals(fine, test::sphere(1, 2)).normalRms();
    EXPECT_LT(last, 15);
    for (int level : {3, 4, 5}) {
        const double error = *compareNormals(fine, test::sphere(1, level)).normalRms();
        EXPECT_NEAR(last / error, 2, 0.15) << level;
        last = error;
    }
}

// A right angle seen from its outside: half of the samples near the edge have it as their nearest point.
TEST(NormalError, OnAnEdgeBothFacesWeighEqually)
{
    // The roof's two slopes fall by 45 degrees; the strip above its ridge faces up.
    const Mesh roof{{{0, -1, -1}, {1, -1, -1}, {0, 0, 0}, {1, 0, 0}, {0, 1, -1}, {1, 1, -1}},
                    {{0, 1, 3}, {0, 3, 2}, {2, 3, 5}, {2, 5, 4}}};
    Mesh strip = test::square(2);
    for (Vec3& p : strip.positions) p = Vec3(p[0], p[1] - 0.5, 1);
    EXPECT_NEAR(compareNormals(strip, roof).normalsRefToTest->rms, 0, 1e-12);
    EXPECT_NEAR(compareNormals(roof, strip).normalsRefToTest->rms, 45, 1e-12);
}

TEST(NormalError, DoesNotDependOnTheOrderOfFacesOrOnThreads)
{
    const Mesh a = test::torus(2, 1, 40, 30), b = randomTriangles(200, 3);
    Mesh shuffled = b;
    std::shuffle(shuffled.faces.begin(), shuffled.faces.end(), std::mt19937(5));
    const SurfaceDistance one = compare(a, b, {.samples = 20000, .threads = 1, .normals = true});
    EXPECT_NEAR(compare(a, shuffled, {.samples = 20000, .normals = true}).normalsRefToTest->rms,
                one.normalsRefToTest->rms, 1e-12);
    for (int threads : {0, 2, 5}) {
        const SurfaceDistance d = compare(a, b, {.samples = 20000, .threads = threads, .normals = true});
        EXPECT_EQ(d.normalsRefToTest->rms, one.normalsRefToTest->rms);
        EXPECT_EQ(d.normalsTestToRef->rms, one.normalsTestToRef->rms);
        EXPECT_EQ(d.normalsTestToRef->mean, one.normalsTestToRef->mean);
        EXPECT_EQ(d.rmsRefToTest, one.rmsRefToTest);
    }
    const SurfaceDistance without = compare(a, b, {.samples = 20000});
    EXPECT_EQ(without.rmsRefToTest, one.rmsRefToTest);
    EXPECT_EQ(without.maxTestToRef, one.maxTestToRef);
    EXPECT_FALSE(without.normalRms());
}

TEST(NormalError, IsMissingWhereThereAreNoNormals)
{
    const Mesh needle{{{0, 0, 0}, {1, 0, 0}, {0.5, 1e-11, 0}}, {{0, 1, 2}}};
    const SurfaceDistance d = compareNormals(needle, test::square(2));
    EXPECT_FALSE(d.normalsRefToTest || d.normalsTestToRef || d.normalRms());
    // A sheet with two sides has normals where it is sampled, and none together.
    Mesh sheet = test::square(2);
    for (const Triangle& t : inverted(sheet).faces) sheet.faces.push_back(t);
    const SurfaceDistance half = compareNormals(test::square(2), sheet);
    EXPECT_FALSE(half.normalsRefToTest || half.normalRms());
    ASSERT_TRUE(half.normalsTestToRef);
    EXPECT_NEAR(half.normalsTestToRef->mean, 90, 1); // 0 on one side, 180 on the other
}

TEST(SurfaceMeasure, IsWorthKeeping)
{
    const Mesh a = test::torus(2, 1, 40, 30), b = test::torus(2.02, 0.98, 33, 27);
    SurfaceMeasure first(a, {.samples = 5000});
    const SurfaceMeasure measure = std::move(first);
    for (int round = 0; round < 3; ++round) {
        const Result<SurfaceDistance> d = measure.against(b);
        ASSERT_TRUE(d.ok());
        EXPECT_EQ(d->rms(), compare(a, b, {.samples = 5000}).rms());
        EXPECT_EQ(measure.against(a)->rms(), 0);
    }
}

TEST(SurfaceDistance, RefusesWhatHasNoSurface)
{
    const Mesh good = test::square(1);
    const auto refusal = [](const Mesh& reference, const Mesh& test, const DistanceOptions& options = {}) {
        const Result<SurfaceDistance> d = compareSurfaces(reference, test, options);
        EXPECT_FALSE(d.ok());
        return d.ok() ? Error{} : d.error();
    };
    EXPECT_EQ(refusal(good, {}).kind, ErrorKind::EmptyMesh);
    EXPECT_EQ(refusal({}, good).message, "the reference mesh has no faces");
    const Mesh flat{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
    EXPECT_EQ(refusal(flat, good).message, "the reference mesh has no area");
    EXPECT_EQ(refusal(good, flat).message, "the test mesh has no area");
    Mesh bad = good;
    bad.faces[1][2] = 4;
    EXPECT_EQ(refusal(good, bad).message, "the test mesh: face 1 names vertex 4 of 4");
    bad = good;
    bad.positions[3][2] = std::nan("");
    EXPECT_EQ(refusal(bad, good).kind, ErrorKind::NotFinite);
    EXPECT_EQ(refusal(good, moved(good, {1e12, 0, 0})).kind, ErrorKind::BadArgument);
    EXPECT_EQ(refusal(good, good, {.samples = 0}).message, "no samples");
    bad.positions[3][2] = 1e308;
    bad.positions[0][2] = -1e308;
    EXPECT_FALSE(compareSurfaces(bad, good).ok());
    EXPECT_FALSE(compareSurfaces(good, bad).ok());
}

#include "gimg/holomorphic.h"
#include "gimg/mesh_io.h"
#include "gimg/periods.h"

#include "known_surfaces.h"
#include "shapes.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>

namespace gimg {
namespace {

using Complex = std::complex<double>;
constexpr Complex kI(0, 1);

ConformalOptions unsplit()
{
    ConformalOptions options;
    options.starResidual = std::numeric_limits<double>::infinity();
    return options;
}

ConformalStructure structureOf(const PolyhedralSurface& surface, const ConformalOptions& options = {})
{
    Result<ConformalStructure> structure = conformalStructure(surface, options);
    EXPECT_TRUE(structure.ok()) << (structure.ok() ? "" : structure.error().message);
    return structure.ok() ? std::move(*structure) : ConformalStructure{};
}

ConformalStructure structureOf(const Mesh& mesh, const ConformalOptions& options = {})
{
    return structureOf(polyhedralSurface(mesh), options);
}

// tau = i r / sqrt(R^2 - r^2) for the torus of revolution.
double modulusError(const Mesh& torus)
{
    const Complex tau = structureOf(torus, unsplit()).periodMatrix(0, 0);
    const Complex known = kI / std::sqrt(8.0);
    return std::abs(-1.0 / *reducedModulus(tau) - known);
}

TEST(TorusOfRevolution, ModulusConvergesQuadratically)
{
    const double coarse = modulusError(shapes::torus(3, 1, 32, 64)),
                 fine = modulusError(shapes::torus(3, 1, 64, 128));
    EXPECT_LT(fine, coarse / 3.9);
    EXPECT_LT(fine, 2e-4);
}

TEST(TorusOfRevolution, MovedVerticesAndIrregularMeshesConvergeToo)
{
    for (const bool irregular : {false, true}) {
        const auto errorAt = [&](int n) {
            return modulusError(known::roughTorus(3, 1, 2 * n, n, 0.3, irregular, 7));
        };
        const double coarse = errorAt(32), fine = errorAt(64);
        EXPECT_LT(fine, coarse / 3.4);
        EXPECT_LT(fine, 5e-4);
    }
}

// Thesis §8.2.3: a torus of 1,089 vertices has an angle of 89.9874 degrees.
TEST(TorusOfRevolution, HasARightAngle)
{
    for (const double off : {0.0, 0.2}) {
        const Mesh torus = known::roughTorus(3, 1, 33, 33, off, off > 0, 2);
        ASSERT_EQ(torus.vertexCount(), 1089);
        const ShapeFactors shape = *shapeFactors(structureOf(torus, unsplit()).periodMatrix(0, 0));
        EXPECT_NEAR(shape.angleDegrees, 89.99, 0.05);
        EXPECT_NEAR(shape.lengthRatio, std::sqrt(8.0), 0.02);
    }
}

struct Known
{
    const char* name;
    Eigen::MatrixXcd periods;
    PolyhedralSurface (*symmetric)(int n);
    PolyhedralSurface (*irregular)(int n);
};

Eigen::Matrix2cd matrix(Complex a, Complex b, Complex c)
{
    Eigen::Matrix2cd m;
    m << a, b, b, c;
    return m;
}

// Three squares in an L. Its rotation by a right angle, composed with a move of the squares, is an
// automorphism rho of order 4. The classes h1 - h2 and v1 - v3 of sides have no length in the plane, so that
// dz vanishes on them; on what meets neither, 2 h1 + h2 and 2 v1 + v3, the other eigenform of rho vanishes.
// With a = (h1, h2) and b = (v1 + v3, v1) the periods are (1, 1; 2i, i) and (1, -2; i, -i), hence this
// matrix. It is Sp(4, Z)-equivalent to i/3 [5 -4; -4 5] of Bobenko, Mercat, Schmies 2011.
const Known kThreeSquares{"three squares", matrix(5.0 * kI / 3.0, kI / 3.0, 2.0 * kI / 3.0),
                          [](int n) {
                              return known::squareTiled({1, 0, 2}, {2, 1, 0}, n);
                          },
                          [](int n) {
                              return known::squareTiled({1, 0, 2}, {2, 1, 0}, n, 0.2, 1.4);
                          }};

// Lawson's surface of genus 2, y^2 = x^6 - 1.
const Known kLawson{"Lawson",
                    matrix(2.0 * kI / std::sqrt(3.0), -kI / std::sqrt(3.0), 2.0 * kI / std::sqrt(3.0)),
                    [](int n) { return known::coverOverEquator(6, n); },
                    [](int n) { return known::coverOverEquator(6, n, 0.2, 1.8); }};

// y^2 = x^5 - x, with the most automorphisms of genus 2.
const Known kBolza{
    "Bolza",
    matrix(Complex(-2, std::sqrt(8)) / 3.0, Complex(1, -std::sqrt(2)) / 3.0, Complex(-2, std::sqrt(8)) / 3.0),
    [](int n) { return known::coverOverOctahedron(n); },
    [](int n) { return known::coverOverOctahedron(n, 0.2, 1.8); }};

const Known kAllKnown[] = {kThreeSquares, kLawson, kBolza};

double distanceTo(const Known& known, const ConformalStructure& structure)
{
    EquivalenceOptions options;
    options.tolerance = 0.3;
    const Result<Equivalence> found = conformallyEquivalent(structure.periodMatrix, known.periods, options);
    EXPECT_TRUE(found.ok() && found->exhaustive);
    return found.ok() ? found->distance : std::numeric_limits<double>::infinity();
}

// Meshes with the surface's symmetries: these alone determine the period matrix, at any resolution.
TEST(KnownPeriods, SymmetricMeshesHaveThemExactly)
{
    for (const Known& known : kAllKnown)
        for (const int n : {3, 6})
            EXPECT_LT(distanceTo(known, structureOf(known.symmetric(n), unsplit())), 1e-12) << known.name;
}

TEST(KnownPeriods, IrregularMeshesConvergeToThem)
{
    for (const Known& known : kAllKnown) {
        std::vector<double> distances, residuals;
        for (const int n : {3, 6, 12, 24}) {
            const ConformalStructure structure = structureOf(known.irregular(n), unsplit());
            distances.push_back(distanceTo(known, structure));
            residuals.push_back(structure.starResidual);
        }
        for (size_t i = 1; i < distances.size(); ++i) {
            EXPECT_LT(distances[i], distances[i - 1]) << known.name << " " << i;
            EXPECT_LT(residuals[i], residuals[i - 1] / 1.5) << known.name << " " << i;
        }
        EXPECT_LT(distances.back(), distances.front() / 8) << known.name;
        EXPECT_LT(distances.back(), 3e-4) << known.name;
    }
}

// Its triangles are flat already: the distance is all of the computation's making, and the residual bounds
// it.
TEST(KnownPeriods, SplittingReachesTheResidualAskedFor)
{
    const PolyhedralSurface surface = kThreeSquares.irregular(5);
    for (const double residual : {0.03, 0.003}) {
        ConformalOptions options;
        options.starResidual = residual;
        const ConformalStructure structure = structureOf(surface, options);
        EXPECT_LE(structure.starResidual, residual);
        EXPECT_LE(distanceTo(kThreeSquares, structure), 0.02 * residual);
        EXPECT_LT(structure.triangles, 90 / residual);
        EXPECT_EQ(structure.harmonic[0].size(), 3 * surface.faceCount());
    }
    ConformalOptions bounded;
    bounded.starResidual = 1e-3;
    bounded.mostTriangles = 2000;
    const ConformalStructure structure = structureOf(surface, bounded);
    EXPECT_LE(structure.triangles, 2500);
    EXPECT_GT(structure.starResidual, 1e-3);
    for (const int n : {3, 6, 12}) {
        const ConformalStructure coarse = structureOf(kThreeSquares.irregular(n), unsplit());
        EXPECT_LE(distanceTo(kThreeSquares, coarse), 0.5 * std::log1p(coarse.starResidual));
    }
}

TEST(KnownPeriods, AreToldApart)
{
    for (const Known& one : kAllKnown)
        for (const Known& other : kAllKnown) {
            const Result<Equivalence> found = conformallyEquivalent(one.periods, other.periods);
            ASSERT_TRUE(found.ok());
            EXPECT_TRUE(found->exhaustive);
            EXPECT_EQ(found->equivalent, one.name == other.name) << one.name << " " << other.name;
        }
}

TEST(ConformalStructure, FormsHaveThePeriodsTheySay)
{
    for (int genus = 1; genus <= 3; ++genus) {
        const Mesh mesh = shapes::surfaceOfGenus(genus, 0, 6);
        const ConformalStructure structure = structureOf(mesh);
        ASSERT_EQ(structure.genus, genus);
        const int g = genus;
        for (int j = 0; j < 2 * g; ++j) {
            EXPECT_LT(closednessError(structure.harmonic[j]), 1e-12);
            for (int k = 0; k < g; ++k) {
                EXPECT_NEAR(integrate(structure.harmonic[j], structure.loops.a[k].halfedges), j == k, 1e-11);
                EXPECT_NEAR(integrate(structure.harmonic[j], structure.loops.b[k].halfedges), j == g + k,
                            1e-11);
            }
        }
        for (int j = 0; j < g; ++j) {
            EXPECT_LT(closednessError(structure.holomorphic[j]), 1e-12);
            for (int k = 0; k < g; ++k) {
                const Complex a = integrate(structure.holomorphic[j], structure.loops.a[k].halfedges);
                const Complex b = integrate(structure.holomorphic[j], structure.loops.b[k].halfedges);
                EXPECT_LT(std::abs(a - (j == k ? 1.0 : 0.0)), 1e-11);
                EXPECT_LT(std::abs(b - structure.periodMatrix(k, j)), 1e-11);
            }
        }
        EXPECT_LT((structure.star * structure.star + Eigen::MatrixXd::Identity(2 * g, 2 * g)).norm(), 1e-12);
    }
}

// |Im w - *Re w|^2 over |w|^2: the imaginary part is the real part turned by a right angle.
TEST(ConformalStructure, HolomorphicFormsAreConformal)
{
    const auto error = [](int n) {
        const Mesh mesh = shapes::surfaceOfGenus(2, 0, n);
        const PolyhedralSurface surface = polyhedralSurface(mesh);
        const ConformalStructure structure = structureOf(surface, unsplit());
        double worst = 0;
        for (const ComplexOneForm& form : structure.holomorphic) {
            const OneForm re = form.real(), im = form.imag();
            const double both = starWedge(surface, re, re) + starWedge(surface, im, im);
            worst = std::max(worst, 1 - 2 * wedge(re, im) / both);
        }
        return worst;
    };
    const double coarse = error(8), fine = error(16);
    EXPECT_GT(fine, 0);
    EXPECT_LT(fine, 2e-3);
    EXPECT_LT(fine, coarse / 3);
}

TEST(ConformalStructure, RiemannsRelationsHoldBetterOnFinerMeshes)
{
    for (int genus = 1; genus <= 4; ++genus) {
        Mesh mesh = shapes::surfaceOfGenus(genus, 0, 3);
        const ConformalStructure coarse = structureOf(mesh, unsplit()),
                                 fine = structureOf(known::splitInFour(mesh), unsplit());
        for (const ConformalStructure* structure : {&coarse, &fine}) {
            const Eigen::MatrixXd imaginary = structure->periodMatrix.imag();
            EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(imaginary).eigenvalues()[0], 0.05);
            EXPECT_EQ(structure->periodMatrix, structure->periodMatrix.transpose());
        }
        EXPECT_LT(fine.starResidual, coarse.starResidual / 2.5);
        EXPECT_LT(fine.starResidual, 2e-2);
        EXPECT_LT(fine.asymmetry, 2e-3);
    }
    double before = 1;
    for (const int n : {3, 6, 12}) {
        const ConformalStructure cover = structureOf(known::coverOverEquator(8, n, 0.2, 1.8), unsplit());
        EXPECT_LT(cover.asymmetry, before / 2);
        before = cover.asymmetry;
    }
}

Mesh corpusMesh(const std::string& name)
{
    const char* folder = std::getenv("GIMG_CORPUS_DIR");
    const std::string path = folder != nullptr ? folder : std::string(GIMG_SOURCE_CORPUS) + "/cache";
    Result<MeshFile> read = readMesh(path + "/" + name);
    EXPECT_TRUE(read.ok()) << read.error().message << " (corpus/fetch brings it)";
    return read.ok() ? std::move(read->mesh) : Mesh{};
}

TEST(ConformalStructure, MachinePartsReachTheResidualBySplits)
{
    for (const auto& [name, genus] :
         {std::pair("eight.off", 2), std::pair("helmet.off", 3), std::pair("anchor.off", 4)}) {
        const Mesh mesh = corpusMesh(name);
        const ConformalStructure raw = structureOf(mesh, unsplit()), split = structureOf(mesh);
        EXPECT_EQ(raw.genus, genus);
        EXPECT_EQ(raw.triangles, mesh.faceCount());
        EXPECT_GT(raw.starResidual, 0.015);
        EXPECT_LE(split.starResidual, 0.01);
        EXPECT_LT(split.triangles, mesh.faceCount() + 8000);
        const Eigen::MatrixXd imaginary = split.periodMatrix.imag();
        EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(imaginary).eigenvalues()[0], 0.5);
        // Both are within their bounds of the same matrix.
        const double apart =
            conformallyEquivalent(raw.periodMatrix, split.periodMatrix, {.tolerance = 0.2})->distance;
        EXPECT_LE(apart, 0.5 * (std::log1p(raw.starResidual) + std::log1p(split.starResidual)));
    }
}

// A loop takes the other way around faces beside it, here and there: the same class, another cut.
Loop moved(const Halfedges& he, const Loop& loop, std::mt19937& random, int times)
{
    std::vector<int> walk = loop.halfedges;
    for (int i = 0; i < times; ++i) {
        const size_t at = random() % walk.size();
        const int h = random() % 2 == 0 ? walk[at] : he.twin(walk[at]);
        const bool turned = h != walk[at];
        std::vector<int> detour{he.twin(Halfedges::prev(h)), he.twin(Halfedges::next(h))};
        if (turned) detour = {Halfedges::next(h), Halfedges::prev(h)};
        walk[at] = detour[0];
        walk.insert(walk.begin() + static_cast<long>(at) + 1, detour[1]);
    }
    return Loop{walk};
}

TEST(ConformalStructure, DoesNotDependOnTheCut)
{
    const Mesh mesh = shapes::surfaceOfGenus(3, 0, 8);
    const PolyhedralSurface surface = polyhedralSurface(mesh);
    const Halfedges he(mesh.faces, mesh.vertexCount());
    const ConformalStructure before = structureOf(surface);
    std::mt19937 random(4);
    CanonicalBasis other = before.loops;
    for (std::vector<Loop>* loops : {&other.a, &other.b})
        for (Loop& loop : *loops) loop = moved(he, loop, random, 300);
    const Result<ConformalStructure> after = conformalStructure(surface, other);
    ASSERT_TRUE(after.ok()) << after.error().message;
    double largest = 0;
    for (int j = 0; j < 3; ++j)
        largest = std::max(largest, (after->holomorphic[j] - before.holomorphic[j]).cwiseAbs().maxCoeff());
    EXPECT_GT(largest, 0); // it was another computation
    EXPECT_LT(largest, 1e-8);
    EXPECT_LT((after->periodMatrix - before.periodMatrix).norm(), 1e-8);
    std::swap(other.a[0], other.b[0]);
    EXPECT_EQ(conformalStructure(surface, other).error().kind, ErrorKind::BadArgument);
}

TEST(ConformalStructure, DoesNotDependOnTheResolution)
{
    const Mesh coarse = shapes::surfaceOfGenus(2, 0, 14), fine = shapes::surfaceOfGenus(2, 0, 22);
    EXPECT_NEAR(coarse.faceCount(), 20'000, 1'000);
    EXPECT_NEAR(fine.faceCount(), 50'000, 2'000);
    const Result<Equivalence> found =
        conformallyEquivalent(structureOf(coarse).periodMatrix, structureOf(fine).periodMatrix);
    ASSERT_TRUE(found.ok());
    EXPECT_TRUE(found->equivalent);
    EXPECT_LT(found->distance, 0.02);
}

TEST(ConformalStructure, IsTheSameInEveryRun)
{
    const Mesh mesh = known::roughTorus(3, 1, 20, 12, 0.4, true, 5);
    const ConformalStructure one = structureOf(mesh), other = structureOf(mesh);
    EXPECT_EQ(one.periodMatrix, other.periodMatrix);
    EXPECT_EQ(one.holomorphic[0], other.holomorphic[0]);
}

TEST(ConformalStructure, ProgressGrowsToOne)
{
    std::vector<double> seen;
    ConformalOptions options;
    options.progress = [&](double done) { seen.push_back(done); };
    structureOf(shapes::surfaceOfGenus(2, 0, 3), options);
    ASSERT_GT(seen.size(), 2u);
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    EXPECT_EQ(seen.back(), 1);
}

} // namespace
} // namespace gimg

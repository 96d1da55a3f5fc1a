#include "gimg/harmonic.h"
#include "gimg/one_form.h"

#include "known_surfaces.h"
#include "shapes.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace gimg {
namespace {

OneForm randomExact(const Halfedges& he, int vertices, uint32_t seed)
{
    std::mt19937 random(seed);
    Eigen::VectorXd f(vertices);
    for (double& value : f) value = 2.0 * static_cast<double>(random()) / std::mt19937::max() - 1;
    return exteriorDerivative(he, f);
}

HarmonicSolver solverOf(const PolyhedralSurface& surface)
{
    Result<HarmonicSolver> solver = HarmonicSolver::of(surface);
    EXPECT_TRUE(solver.ok());
    return std::move(*solver);
}

TEST(OneForm, DifferencesAreClosedAndHaveNoPeriods)
{
    const Mesh torus = shapes::torus(3, 1, 12, 8);
    const Halfedges he(torus.faces, torus.vertexCount());
    const OneForm df = randomExact(he, torus.vertexCount(), 3);
    EXPECT_LT(closednessError(df), 1e-15);
    const std::vector<Loop> loops = *homologyBasis(torus);
    for (const Loop& loop : loops) EXPECT_NEAR(integrate(df, loop.halfedges), 0, 1e-14);
    const OneForm dual = poincareDual(he, loops.front());
    EXPECT_NEAR(wedge(df, dual), 0, 1e-13);
    EXPECT_GT(starWedge(polyhedralSurface(torus), df, df), 1);
}

// The form that is a dx + b dy on a triangle in the plane.
TEST(OneForm, ProductsOnATriangleAreThoseOfConstantForms)
{
    const Mesh mesh{{{0, 0, 0}, {3, 0.5, 0}, {1, 2, 0}}, {{0, 1, 2}}};
    const double area = surfaceArea(mesh);
    const auto constant = [&](double a, double b) {
        OneForm form(3);
        for (int k = 0; k < 3; ++k)
            form[k] = (mesh.positions[(k + 1) % 3] - mesh.positions[k]).dot(Vec3(a, b, 0));
        return form;
    };
    const PolyhedralSurface surface = polyhedralSurface(mesh);
    const OneForm v = constant(0.7, -1.1), w = constant(2, 0.3);
    EXPECT_NEAR(wedge(v, w, 0), area * (0.7 * 0.3 + 1.1 * 2), 1e-14);
    EXPECT_NEAR(starWedge(surface, v, w, 0), area * (0.7 * 2 - 1.1 * 0.3), 1e-14);
    EXPECT_NEAR(wedge(v, constant(1.1, 0.7), 0), starWedge(surface, v, v, 0), 1e-14); // the star of v
    // Thesis eq. 47, with the c it lacks in its last entry.
    const double a = surface.lengths[0], b = surface.lengths[1], c = surface.lengths[2];
    const double aa = a * a, bb = b * b, cc = c * c;
    Eigen::Matrix3d m;
    m << 2 * (bb + cc), aa + bb - cc, aa + cc - bb, bb + aa - cc, 2 * (cc + aa), bb + cc - aa, cc + aa - bb,
        cc + bb - aa, 2 * (aa + bb);
    EXPECT_NEAR(v.dot(m * w) / (24 * area), starWedge(surface, v, w, 0), 1e-14);
}

// On a flat torus they are dx and dy, whatever the triangles.
TEST(Harmonic, FlatTorusHasConstantForms)
{
    const PolyhedralSurface torus = known::squareTiled({1, 0}, {0, 1}, 6, 0.24); // 2 x 1
    const Halfedges he(torus.faces, torus.vertexCount);
    const CanonicalBasis basis = *canonicalBasis(torus);
    const HarmonicSolver solver = solverOf(torus);
    const HarmonicForms forms = *solver.harmonic(dualBasis(he, basis));
    const Eigen::MatrixXd energies = solver.energies(forms.onTriangulation);
    // One loop is 1 long and the other 2, at right angles up to a multiple of the first.
    EXPECT_NEAR(energies.determinant(), 1, 1e-12);
    EXPECT_NEAR(std::min(energies(0, 0), energies(1, 1)), 0.5, 1e-12);
    for (const OneForm& form : forms.onTriangulation) EXPECT_LT(solver.divergence(form), 1e-13);
    for (int i = 0; i < 2; ++i) {
        EXPECT_LT(closednessError(forms.onSurface[i]), 1e-13);
        EXPECT_NEAR(integrate(forms.onSurface[i], basis.a[0].halfedges), i == 0 ? 1 : 0, 1e-13);
        EXPECT_NEAR(integrate(forms.onSurface[i], basis.b[0].halfedges), i == 1 ? 1 : 0, 1e-13);
    }
}

TEST(Harmonic, DependsOnTheClassOnly)
{
    const Mesh mesh = shapes::surfaceOfGenus(2, 0, 6);
    const Halfedges he(mesh.faces, mesh.vertexCount());
    const HarmonicSolver solver = solverOf(polyhedralSurface(mesh));
    const OneForm dual = poincareDual(he, homologyBasis(mesh)->front());
    const OneForm moved = dual + randomExact(he, mesh.vertexCount(), 9);
    const HarmonicForms forms = *solver.harmonic(std::vector{dual, moved});
    EXPECT_LT((forms.onSurface[0] - forms.onSurface[1]).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((forms.onTriangulation[0] - forms.onTriangulation[1]).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Harmonic, DiffusionGoesTheSameWaySlowly)
{
    const Mesh torus = shapes::torus(3, 1, 18, 12);
    const Halfedges he(torus.faces, torus.vertexCount());
    const HarmonicSolver solver = solverOf(polyhedralSurface(torus));
    const OneForm dual = poincareDual(he, homologyBasis(torus)->front());
    const OneForm harmonic = solver.harmonic(std::vector{dual})->onSurface[0];
    const auto errorAfter = [&](int steps) {
        return (diffused(solver.triangulation(), he, dual, steps) - harmonic).norm() / harmonic.norm();
    };
    EXPECT_GT(errorAfter(200), 1e-2);
    EXPECT_LT(errorAfter(2000), 1e-4);
    EXPECT_LT(errorAfter(8000), 1e-12);
}

TEST(Harmonic, SplittingLowersTheEnergyTowardsTheSurfaces)
{
    // The flat surface of three squares: the energy of a class is known (see holomorphic_test.cpp), and a
    // cone of 1080 degrees makes coarse triangles bad.
    const PolyhedralSurface surface = known::squareTiled({1, 0, 2}, {2, 1, 0}, 6);
    const Halfedges he(surface.faces, surface.vertexCount);
    const std::vector<OneForm> dual{poincareDual(he, homologyBasis(surface)->front())};
    HarmonicSolver solver = solverOf(surface);
    double energy = solver.energies(solver.harmonic(dual)->onTriangulation)(0, 0);
    for (int round = 0; round < 3; ++round) {
        const int before = solver.triangulation().faceCount();
        ASSERT_TRUE(solver.refine(Eigen::VectorXd::Constant(before, 4)).ok());
        EXPECT_GE(solver.triangulation().faceCount(), 3 * before);
        EXPECT_LE(solver.triangulation().faceCount(), 6 * before);
        const HarmonicForms forms = *solver.harmonic(dual);
        const double finer = solver.energies(forms.onTriangulation)(0, 0);
        EXPECT_LT(finer, energy);
        EXPECT_LT(closednessError(forms.onSurface[0]), 1e-12);
        EXPECT_LT(solver.divergence(forms.onTriangulation[0]), 1e-12);
        energy = finer;
    }
    EXPECT_EQ(solver.refine(Eigen::VectorXd::Ones(3)).error().kind, ErrorKind::BadArgument);
}

} // namespace
} // namespace gimg

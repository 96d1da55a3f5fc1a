#include "gimg/global_parameterization.h"

#include "forms_of.h"
#include "shapes.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace gimg {
namespace {

using test::formsOf;

PlaneMap planeOf(const Mesh& mesh, const ComplexOneForm& form)
{
    Result<PlaneMap> plane = integrateOverDisk(mesh, form);
    EXPECT_TRUE(plane.ok()) << plane.error().message;
    return std::move(*plane);
}

// How far z is from the integer combinations of 1 and tau.
double offLattice(std::complex<double> z, std::complex<double> tau)
{
    const double n = z.imag() / tau.imag(), m = z.real() - n * tau.real();
    return std::max(std::abs(n - std::round(n)), std::abs(m - std::round(m)));
}

TEST(PlaneMap, OfATorusJumpsByItsLattice)
{
    const Mesh torus = shapes::torus(3, 1, 40, 20);
    const SurfaceForms forms = formsOf(torus);
    const PlaneMap plane = planeOf(torus, forms.basis[0]);
    EXPECT_LT(plane.jumpError, 1e-10);
    double largest = 0;
    for (const std::complex<double>& jump : plane.jumps) {
        EXPECT_LT(offLattice(jump, forms.structure.periodMatrix(0, 0)), 1e-9);
        largest = std::max(largest, std::abs(jump));
    }
    EXPECT_GT(largest, 0.9);
    // Inside a face the map has the form's differences.
    for (int f = 0; f < torus.faceCount(); ++f)
        for (int k = 0; k < 3; ++k) {
            const Vec2 d = plane.map.at(f, (k + 1) % 3) - plane.map.at(f, k);
            EXPECT_LT(std::abs(std::complex<double>(d[0], d[1]) - forms.basis[0][3 * f + k]), 1e-10);
        }
    // A torus has no branch point, and so no flipped triangle; its image has the area of the parallelogram.
    double area = 0;
    for (int f = 0; f < torus.faceCount(); ++f) {
        const Vec2 a = plane.map.at(f, 1) - plane.map.at(f, 0), b = plane.map.at(f, 2) - plane.map.at(f, 0);
        EXPECT_GT(a[0] * b[1] - a[1] * b[0], 0);
        area += (a[0] * b[1] - a[1] * b[0]) / 2;
    }
    EXPECT_NEAR(area, forms.structure.periodMatrix(0, 0).imag(), 1e-10);
}

// Jumps are half the story for genus > 1: they are integer combinations of the 2g columns of periods.
TEST(PlaneMap, JumpsArePeriods)
{
    const Mesh mesh = shapes::surfaceOfGenus(2, 0, 6);
    const SurfaceForms forms = formsOf(mesh);
    std::vector<std::vector<std::complex<double>>> jumps;
    for (const ComplexOneForm& form : forms.basis) {
        const PlaneMap plane = planeOf(mesh, form);
        EXPECT_LT(plane.jumpError, 1e-10);
        jumps.push_back(plane.jumps);
    }
    // Rows: real and imaginary part of both forms; columns: periods along a1, a2, b1, b2.
    Eigen::Matrix4d periods;
    const Eigen::MatrixXcd& z = forms.structure.periodMatrix;
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) {
            periods(2 * i, j) = i == j;
            periods(2 * i + 1, j) = 0;
            periods(2 * i, 2 + j) = z(j, i).real();
            periods(2 * i + 1, 2 + j) = z(j, i).imag();
        }
    int crossing = 0;
    for (size_t p = 0; p < jumps[0].size(); ++p) {
        const Eigen::Vector4d jump(jumps[0][p].real(), jumps[0][p].imag(), jumps[1][p].real(),
                                   jumps[1][p].imag());
        const Eigen::Vector4d whole = periods.partialPivLu().solve(jump);
        EXPECT_LT((whole - whole.array().round().matrix()).norm(), 1e-8);
        crossing += whole.norm() > 0.5;
    }
    EXPECT_GE(crossing, 4);
}

TEST(PlaneMap, AngleErrorFallsWithRefinement)
{
    const auto error = [](int n) {
        const Mesh torus = shapes::torus(3, 1, 2 * n, n);
        return angleErrors(torus, formsOf(torus).basis[0], {});
    };
    const AngleErrors coarse = error(16), fine = error(32);
    EXPECT_EQ(coarse.flipped + fine.flipped, 0);
    EXPECT_EQ(fine.faces, 4 * 32 * 32);
    EXPECT_LT(fine.medianDegrees, coarse.medianDegrees);
    EXPECT_LT(fine.degrees95, coarse.degrees95 / 1.9);
    EXPECT_LT(fine.medianDegrees, 1);
    EXPECT_LT(fine.quasiConformalRatio - 1, (coarse.quasiConformalRatio - 1) / 1.9);
}

TEST(PlaneMap, AngleErrorFallsWithRefinementAwayFromBranchPoints)
{
    const auto error = [](int n) {
        const Mesh mesh = shapes::surfaceOfGenus(2, 0, n);
        const UniformForm even = *mostUniformForm(mesh, formsOf(mesh).basis, false);
        const Result<BranchPoints> found = branchPoints(mesh, even.form);
        std::vector<int> branches;
        for (const BranchPoint& point : found->points) branches.push_back(point.vertex);
        return angleErrors(mesh, even.form, branches);
    };
    const AngleErrors coarse = error(8), fine = error(16);
    EXPECT_LT(fine.medianDegrees, coarse.medianDegrees / 1.6);
    EXPECT_LT(fine.medianDegrees, 2);
    EXPECT_EQ(fine.flipped, 0);
}

// A polygonal cylinder is flat: its map is an isometry, so all of it is known but the scale.
TEST(PlaneMap, OfACylinderIsARectangle)
{
    const int nu = 24;
    const Mesh cylinder = shapes::cylinder(1, 2, nu, 8);
    const SurfaceForms forms = formsOf(cylinder);
    ASSERT_EQ(forms.basis.size(), 1u);
    const Result<UniformForm> even = mostUniformForm(cylinder, forms.basis, true);
    ASSERT_TRUE(even.ok());
    EXPECT_NEAR(even->unevenness, 0, 1e-12);
    const PlaneMap plane = planeOf(cylinder, even->form);
    double low = 1e9, high = -1e9, jump = 0;
    for (const Vec2& uv : plane.map.uv) low = std::min(low, uv[1]), high = std::max(high, uv[1]);
    for (const std::complex<double>& z : plane.jumps) {
        EXPECT_NEAR(z.imag(), 0, 1e-10);
        jump = std::max(jump, std::abs(z));
    }
    EXPECT_NEAR(high - low, 2, 1e-9);
    EXPECT_NEAR(jump, nu * 2 * std::sin(std::numbers::pi / nu), 1e-9);
    for (int f = 0; f < cylinder.faceCount(); ++f)
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR((plane.map.at(f, (k + 1) % 3) - plane.map.at(f, k)).norm(),
                        (cylinder.positions[cylinder.faces[f][(k + 1) % 3]] -
                         cylinder.positions[cylinder.faces[f][k]])
                            .norm(),
                        1e-9);
}

TEST(PlaneMap, BoundariesAreHorizontal)
{
    const Mesh mesh = shapes::surfaceOfGenus(1, 3, 6);
    const SurfaceForms forms = formsOf(mesh);
    ASSERT_EQ(forms.basis.size(), 4u);
    const Halfedges he(mesh.faces, mesh.vertexCount());
    for (const ComplexOneForm& form : forms.basis)
        for (int h = 0; h < he.count(); ++h) {
            if (he.onBoundary(h))
                EXPECT_NEAR(form[h].imag(), 0, 1e-9);
            else
                EXPECT_LT(std::abs(form[h] + form[he.twin(h)]), 1e-9);
        }
}

TEST(SurfaceForms, Refusals)
{
    EXPECT_EQ(surfaceForms(shapes::sphere(1, 4)).error().kind, ErrorKind::WrongGenus);
    EXPECT_EQ(surfaceForms(shapes::disk(1, 4)).error().kind, ErrorKind::WrongGenus);
    EXPECT_EQ(integrateOverDisk(shapes::torus(2, 1, 6, 6), ComplexOneForm::Ones(7)).error().kind,
              ErrorKind::BadArgument);
}

} // namespace
} // namespace gimg

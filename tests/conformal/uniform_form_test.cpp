#include "gimg/global_parameterization.h"

#include "forms_of.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace gimg {
namespace {

using test::formsOf;

// d(x + i y) of a flat plate scales nothing; d(x + 2 i y) scales areas by (1 + 4) / 2.
TEST(ConformalFactor, OfPlainForms)
{
    const Mesh disk = shapes::disk(2, 5);
    const Halfedges he(disk.faces, disk.vertexCount());
    ComplexOneForm form(he.count());
    for (int h = 0; h < he.count(); ++h) {
        const Vec3 d = disk.positions[he.head(h)] - disk.positions[he.tail(h)];
        form[h] = {d.x(), 2 * d.y()};
    }
    for (double factor : conformalFactor(disk, form)) EXPECT_NEAR(factor, 2.5, 1e-12);
    EXPECT_NEAR(unevenness(disk, form), 0, 1e-12);
    for (int h = 0; h < he.count(); ++h) form[h].imag(form[h].imag() / 2);
    for (double stretch : vertexStretch(disk, form)) EXPECT_NEAR(stretch, 1, 1e-12);
}

// Half the area scaled by 9, half by 1: log 5 - log 9 / 2.
TEST(ConformalFactor, UnevennessOfTwoScales)
{
    const Mesh pair{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    ComplexOneForm form(6);
    for (int f = 0; f < 2; ++f)
        for (int k = 0; k < 3; ++k) {
            const Vec3 d = pair.positions[pair.faces[f][(k + 1) % 3]] - pair.positions[pair.faces[f][k]];
            form[3 * f + k] = std::complex<double>(d.x(), d.y()) * (f == 0 ? 3.0 : 1.0);
        }
    EXPECT_NEAR(unevenness(pair, form), std::log(5) - std::log(9) / 2, 1e-12);
}

TEST(UniformForm, NoOtherCombinationIsMoreEven)
{
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (const Mesh& mesh : {shapes::surfaceOfGenus(2, 0, 6), shapes::surfaceOfGenus(3, 0, 5)}) {
        const SurfaceForms forms = formsOf(mesh);
        const Result<UniformForm> even = mostUniformForm(mesh, forms.basis, false);
        ASSERT_TRUE(even.ok());
        EXPECT_NEAR(unevenness(mesh, even->form), even->unevenness, 1e-9);
        const std::vector<double> factor = conformalFactor(mesh, even->form);
        double mean = 0;
        for (int f = 0; f < mesh.faceCount(); ++f) {
            const Triangle& t = mesh.faces[f];
            mean += factor[f] / 2 *
                    (mesh.positions[t[1]] - mesh.positions[t[0]])
                        .cross(mesh.positions[t[2]] - mesh.positions[t[0]])
                        .norm();
        }
        EXPECT_NEAR(mean / surfaceArea(mesh), 1, 1e-9);
        double best = 1e9, worst = 0;
        for (int k = 0; k < 60; ++k) {
            Eigen::VectorXcd c = even->coefficients;
            const double step = k % 2 ? 1.0 : 0.03; // anywhere, or nearby
            for (std::complex<double>& z : c)
                z += step * even->coefficients.norm() * std::complex<double>(normal(random), normal(random));
            const double other = unevenness(mesh, combination(forms.basis, c));
            best = std::min(best, other);
            worst = std::max(worst, other);
        }
        EXPECT_GT(best, even->unevenness);
        EXPECT_GT(worst, even->unevenness + 0.3);
    }
}

TEST(UniformForm, KeepsToRealCombinations)
{
    const Mesh mesh = shapes::plate(3, 5);
    const SurfaceForms forms = formsOf(mesh);
    ASSERT_EQ(forms.basis.size(), 3u);
    const Result<UniformForm> even = mostUniformForm(mesh, forms.basis, true);
    ASSERT_TRUE(even.ok());
    EXPECT_LT(even->coefficients.imag().norm(), 1e-12);
    for (const ComplexOneForm& form : forms.basis) EXPECT_LE(even->unevenness, unevenness(mesh, form) + 1e-9);
}

TEST(UniformForm, Refusals)
{
    const Mesh mesh = shapes::torus(2, 1, 6, 6);
    EXPECT_EQ(mostUniformForm(mesh, {}, false).error().kind, ErrorKind::BadArgument);
    const std::vector<ComplexOneForm> wrong = {ComplexOneForm::Ones(5)};
    EXPECT_EQ(mostUniformForm(mesh, wrong, false).error().kind, ErrorKind::BadArgument);
    const std::vector<ComplexOneForm> twice(2, formsOf(mesh).basis[0]);
    EXPECT_EQ(mostUniformForm(mesh, twice, false).error().kind, ErrorKind::BadArgument);
}

// A capsule: two ends, and a cylinder between them that forms of an annulus spread evenly.
Mesh capsule(double length)
{
    Mesh mesh = shapes::sphere(1, 10);
    for (Vec3& p : mesh.positions)
        if (p.z() > 0) p.z() += length;
    return mesh;
}

TEST(FindPunctures, EndsOfALongSurface)
{
    const Mesh mesh = capsule(8);
    const Result<std::vector<int>> found = findPunctures(mesh, 2);
    ASSERT_TRUE(found.ok()) << found.error().message;
    std::vector<double> heights;
    for (int v : *found) heights.push_back(mesh.positions[v].z());
    std::sort(heights.begin(), heights.end());
    EXPECT_LT(heights[0], -0.8);
    EXPECT_GT(heights[1], 8.8);
}

TEST(FindPunctures, EachMakesALimbySurfaceMoreEven)
{
    Mesh mesh = shapes::torus(2, 0.8, 48, 24);
    for (Vec3& p : mesh.positions) // two limbs
        p += 3 * p.normalized() *
             (std::exp(-20 * (p / 2.8 - Vec3(1, 0, 0)).squaredNorm()) +
              std::exp(-20 * (p / 2.8 - Vec3(-1, 0, 0)).squaredNorm()));
    const auto least = [](const Mesh& surface) {
        const Result<SurfaceForms> forms = surfaceForms(surface);
        return mostUniformForm(surface, forms->basis, forms->hasBoundary())->unevenness;
    };
    const Result<std::vector<int>> found = findPunctures(mesh, 2);
    ASSERT_TRUE(found.ok()) << found.error().message;
    for (int v : *found) EXPECT_GT(std::abs(mesh.positions[v].x()), 5);
    EXPECT_LT(mesh.positions[(*found)[0]].x() * mesh.positions[(*found)[1]].x(), 0);
    EXPECT_LT(least(puncture(mesh, *found)->mesh), 0.7 * least(mesh));
}

TEST(FindPunctures, Refusals)
{
    EXPECT_EQ(findPunctures(shapes::torus(2, 1, 9, 9), 0).error().kind, ErrorKind::BadArgument);
    EXPECT_EQ(findPunctures(shapes::sphere(1, 1), 6).error().kind, ErrorKind::BadArgument);
}

} // namespace
} // namespace gimg

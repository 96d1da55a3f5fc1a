#include "gimg/global_parameterization.h"

#include "forms_of.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace gimg {
namespace {

using test::formsOf;

BranchPoints branchesOf(const Mesh& mesh, const ComplexOneForm& form)
{
    const Result<BranchPoints> found = branchPoints(mesh, form);
    EXPECT_TRUE(found.ok()) << found.error().message;
    return *found;
}

int multiplicities(const BranchPoints& branches)
{
    int sum = 0;
    for (const BranchPoint& point : branches.points) sum += point.multiplicity;
    return sum;
}

// z^(k + 1) on a flat disk: a closed form with a zero of order k, wherever the vertices are.
int orderAt(int k, const Vec2& zero, Vec3& position)
{
    // The disk doubled is a sphere, of which the other half has zeros as well; only those inside count.
    const Mesh disk = shapes::disk(1, 12);
    const Result<DoubleCover> cover = doubleCover(disk);
    const Halfedges he(cover->mesh.faces, cover->mesh.vertexCount());
    const auto f = [&](const Vec3& p) {
        return std::pow(std::complex<double>(p.x() - zero.x(), p.y() - zero.y()), k + 1);
    };
    ComplexOneForm form(he.count());
    for (int h = 0; h < he.count(); ++h)
        form[h] = f(cover->mesh.positions[he.head(h)]) - f(cover->mesh.positions[he.tail(h)]);
    const Result<BoundedBranchPoints> found = branchPoints(*cover, form);
    EXPECT_EQ(found->total, -2); // of a sphere
    EXPECT_LE(found->inside.points.size(), 1u);
    if (found->inside.points.empty()) return 0;
    position = found->inside.points[0].position;
    return found->inside.points[0].multiplicity;
}

TEST(BranchPoints, FindsTheOrderAndThePlaceOfAZero)
{
    Vec3 position;
    EXPECT_EQ(orderAt(0, {0.21, 0.13}, position), 0);
    for (const Vec2& zero : {Vec2(0, 0), Vec2(0.21, 0.13), Vec2(-0.3333, 0.1)})
        for (int k = 1; k <= 3; ++k) {
            EXPECT_EQ(orderAt(k, zero, position), k) << zero.transpose();
            EXPECT_LT((position - Vec3(zero.x(), zero.y(), 0)).norm(), 0.06) << k; // edges of length 1/12
        }
}

TEST(BranchPoints, AreTwoGMinusTwoForEveryForm)
{
    for (int genus = 1; genus <= 7; ++genus) {
        const Mesh mesh = shapes::surfaceOfGenus(genus, 0, 5);
        const SurfaceForms forms = formsOf(mesh);
        ASSERT_EQ(forms.basis.size(), static_cast<size_t>(genus));
        const UniformForm even = *mostUniformForm(mesh, forms.basis, false);
        for (const ComplexOneForm& form : {even.form, forms.basis[0], forms.basis.back()}) {
            const BranchPoints found = branchesOf(mesh, form);
            EXPECT_EQ(multiplicities(found), 2 * genus - 2);
            EXPECT_EQ(found.total, 2 * genus - 2);
            EXPECT_EQ(found.negative, 0);
        }
    }
}

// On a surface with boundary zeros inside count twice on the covering.
TEST(BranchPoints, OfASurfaceWithBoundary)
{
    const Mesh mesh = shapes::surfaceOfGenus(1, 2, 8);
    const SurfaceForms forms = formsOf(mesh);
    ASSERT_EQ(forms.basis.size(), 3u); // 2 + 2 - 1
    const UniformForm even = *mostUniformForm(mesh, forms.basis, true);
    const Result<BoundedBranchPoints> found =
        branchPoints(*forms.cover, combination(forms.coverBasis, even.coefficients));
    ASSERT_TRUE(found.ok());
    EXPECT_EQ(found->total, 4);
    EXPECT_EQ(2 * multiplicities(found->inside) + multiplicities(found->onBoundary), 4);
}

// The surface is symmetric about the planes x = 0 and y = 0 through its middle, so a form with symmetric
// coefficients has its two zeros on them; they must come to rest as the mesh is refined.
TEST(BranchPoints, ComeToRestUnderRefinement)
{
    std::vector<Vec3> at;
    for (int n : {6, 12, 24}) {
        const Mesh mesh = shapes::surfaceOfGenus(2, 0, n);
        const UniformForm even = *mostUniformForm(mesh, formsOf(mesh).basis, false);
        const BranchPoints found = branchesOf(mesh, even.form);
        ASSERT_EQ(multiplicities(found), 2);
        Vec3 top = found.points[0].position;
        for (const BranchPoint& point : found.points)
            if (point.position.z() > top.z()) top = point.position;
        at.push_back(top);
    }
    EXPECT_LT((at[2] - at[1]).norm(), 0.1);
    EXPECT_LT((at[2] - at[1]).norm(), 0.7 * (at[1] - at[0]).norm() + 0.02);
}

TEST(BranchPoints, RefuseFormsOfAnotherSize)
{
    EXPECT_EQ(branchPoints(shapes::torus(2, 1, 6, 6), ComplexOneForm::Ones(7)).error().kind,
              ErrorKind::BadArgument);
}

// Eq. 89 sees the zeros as minima: the least stretch is next to one of them.
TEST(BranchPoints, HaveTheLeastStretchBesideThem)
{
    const Mesh mesh = shapes::surfaceOfGenus(3, 0, 12);
    const UniformForm even = *mostUniformForm(mesh, formsOf(mesh).basis, false);
    const std::vector<double> stretch = vertexStretch(mesh, even.form);
    const auto least = std::min_element(stretch.begin(), stretch.end());
    const Vec3 where = mesh.positions[least - stretch.begin()];
    double nearest = 1e9;
    for (const BranchPoint& point : branchesOf(mesh, even.form).points)
        nearest = std::min(nearest, (point.position - where).norm());
    EXPECT_LT(nearest, 0.1);
    EXPECT_LT(*least, 0.02);
}

} // namespace
} // namespace gimg

#include "gimg/handle_separation.h"

#include "gimg/global_parameterization.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gimg {
namespace {

struct Separated
{
    Mesh mesh;
    ComplexOneForm form;
    HandleSeparation separation;
};

Separated separated(const Mesh& mesh)
{
    Result<SurfaceForms> forms = surfaceForms(mesh);
    EXPECT_TRUE(forms.ok()) << forms.error().message;
    const ComplexOneForm form = mostUniformForm(mesh, forms->basis, false)->form;
    Result<HandleSeparation> separation = separateHandles(mesh, form);
    EXPECT_TRUE(separation.ok()) << separation.error().message;
    return {mesh, form, std::move(*separation)};
}

// A region as a mesh of its own, which no other region's vertices hold together.
Topology regionOf(const Separated& s, int handle)
{
    const Halfedges he(s.mesh.faces, s.mesh.vertexCount());
    const auto inside = [&](int h) { return s.separation.handleOf[h / 3] == handle; };
    std::vector<int> corner(3 * s.mesh.faces.size(), -1); // a vertex for each fan of the region's faces
    int vertices = 0;
    for (int start = 0; start < he.count(); ++start) {
        if (!inside(start) || corner[start] >= 0) continue;
        int first = start;
        while (inside(he.rotateCw(first)) && he.rotateCw(first) != start) first = he.rotateCw(first);
        for (int h = first; inside(h) && corner[h] < 0; h = he.rotateCcw(h)) corner[h] = vertices;
        ++vertices;
    }
    Mesh region{std::vector<Vec3>(static_cast<size_t>(vertices)), {}};
    for (int f = 0; f < s.mesh.faceCount(); ++f)
        if (inside(3 * f)) region.faces.push_back({corner[3 * f], corner[3 * f + 1], corner[3 * f + 2]});
    return topology(region);
}

void expectHandles(const Separated& s, int genus)
{
    const Halfedges he(s.mesh.faces, s.mesh.vertexCount());
    const std::vector<Handle>& handles = s.separation.handles;
    ASSERT_EQ(handles.size(), static_cast<size_t>(genus));
    std::vector<Loop> a, b;
    double area = 0, parallelograms = 0;
    for (int i = 0; i < genus; ++i) {
        const Topology region = regionOf(s, i);
        EXPECT_EQ(region.genus, 1);
        EXPECT_EQ(region.boundaries, static_cast<int>(handles[i].boundary.size()));
        for (const Loop& loop : handles[i].boundary)
            EXPECT_LT(std::abs(integrate(s.form, loop.halfedges)), 1e-9); // a separator bounds
        a.push_back(handles[i].a);
        b.push_back(handles[i].b);
        area += handles[i].area;
        parallelograms += handles[i].parallelogramArea();
        EXPECT_GT(handles[i].parallelogramArea(), 0);
    }
    EXPECT_NEAR(area, parallelograms, 1e-9 * area); // Riemann's bilinear relation
    std::vector<Loop> loops = a;
    loops.insert(loops.end(), b.begin(), b.end());
    Eigen::MatrixXi canonical = Eigen::MatrixXi::Zero(2 * genus, 2 * genus);
    canonical.topRightCorner(genus, genus).setIdentity();
    canonical.bottomLeftCorner(genus, genus) = -Eigen::MatrixXi::Identity(genus, genus);
    EXPECT_EQ(intersectionMatrix(he, loops), canonical);
}

TEST(HandleSeparation, EveryHandleIsATorusWithHoles)
{
    for (int genus : {1, 2, 3, 4}) expectHandles(separated(shapes::surfaceOfGenus(genus, 0, 8)), genus);
}

// Two zeros: the separator is a slit between them, and each handle fills its parallelogram.
TEST(HandleSeparation, HandlesOfGenusTwoFillTheirParallelograms)
{
    const auto misfit = [](int n) {
        double worst = 0;
        for (const Handle& handle : separated(shapes::surfaceOfGenus(2, 0, n)).separation.handles)
            worst = std::max(worst, std::abs(handle.area / handle.parallelogramArea() - 1));
        return worst;
    };
    EXPECT_LT(misfit(8), 0.05);
    EXPECT_LT(misfit(16), 0.025);
}

TEST(HandleSeparation, OfATorusIsAllOfIt)
{
    const Separated s = separated(shapes::torus(3, 1, 24, 12));
    expectHandles(s, 1);
    EXPECT_TRUE(s.separation.handles[0].boundary.empty());
    EXPECT_NEAR(s.separation.handles[0].area, s.separation.handles[0].parallelogramArea(), 1e-9);
}

// Separators turn at branch points only, so two of these lie on each.
TEST(HandleSeparation, SeparatorsPassBranchPoints)
{
    const Separated s = separated(shapes::surfaceOfGenus(2, 0, 12));
    const Result<BranchPoints> branches = branchPoints(s.mesh, s.form);
    const Halfedges he(s.mesh.faces, s.mesh.vertexCount());
    ASSERT_EQ(s.separation.handles[0].boundary.size(), 1u);
    for (const BranchPoint& point : branches->points) {
        double nearest = 1e9;
        for (int h : s.separation.handles[0].boundary[0].halfedges)
            nearest = std::min(nearest, (s.mesh.positions[he.tail(h)] - point.position).norm());
        EXPECT_LT(nearest, 0.1);
    }
}

TEST(ModularCoordinates, ChangeByIntegersInsideAHandle)
{
    for (int genus : {1, 2, 3}) {
        const Separated s = separated(shapes::surfaceOfGenus(genus, 0, 8));
        const Result<CornerMap> map = modularCoordinates(s.mesh, s.form, s.separation);
        ASSERT_TRUE(map.ok());
        const Halfedges he(s.mesh.faces, s.mesh.vertexCount());
        int wraps = 0;
        for (int h = 0; h < he.count(); ++h) {
            const int twin = he.twin(h);
            if (s.separation.handleOf[h / 3] != s.separation.handleOf[twin / 3]) continue;
            const Vec2 here = map->at(h / 3, h % 3);
            const int next = Halfedges::next(twin);
            const Vec2 jump = map->at(next / 3, next % 3) - here;
            EXPECT_LT((jump - jump.array().round().matrix()).norm(), 1e-8);
            wraps += jump.norm() > 0.5;
        }
        EXPECT_GT(wraps, 8);
        for (int f = 0; f < s.mesh.faceCount(); ++f) {
            EXPECT_GE(map->at(f, 0).minCoeff(), -1e-12);
            EXPECT_LT(map->at(f, 0).maxCoeff(), 1);
            // and they stand for the form
            const Handle& handle = s.separation.handles[s.separation.handleOf[f]];
            const Vec2 d = map->at(f, 1) - map->at(f, 0);
            EXPECT_LT(std::abs(d[0] * handle.periodA + d[1] * handle.periodB - s.form[3 * f]), 1e-9);
        }
    }
}

TEST(SubdividedForm, KeepsTheFormAndTheSurface)
{
    const Mesh mesh = shapes::surfaceOfGenus(2, 0, 3);
    const Halfedges he(mesh.faces, mesh.vertexCount());
    ComplexOneForm form(he.count());
    for (int h = 0; h < he.count(); ++h) // not exact: closed on each face alone
        form[h] =
            h % 3 == 2 ? -form[h - 1] - form[h - 2] : std::complex<double>(std::sin(h), std::cos(2.0 * h));
    const SubdividedForm fine = subdivided(mesh, form);
    EXPECT_EQ(topology(fine.mesh).genus, 2);
    EXPECT_EQ(fine.mesh.faceCount(), 4 * mesh.faceCount());
    EXPECT_NEAR(surfaceArea(fine.mesh), surfaceArea(mesh), 1e-12 * surfaceArea(mesh));
    EXPECT_LT(closednessError(fine.form), 1e-14);
    const std::vector<double> coarse = conformalFactor(mesh, form),
                              after = conformalFactor(fine.mesh, fine.form);
    for (int f = 0; f < fine.mesh.faceCount(); ++f)
        EXPECT_NEAR(after[f], coarse[f / 4], 1e-9 * (1 + coarse[f / 4])) << f;
}

TEST(HandleSeparation, Refusals)
{
    const Mesh sphere = shapes::sphere(1, 3), open = shapes::surfaceOfGenus(1, 1, 4);
    EXPECT_EQ(separateHandles(sphere, ComplexOneForm::Zero(3 * sphere.faceCount())).error().kind,
              ErrorKind::WrongGenus);
    EXPECT_EQ(separateHandles(open, ComplexOneForm::Zero(3 * open.faceCount())).error().kind,
              ErrorKind::NotClosed);
    EXPECT_EQ(separateHandles(sphere, ComplexOneForm::Zero(5)).error().kind, ErrorKind::BadArgument);
    const Mesh coarse = shapes::surfaceOfGenus(3, 0, 1);
    EXPECT_EQ(separateHandles(coarse, ComplexOneForm::Ones(3 * coarse.faceCount())).error().kind,
              ErrorKind::TargetUnreachable);
}

} // namespace
} // namespace gimg

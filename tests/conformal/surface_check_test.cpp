#include "gimg/holomorphic.h"
#include "gimg/polyhedral_surface.h"

#include "known_surfaces.h"
#include "shapes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace gimg {
namespace {

ErrorKind kindOf(const Mesh& mesh)
{
    const Result<ConformalStructure> structure = conformalStructure(mesh);
    EXPECT_FALSE(structure.ok());
    return structure.ok() ? ErrorKind::FileNotReadable : structure.error().kind;
}

TEST(SurfaceCheck, ClosedSurfacesHaveTheirTopology)
{
    const Result<Topology> torus = closedTopology(polyhedralSurface(shapes::torus(3, 1, 12, 8)));
    ASSERT_TRUE(torus.ok());
    EXPECT_EQ(torus->genus, 1);
    EXPECT_EQ(torus->vertices, 96);
    EXPECT_EQ(torus->edges, 288);
    const Result<Topology> cover = closedTopology(known::coverOverEquator(8, 3));
    ASSERT_TRUE(cover.ok()) << cover.error().message;
    EXPECT_EQ(cover->genus, 3);
    const Result<Topology> tiled = closedTopology(known::squareTiled({1, 0, 2}, {2, 1, 0}, 4));
    ASSERT_TRUE(tiled.ok()) << tiled.error().message;
    EXPECT_EQ(tiled->genus, 2);
}

TEST(SurfaceCheck, BoundaryIsNamed)
{
    EXPECT_EQ(kindOf(shapes::disk(1, 4)), ErrorKind::NotClosed);
    EXPECT_EQ(kindOf(shapes::surfaceOfGenus(2, 1, 4)), ErrorKind::NotClosed);
    EXPECT_THAT(conformalStructure(shapes::disk(1, 4)).error().message, testing::HasSubstr("is a boundary"));
}

TEST(SurfaceCheck, SphereHasNoForms)
{
    EXPECT_EQ(kindOf(shapes::sphere(1, 3)), ErrorKind::WrongGenus);
    EXPECT_EQ(canonicalBasis(shapes::sphere(1, 3)).error().kind, ErrorKind::WrongGenus);
    EXPECT_TRUE(homologyBasis(shapes::sphere(1, 3))->empty());
}

TEST(SurfaceCheck, KleinBottleIsNotOrientable)
{
    EXPECT_EQ(kindOf(known::kleinBottle(8)), ErrorKind::NotOrientable);
}

TEST(SurfaceCheck, OneTurnedFaceIsNotOrientedAlike)
{
    Mesh torus = shapes::torus(3, 1, 8, 6);
    std::swap(torus.faces[5][0], torus.faces[5][1]);
    EXPECT_EQ(kindOf(torus), ErrorKind::BadArgument);
    EXPECT_THAT(conformalStructure(torus).error().message, testing::HasSubstr("orient the faces alike"));
}

TEST(SurfaceCheck, FacesWithoutAreaAreNamed)
{
    Mesh onEdge = shapes::torus(3, 1, 8, 6);
    const Triangle t = onEdge.faces[7];
    onEdge.positions[t[0]] = 0.3 * onEdge.positions[t[1]] + 0.7 * onEdge.positions[t[2]];
    EXPECT_EQ(kindOf(onEdge), ErrorKind::ZeroAreaFace);
    Mesh onVertex = shapes::torus(3, 1, 8, 6);
    onVertex.positions[t[0]] = onVertex.positions[t[1]];
    EXPECT_EQ(kindOf(onVertex), ErrorKind::ZeroAreaFace);
    Mesh twice = shapes::torus(3, 1, 8, 6);
    twice.faces.push_back({3, 3, 4});
    EXPECT_EQ(kindOf(twice), ErrorKind::ZeroAreaFace);
}

TEST(SurfaceCheck, WhatIsNoSurfaceIsNamed)
{
    EXPECT_EQ(kindOf(Mesh{}), ErrorKind::EmptyMesh);
    Mesh fin = shapes::torus(3, 1, 8, 6);
    fin.positions.emplace_back(9, 9, 9);
    fin.faces.push_back({fin.faces[0][0], fin.faces[0][1], fin.vertexCount() - 1});
    EXPECT_EQ(kindOf(fin), ErrorKind::NonManifoldEdge);
    Mesh outside = shapes::torus(3, 1, 8, 6);
    outside.faces[0][0] = 48;
    EXPECT_EQ(kindOf(outside), ErrorKind::BadArgument);
    Mesh nan = shapes::torus(3, 1, 8, 6);
    nan.positions[3].x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(kindOf(nan), ErrorKind::NotFinite);
    Mesh two = shapes::torus(3, 1, 8, 6), pinched = two;
    for (Triangle t : shapes::torus(3, 1, 8, 6).faces) two.faces.push_back({t[0] + 48, t[1] + 48, t[2] + 48});
    for (const Vec3& p : shapes::torus(3, 1, 8, 6).positions) two.positions.push_back(p + Vec3(10, 0, 0));
    EXPECT_EQ(kindOf(two), ErrorKind::SeveralComponents);
    for (Triangle t : two.faces) {
        for (int& v : t) v = v == 48 ? 0 : v; // the two share a vertex
        if (t[0] >= 48 || t[1] >= 48 || t[2] >= 48) pinched.faces.push_back(t);
    }
    pinched.positions = two.positions;
    EXPECT_EQ(kindOf(pinched), ErrorKind::NonManifoldVertex);
}

TEST(SurfaceCheck, VerticesWithoutFacesDoNotCount)
{
    Mesh torus = shapes::torus(3, 1, 8, 6);
    const Eigen::MatrixXcd periods = conformalStructure(torus)->periodMatrix;
    torus.positions.insert(torus.positions.begin(), Vec3(1, 2, 3));
    torus.positions.emplace_back(4, 5, 6);
    for (Triangle& t : torus.faces)
        for (int& v : t) ++v;
    EXPECT_EQ(closedTopology(polyhedralSurface(torus))->vertices, 48);
    EXPECT_LT((conformalStructure(torus)->periodMatrix - periods).norm(), 1e-12);
}

TEST(SurfaceCheck, LengthsMustFitTheFaces)
{
    PolyhedralSurface surface = polyhedralSurface(shapes::torus(3, 1, 8, 6));
    surface.lengths[4] *= 1.5;
    EXPECT_EQ(closedTopology(surface).error().kind, ErrorKind::BadArgument);
    surface.lengths.pop_back();
    EXPECT_EQ(closedTopology(surface).error().kind, ErrorKind::BadArgument);
}

TEST(SurfaceCheck, OptionsAreChecked)
{
    ConformalOptions options;
    options.starResidual = 0;
    EXPECT_EQ(conformalStructure(shapes::torus(3, 1, 8, 6), options).error().kind, ErrorKind::BadArgument);
}

} // namespace
} // namespace gimg

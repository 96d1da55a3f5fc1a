#include "gimg/linear_maps.h"

#include "gimg/intrinsic.h"
#include "gimg/stretch.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

namespace gimg {
namespace {

constexpr MapKind kLinear[] = {MapKind::MeanValue, MapKind::Tutte, MapKind::Harmonic};

SquareDisk layOut(const Mesh& mesh)
{
    Result<SquareDisk> square = layOutBorder(mesh, cutToDisk(mesh), {});
    EXPECT_TRUE(square.ok());
    return std::move(*square);
}

// A flat parallelogram whose border is on the square by an affine map; `st` has that map of all vertices.
SquareDisk parallelogram(int n, std::vector<Vec2>& st)
{
    std::mt19937 random(4);
    std::uniform_real_distribution<double> off(-0.35, 0.35);
    SquareDisk square;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const bool border = i == 0 || j == 0 || i == n || j == n;
            st.push_back(border ? Vec2(i, j) / n : Vec2(i + off(random), j + off(random)) / n);
            square.disk.mesh.positions.emplace_back(2 * st.back().x() + st.back().y(), st.back().y() / 2, 0);
            square.squareSides.push_back(border ? 1 : 0);
            square.borderPosition.push_back(border ? st.back() : Vec2(7, 7));
        }
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const int a = j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
            square.disk.mesh.faces.push_back({a, b, c});
            square.disk.mesh.faces.push_back({a, c, d});
        }
    return square;
}

TEST(LinearMaps, MeanValueAndHarmonicMapsReproduceAffineOnes)
{
    std::vector<Vec2> st;
    const SquareDisk square = parallelogram(10, st);
    for (MapKind kind : {MapKind::MeanValue, MapKind::Harmonic}) {
        const Result<std::vector<Vec2>> map = linearMap(square, kind);
        ASSERT_TRUE(map.ok()) << mapName(kind);
        for (size_t v = 0; v < st.size(); ++v) EXPECT_LT(((*map)[v] - st[v]).norm(), 1e-11) << mapName(kind);
    }
}

TEST(LinearMaps, TuttePutsVerticesAtTheMeanOfTheirNeighbours)
{
    const SquareDisk square = layOut(shapes::surfaceOfGenus(2, 1, 5));
    const Result<std::vector<Vec2>> st = linearMap(square, MapKind::Tutte);
    ASSERT_TRUE(st.ok());
    std::map<int, std::set<int>> neighbours;
    for (const Triangle& f : square.disk.mesh.faces)
        for (int a : f)
            for (int b : f)
                if (a != b) neighbours[a].insert(b);
    for (const auto& [v, around] : neighbours) {
        if (square.squareSides[v] != 0) continue;
        Vec2 mean = Vec2::Zero();
        for (int w : around) mean += (*st)[w] / static_cast<double>(around.size());
        EXPECT_LT(((*st)[v] - mean).norm(), 1e-14);
    }
}

TEST(LinearMaps, EmbedSmallSurfaces)
{
    for (const auto& [genus, loops] : {std::pair(0, 0), std::pair(0, 3), std::pair(1, 0), std::pair(1, 2)}) {
        const SquareDisk square = layOut(shapes::surfaceOfGenus(genus, loops, 6));
        for (MapKind kind : kLinear) {
            const Result<Parameterization> map = mapToSquare(square, kind);
            ASSERT_TRUE(map.ok()) << mapName(kind) << ": " << map.error().message;
            EXPECT_EQ(flippedTriangles(square.disk.mesh.faces, map->st), 0);
            EXPECT_NEAR(map->efficiency, stretchEfficiency(square.disk.mesh, map->st), 1e-12);
            for (size_t v = 0; v < map->st.size(); ++v)
                EXPECT_TRUE(square.squareSides[v] == 0 || map->st[v] == square.borderPosition[v]);
        }
    }
}

TEST(LinearMaps, TheHarmonicMapHasTheLeastDirichletEnergy)
{
    const SquareDisk square = layOut(shapes::surfaceOfGenus(1, 1, 8));
    Result<IntrinsicTriangulation> delaunay = IntrinsicTriangulation::of(square.disk.mesh);
    ASSERT_TRUE(delaunay.ok());
    delaunay->makeDelaunay();
    const Eigen::SparseMatrix<double> laplacian = delaunay->cotangentLaplacian();
    std::map<MapKind, double> energy;
    for (MapKind kind : kLinear) {
        const Result<std::vector<Vec2>> st = linearMap(square, kind);
        ASSERT_TRUE(st.ok());
        Eigen::MatrixX2d x(st->size(), 2);
        for (size_t v = 0; v < st->size(); ++v) x.row(v) = (*st)[v].transpose();
        energy[kind] = 0.5 * (x.transpose() * (laplacian * x)).trace();
    }
    EXPECT_GT(energy[MapKind::Harmonic], 1); // the area of the square, which a conformal map would reach
    EXPECT_LT(energy[MapKind::Harmonic], 0.999 * energy[MapKind::MeanValue]);
    EXPECT_LT(energy[MapKind::MeanValue], energy[MapKind::Tutte]);
}

TEST(LinearMaps, WhatShrinksAwayIsAnErrorThatCountsTriangles)
{
    // A tube 40 radii long, closed at its top: the map shrinks it by exp(-40).
    Mesh mesh = shapes::cylinder(0.25, 10, 24, 200);
    const int top = mesh.vertexCount();
    mesh.positions.emplace_back(0, 0, 10);
    const Halfedges he(mesh.faces, top);
    for (int v = 0; v < top; ++v)
        if (mesh.positions[v].z() == 10) mesh.faces.push_back({he.head(he.outgoing(v)), v, top});
    const SquareDisk square = layOut(mesh);
    for (MapKind kind : kLinear) {
        const Result<Parameterization> map = mapToSquare(square, kind);
        ASSERT_FALSE(map.ok()) << mapName(kind);
        EXPECT_EQ(map.error().kind, ErrorKind::FlippedTriangle);
        const Result<std::vector<Vec2>> st = linearMap(square, kind);
        ASSERT_TRUE(st.ok());
        const int flipped = flippedTriangles(square.disk.mesh.faces, *st);
        EXPECT_GT(flipped, 10);
        EXPECT_EQ(map.error().message.find(std::to_string(flipped) + " of "), 0u);
    }
}

TEST(LinearMaps, StretchIsNotLinear)
{
    std::vector<Vec2> st;
    const Result<std::vector<Vec2>> map = linearMap(parallelogram(3, st), MapKind::Stretch);
    ASSERT_FALSE(map.ok());
    EXPECT_EQ(map.error().kind, ErrorKind::BadArgument);
}

} // namespace
} // namespace gimg

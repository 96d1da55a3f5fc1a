#include "gimg/homology.h"
#include "gimg/slice.h"

#include "known_surfaces.h"
#include "shapes.h"

#include <Eigen/Dense>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>

namespace gimg {
namespace {

Halfedges halfedgesOf(const Mesh& mesh) { return Halfedges(mesh.faces, mesh.vertexCount()); }

bool isClosedWalk(const Halfedges& he, const Loop& loop)
{
    for (size_t i = 0; i < loop.halfedges.size(); ++i)
        if (he.head(loop.halfedges[i]) != he.tail(loop.halfedges[(i + 1) % loop.halfedges.size()]))
            return false;
    return !loop.halfedges.empty();
}

Loop throughVertices(const Halfedges& he, const std::vector<int>& vertices)
{
    Loop loop;
    for (size_t i = 0; i < vertices.size(); ++i) {
        const int v = vertices[i], w = vertices[(i + 1) % vertices.size()], first = he.outgoing(v);
        int h = first;
        while (he.head(h) != w && he.rotateCcw(h) != first) h = he.rotateCcw(h);
        EXPECT_EQ(he.head(h), w) << v << " and " << w << " are not joined";
        loop.halfedges.push_back(h);
    }
    return loop;
}

/// A torus of 8 x 8 vertices (i, j), i to the right and j up as seen from outside; diagonals from (i, j) to
/// (i + 1, j + 1).
class TorusGrid : public testing::Test
{
protected:
    const Mesh mesh = known::roughTorus(3, 1, 8, 8, 0, false, 1);
    const Halfedges he = halfedgesOf(mesh);

    Loop walk(const std::vector<std::pair<int, int>>& places) const
    {
        std::vector<int> vertices;
        for (const auto& [i, j] : places) vertices.push_back((i + 8) % 8 * 8 + (j + 8) % 8);
        return throughVertices(he, vertices);
    }
    int number(const Loop& a, const Loop& b) const { return intersectionNumber(he, a, b); }

    const Loop right = walk({{0, 2}, {1, 2}, {2, 2}, {3, 2}, {4, 2}, {5, 2}, {6, 2}, {7, 2}});
    const Loop up = walk({{3, 0}, {3, 1}, {3, 2}, {3, 3}, {3, 4}, {3, 5}, {3, 6}, {3, 7}});
};

TEST_F(TorusGrid, CrossingsCountWithTheirSign)
{
    EXPECT_EQ(number(right, up), 1); // the axes of an oriented plane
    EXPECT_EQ(number(up, right), -1);
    EXPECT_EQ(number(right, right), 0);
}

TEST_F(TorusGrid, TouchingCountsNothing)
{
    const Loop touching = walk({{3, 2}, {4, 3}, {3, 3}});
    EXPECT_EQ(number(touching, right), 0);
    EXPECT_EQ(number(right, touching), 0);
}

TEST_F(TorusGrid, SharedRunsCountHalfAtEachEnd)
{
    // From below on to the loop, along it, and off to the other side: a crossing. Then back to the same side.
    const Loop across = walk({{1, 0},
                              {1, 1},
                              {1, 2},
                              {2, 2},
                              {3, 2},
                              {4, 2},
                              {4, 3},
                              {4, 4},
                              {4, 5},
                              {4, 6},
                              {4, 7},
                              {3, 7},
                              {2, 7},
                              {1, 7}});
    EXPECT_EQ(number(right, across), 1);
    EXPECT_EQ(number(across, right), -1);
    const Loop back = walk({{1, 1}, {1, 2}, {2, 2}, {3, 2}, {3, 1}, {2, 1}});
    EXPECT_EQ(number(right, back), 0);
    // The run the other way round.
    const Loop against =
        walk({{5, 0}, {5, 1}, {5, 2}, {4, 2}, {3, 2}, {3, 3}, {3, 4}, {3, 5}, {3, 6}, {3, 7}, {4, 7}});
    EXPECT_EQ(number(right, against), 1);
    EXPECT_EQ(number(against, right), -1);
}

TEST_F(TorusGrid, TurningBackAndPassingTwiceChangeNothing)
{
    const Loop spur = walk(
        {{3, 0}, {3, 1}, {3, 2}, {4, 2}, {5, 2}, {4, 2}, {3, 2}, {3, 3}, {3, 4}, {3, 5}, {3, 6}, {3, 7}});
    EXPECT_EQ(number(right, spur), 1);
    EXPECT_EQ(number(spur, right), -1);
    Loop twice = up;
    twice.halfedges.insert(twice.halfedges.end(), up.halfedges.begin(), up.halfedges.end());
    EXPECT_EQ(number(right, twice), 2);
    EXPECT_EQ(number(twice, right), -2);
}

Loop randomWalk(const Halfedges& he, std::mt19937& random, const std::vector<Loop>& basis)
{
    // Some steps at random, then back to the start through the vertex-wise shortest way, then along loops.
    Loop loop;
    const Loop& first = basis[random() % basis.size()];
    loop.halfedges = first.halfedges;
    std::vector<int> out;
    int v = he.tail(first.halfedges[0]);
    for (int step = 0; step < 12; ++step) {
        int h = he.outgoing(v);
        for (auto turns = random() % 6; turns > 0; --turns) h = he.rotateCcw(h);
        // Around one of the faces beside h instead of along it, now and then.
        if (random() % 2 == 0) {
            out.push_back(h);
        } else {
            const int t = he.twin(h);
            out.push_back(Halfedges::next(t));
            out.push_back(Halfedges::prev(t));
        }
        v = he.head(out.back());
    }
    loop.halfedges.insert(loop.halfedges.end(), out.begin(), out.end());
    for (size_t i = out.size(); i-- > 0;) {
        const int back = he.twin(out[i]);
        if (random() % 2 == 0) {
            loop.halfedges.push_back(back);
        } else {
            loop.halfedges.push_back(he.twin(Halfedges::prev(back)));
            loop.halfedges.push_back(he.twin(Halfedges::next(back)));
        }
    }
    return loop;
}

TEST(Intersection, AgreesWithTheWedgeOfDualForms)
{
    const Mesh mesh = shapes::surfaceOfGenus(2, 0, 2);
    const Halfedges he = halfedgesOf(mesh);
    const std::vector<Loop> basis = *homologyBasis(mesh);
    std::mt19937 random(17);
    int nonzero = 0;
    for (int i = 0; i < 300; ++i) {
        const Loop a = randomWalk(he, random, basis), b = randomWalk(he, random, basis);
        ASSERT_TRUE(isClosedWalk(he, a));
        const OneForm dualA = poincareDual(he, a), dualB = poincareDual(he, b);
        ASSERT_EQ(closednessError(dualA), 0);
        const int number = intersectionNumber(he, a, b);
        nonzero += number != 0;
        ASSERT_NEAR(wedge(dualA, dualB), number, 1e-9);
        ASSERT_EQ(integrate(dualA, b.halfedges), number);
        ASSERT_EQ(intersectionNumber(he, b, a), -number);
    }
    EXPECT_GT(nonzero, 50);
}

TEST(HomologyBasis, TorusLoopsAreTheShortest)
{
    const Mesh torus = shapes::torus(3, 1, 48, 24);
    const std::vector<Loop> loops = *homologyBasis(torus);
    ASSERT_EQ(loops.size(), 2u);
    // Polygons in the circles around the tube and along its inside.
    const PolyhedralSurface surface = polyhedralSurface(torus);
    EXPECT_NEAR(loopLength(surface, loops[0]), 48 * std::sin(std::numbers::pi / 24), 1e-9);
    EXPECT_NEAR(loopLength(surface, loops[1]), 2 * 96 * std::sin(std::numbers::pi / 48), 1e-9);
}

TEST(HomologyBasis, IntersectionMatrixHasDeterminantOne)
{
    for (int genus = 1; genus <= 6; ++genus) {
        const Mesh mesh = shapes::surfaceOfGenus(genus, 0, 4);
        const Halfedges he = halfedgesOf(mesh);
        const Result<std::vector<Loop>> loops = homologyBasis(mesh);
        ASSERT_TRUE(loops.ok());
        ASSERT_EQ(loops->size(), 2u * genus);
        for (const Loop& loop : *loops) EXPECT_TRUE(isClosedWalk(he, loop));
        const Eigen::MatrixXi q = intersectionMatrix(he, *loops);
        EXPECT_EQ(q, -q.transpose());
        EXPECT_NEAR(q.cast<double>().determinant(), 1, 1e-9);
    }
}

TEST(CanonicalBasis, MeetsInPairs)
{
    for (int genus = 1; genus <= 6; ++genus) {
        const Mesh mesh = shapes::surfaceOfGenus(genus, 0, 4);
        const Halfedges he = halfedgesOf(mesh);
        const CanonicalBasis basis = *canonicalBasis(mesh);
        std::vector<Loop> loops = basis.a;
        loops.insert(loops.end(), basis.b.begin(), basis.b.end());
        for (const Loop& loop : loops) EXPECT_TRUE(isClosedWalk(he, loop));
        Eigen::MatrixXi expected = Eigen::MatrixXi::Zero(2 * genus, 2 * genus);
        expected.topRightCorner(genus, genus).setIdentity();
        expected.bottomLeftCorner(genus, genus) = -Eigen::MatrixXi::Identity(genus, genus);
        EXPECT_EQ(intersectionMatrix(he, loops), expected);
    }
}

TEST(SymplecticCongruence, BringsAnyUnimodularFormToTheStandardOne)
{
    std::mt19937 random(5);
    for (int g = 1; g <= 8; ++g) {
        Eigen::MatrixXi standard = Eigen::MatrixXi::Zero(2 * g, 2 * g);
        standard.topRightCorner(g, g).setIdentity();
        standard.bottomLeftCorner(g, g) = -Eigen::MatrixXi::Identity(g, g);
        Eigen::MatrixXi change = Eigen::MatrixXi::Identity(2 * g, 2 * g);
        for (int i = 0; i < 4 * g; ++i) {
            const Eigen::Index from = random() % (2 * g), to = random() % (2 * g);
            if (from != to) change.col(to) += (random() % 2 == 0 ? 1 : -2) * change.col(from);
        }
        const Eigen::MatrixXi q = change.transpose() * standard * change;
        const Result<Eigen::MatrixXi> a = symplecticCongruence(q);
        ASSERT_TRUE(a.ok());
        EXPECT_EQ(a->transpose() * q * *a, standard);
    }
}

TEST(SymplecticCongruence, RefusesWhatIsNoBasis)
{
    Eigen::MatrixXi twice(2, 2), symmetric(2, 2);
    twice << 0, 2, -2, 0;
    symmetric << 0, 1, 1, 0;
    EXPECT_EQ(symplecticCongruence(twice).error().kind, ErrorKind::BadArgument);
    EXPECT_EQ(symplecticCongruence(symmetric).error().kind, ErrorKind::BadArgument);
    EXPECT_EQ(symplecticCongruence(Eigen::MatrixXi::Zero(4, 4)).error().kind, ErrorKind::BadArgument);
}

TEST(SmithForm, KnowsSphereTorusAndKleinBottle)
{
    const auto homology = [](const Mesh& mesh) {
        return *homologyBySmithForm(mesh.faces, mesh.vertexCount());
    };
    EXPECT_EQ(homology(shapes::sphere(1, 2)).rank, 0);
    EXPECT_EQ(homology(shapes::torus(3, 1, 5, 4)).rank, 2);
    EXPECT_EQ(homology(shapes::plate(3, 1)).rank, 3);
    EXPECT_TRUE(homology(shapes::torus(3, 1, 5, 4)).torsion.empty());
    const SimplicialHomology klein = homology(known::kleinBottle(5));
    EXPECT_EQ(klein.rank, 1);
    EXPECT_THAT(klein.torsion, testing::ElementsAre(2));
}

// The two bases are integer combinations of each other: their periods over forms dual to one of them have
// determinant +-1.
TEST(SmithForm, SpansTheSameLoopsAsTreeAndCotree)
{
    for (int genus = 1; genus <= 2; ++genus) {
        const Mesh mesh = shapes::surfaceOfGenus(genus, 0, 1);
        const Halfedges he = halfedgesOf(mesh);
        const std::vector<Loop> loops = *homologyBasis(mesh);
        const SimplicialHomology smith = *homologyBySmithForm(mesh.faces, mesh.vertexCount());
        ASSERT_EQ(smith.rank, 2 * genus);
        std::map<std::pair<int, int>, int> edge; // halfedge that runs upward
        for (int h = 0; h < he.count(); ++h)
            if (he.tail(h) < he.head(h)) edge[{he.tail(h), he.head(h)}] = h;
        Eigen::MatrixXd periods(2 * genus, 2 * genus);
        for (int i = 0; i < 2 * genus; ++i) {
            const OneForm dual = poincareDual(he, loops[i]);
            for (int j = 0; j < 2 * genus; ++j) {
                double sum = 0;
                Eigen::VectorXi boundary = Eigen::VectorXi::Zero(mesh.vertexCount());
                for (size_t e = 0; e < smith.edges.size(); ++e) {
                    const int times = smith.cycles[j][static_cast<Eigen::Index>(e)];
                    sum += times * dual[edge.at({smith.edges[e][0], smith.edges[e][1]})];
                    boundary[smith.edges[e][0]] -= times;
                    boundary[smith.edges[e][1]] += times;
                }
                EXPECT_TRUE(boundary.isZero());
                periods(i, j) = sum;
            }
        }
        EXPECT_NEAR(std::abs(periods.determinant()), 1, 1e-9);
    }
}

TEST(Slice, LoopsOpenATorus)
{
    const Mesh torus = shapes::torus(3, 1, 16, 12);
    const std::vector<Loop> loops = *homologyBasis(torus);
    const SlicedMesh once = *sliceAlong(torus, std::span(loops).first(1));
    const Topology tube = topology(once.mesh);
    EXPECT_EQ(tube.genus, 0);
    EXPECT_EQ(tube.boundaries, 2);
    EXPECT_EQ(once.mesh.vertexCount(), torus.vertexCount() + static_cast<int>(loops[0].halfedges.size()));
    const Topology disk = topology(sliceAlong(torus, loops)->mesh);
    EXPECT_EQ(disk.boundaries, 1);
    EXPECT_EQ(disk.euler(), 1);
    EXPECT_EQ(sliceAlong(torus, std::vector<Loop>{{{-1}}}).error().kind, ErrorKind::BadArgument);
}

} // namespace
} // namespace gimg

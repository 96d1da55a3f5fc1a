#include "gimg/double_cover.h"

#include "shapes.h"

#include <gtest/gtest.h>

namespace gimg {
namespace {

DoubleCover covering(const Mesh& mesh)
{
    Result<DoubleCover> cover = doubleCover(mesh);
    EXPECT_TRUE(cover.ok());
    return std::move(*cover);
}

void expectSymmetric(const Mesh& mesh, const DoubleCover& cover)
{
    const Topology type = topology(mesh), closed = topology(cover.mesh);
    EXPECT_EQ(closed.boundaries, 0);
    EXPECT_EQ(closed.genus, 2 * type.genus + type.boundaries - 1);
    EXPECT_NEAR(surfaceArea(cover.mesh), 2 * surfaceArea(mesh), 1e-12 * surfaceArea(mesh));
    const Halfedges he(cover.mesh.faces, cover.mesh.vertexCount());
    for (int h = 0; h < he.count(); ++h) {
        const int mirror = cover.mirrorHalfedge[h];
        ASSERT_GE(mirror, 0);
        EXPECT_EQ(he.tail(mirror), cover.mirror[he.tail(h)]);
        EXPECT_EQ(he.head(mirror), cover.mirror[he.head(h)]);
        EXPECT_EQ(cover.mirrorHalfedge[mirror], h);
    }
    for (int v = 0; v < cover.mesh.vertexCount(); ++v) {
        EXPECT_EQ(cover.mirror[cover.mirror[v]], v);
        EXPECT_EQ(cover.mesh.positions[v], cover.mesh.positions[cover.mirror[v]]);
    }
}

// A function's differences on the covering are its differences on the surface.
void expectRestricted(const Mesh& mesh, const DoubleCover& cover)
{
    const auto f = [](const Vec3& p) { return std::complex<double>(p.x() - 2 * p.z(), p.y()); };
    const Halfedges above(cover.mesh.faces, cover.mesh.vertexCount()), he(mesh.faces, mesh.vertexCount());
    Eigen::VectorXcd form(above.count());
    for (int h = 0; h < above.count(); ++h)
        form[h] = f(cover.mesh.positions[above.head(h)]) - f(cover.mesh.positions[above.tail(h)]);
    const Eigen::VectorXcd restricted = restrictToSurface(cover, form);
    ASSERT_EQ(restricted.size(), he.count());
    for (int h = 0; h < he.count(); ++h)
        EXPECT_LT(std::abs(restricted[h] - (f(mesh.positions[he.head(h)]) - f(mesh.positions[he.tail(h)]))),
                  1e-12);
}

TEST(DoubleCover, OfPlatesAndHandles)
{
    for (const Mesh& mesh : {shapes::plate(2, 4), shapes::cylinder(1, 2, 12, 5), shapes::disk(1, 3),
                             shapes::surfaceOfGenus(1, 3, 4)}) {
        const DoubleCover cover = covering(mesh);
        expectSymmetric(mesh, cover);
        expectRestricted(mesh, cover);
    }
}

TEST(DoubleCover, HalvesEdgesThatJoinBoundaryVertices)
{
    // Fans of 4 to 6 triangles without a vertex inside: 1 to 3 chords, and triangles with one, two or three.
    const Mesh square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    const Mesh fan{{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 2, 0}, {0, 1, 0}},
                   {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}};
    const Mesh star{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1.5, 1, 0}, {1, 2, 0}, {0.5, 1, 0}},
                    {{0, 1, 5}, {1, 2, 3}, {5, 3, 4}, {1, 3, 5}}};
    const Mesh strip = shapes::cylinder(1, 1, 7, 1);
    const std::vector<std::pair<const Mesh*, int>> chords = {
        {&square, 1}, {&fan, 2}, {&star, 3}, {&strip, 14}};
    for (const auto& [mesh, count] : chords) {
        const DoubleCover cover = covering(*mesh);
        EXPECT_EQ(cover.mesh.vertexCount(), mesh->vertexCount() + 2 * count);
        EXPECT_EQ(cover.sheetFaces(), mesh->faceCount() + 2 * count);
        expectSymmetric(*mesh, cover);
        expectRestricted(*mesh, cover);
    }
}

TEST(DoubleCover, SymmetricPartIsAProjectionAndRealOnTheSeam)
{
    const Mesh mesh = shapes::plate(1, 3);
    const DoubleCover cover = covering(mesh);
    const Halfedges he(cover.mesh.faces, cover.mesh.vertexCount());
    Eigen::VectorXcd form(he.count());
    for (int h = 0; h < he.count(); ++h)
        if (h < he.twin(h)) {
            form[h] = {std::sin(1.7 * h), std::cos(2.9 * h)};
            form[he.twin(h)] = -form[h];
        }
    const Eigen::VectorXcd part = symmetricPart(cover, form);
    EXPECT_LT((symmetricPart(cover, part) - part).norm(), 1e-13);
    EXPECT_GT(part.norm(), 0.1 * form.norm());
    int seam = 0;
    for (int h = 0; h < he.count(); ++h)
        if (cover.onSeam(he.tail(h)) && cover.onSeam(he.head(h))) {
            ++seam;
            EXPECT_EQ(part[h].imag(), 0);
        }
    EXPECT_GT(seam, 20);
}

TEST(DoubleCover, Refusals)
{
    EXPECT_EQ(doubleCover(shapes::torus(2, 1, 6, 6)).error().kind, ErrorKind::BadArgument);
    const Mesh triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    EXPECT_EQ(doubleCover(triangle).error().kind, ErrorKind::BadArgument);
}

TEST(Puncture, TakesTheStarsOfVertices)
{
    const Mesh torus = shapes::torus(2, 1, 12, 12);
    const Result<PuncturedSurface> punctured = puncture(torus, std::vector<int>{0, 70});
    ASSERT_TRUE(punctured.ok()) << punctured.error().message;
    const Topology type = topology(punctured->mesh);
    EXPECT_EQ(type.genus, 1);
    EXPECT_EQ(type.boundaries, 2);
    EXPECT_EQ(type.vertices, torus.vertexCount() - 2);
    for (int f = 0; f < type.faces; ++f)
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(punctured->vertexOf[punctured->mesh.faces[f][k]], torus.faces[punctured->faceOf[f]][k]);
            EXPECT_NE(punctured->vertexOf[punctured->mesh.faces[f][k]], 70);
        }
}

TEST(Puncture, RefusesNeighboursAndBoundaries)
{
    const Mesh disk = shapes::disk(1, 4);
    EXPECT_EQ(puncture(disk, std::vector<int>{disk.vertexCount() - 1}).error().kind, ErrorKind::BadArgument);
    EXPECT_EQ(puncture(disk, std::vector<int>{-1}).error().kind, ErrorKind::BadArgument);
    EXPECT_EQ(puncture(disk, std::vector<int>{disk.vertexCount()}).error().kind, ErrorKind::BadArgument);
    const Halfedges he(disk.faces, disk.vertexCount());
    int inside = 0;
    while (topology(disk).boundaries != 1 || !puncture(disk, std::vector<int>{inside}).ok()) ++inside;
    EXPECT_EQ(puncture(disk, std::vector<int>{inside, he.head(he.outgoing(inside))}).error().kind,
              ErrorKind::BadArgument);
    EXPECT_EQ(puncture(disk, std::vector<int>{inside, inside}).error().kind, ErrorKind::BadArgument);
}

} // namespace
} // namespace gimg

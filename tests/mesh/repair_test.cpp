// What reading repairs, what it refuses, and that it says so with the file's own numbers.
#include "gimg/mesh_io.h"
#include "shapes.h"
#include "temporary_files.h"

#include <gmock/gmock.h>

#include <sstream>

using namespace gimg;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

namespace {

class Repair : public test::TemporaryFiles
{
protected:
    Result<MeshFile> readObj(std::string_view text, const ReadOptions& options = {})
    {
        return readMesh(write("mesh.obj", text), options);
    }
    MeshFile accept(std::string_view text, const ReadOptions& options = {})
    {
        Result<MeshFile> file = readObj(text, options);
        EXPECT_TRUE(file.ok()) << file.error().message;
        return file.ok() ? *file : MeshFile{};
    }
    void refuse(std::string_view text, ErrorKind kind, const std::string& message,
                const ReadOptions& options = {})
    {
        const Result<MeshFile> file = readObj(text, options);
        ASSERT_FALSE(file.ok()) << message;
        EXPECT_EQ(file.error().kind, kind);
        EXPECT_EQ(file.error().message, path("mesh.obj") + ": " + message);
    }
};

std::string obj(const Mesh& mesh)
{
    std::ostringstream text;
    text.precision(17);
    for (const Vec3& p : mesh.positions) text << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
    for (const Triangle& t : mesh.faces)
        text << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
    return text.str();
}

void append(Mesh& mesh, const Mesh& other, const Vec3& offset)
{
    const int first = mesh.vertexCount();
    for (const Vec3& p : other.positions) mesh.positions.push_back(p + offset);
    for (const Triangle& t : other.faces) mesh.faces.push_back({t[0] + first, t[1] + first, t[2] + first});
}

} // namespace

TEST_F(Repair, CleanMeshesPassUntouched)
{
    const Mesh torus = test::torus(2, 1, 12, 9);
    const MeshFile file = accept(obj(torus));
    EXPECT_EQ(file.mesh.positions, torus.positions);
    EXPECT_EQ(file.mesh.faces, torus.faces);
    EXPECT_THAT(warnings(file.report), IsEmpty());
    EXPECT_EQ(file.report.verticesRead, 108);
    EXPECT_EQ(file.report.facesRead, 216);
    EXPECT_EQ(file.report.components, 1);
    EXPECT_EQ(topology(file.mesh).genus, 1);
}

TEST_F(Repair, AConsistentInwardOrientationIsLeftAlone)
{
    Mesh inward = test::tetrahedron();
    for (Triangle& t : inward.faces) std::swap(t[1], t[2]);
    EXPECT_LT(test::signedVolume(accept(obj(inward)).mesh), 0);
}

TEST_F(Repair, UnreferencedVerticesAreDroppedEvenWhereTheyAreNotFinite)
{
    const MeshFile file = accept("v nan 0 0\nv 0 0 0\nv 1 0 0\nv 5 5 5\nv 0 1 0\nf 2 3 5\n");
    EXPECT_THAT(file.mesh.positions, ElementsAre(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)));
    EXPECT_THAT(file.mesh.faces, ElementsAre(Triangle{0, 1, 2}));
    EXPECT_THAT(warnings(file.report), ElementsAre("2 vertices in no face dropped"));
}

TEST_F(Repair, FacesWithARepeatedVertexAndDuplicatesAreRemoved)
{
    const MeshFile file =
        accept("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 3 3 2\nf 2 4 3\nf 2 3 1\nf 3 2 1\nf 4 4 4\n");
    EXPECT_THAT(file.mesh.faces, ElementsAre(Triangle{0, 1, 2}, Triangle{1, 3, 2}));
    EXPECT_EQ(file.report.repeatedVertexFaces, 2);
    EXPECT_EQ(file.report.duplicateFaces, 2);
    EXPECT_THAT(warnings(file.report),
                ElementsAre("2 faces with a repeated vertex removed", "2 duplicate faces removed"));
}

TEST_F(Repair, NothingButRepeatedVerticesIsEmpty)
{
    refuse("v 0 0 0\nv 1 0 0\nf 1 1 2\n", ErrorKind::EmptyMesh, "no face has three different vertices");
}

TEST_F(Repair, ZeroAreaFacesAreKeptBecauseTheyCloseTheSurface)
{
    // A tetrahedron with a vertex (5) in the middle of edge 1-2: the face 1 2 5 has no area, and without it
    // there is a hole.
    const MeshFile file = accept("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0.5 0 0\nf 1 3 2\nf 1 5 4\nf 5 2 "
                                 "4\nf 2 3 4\nf 3 1 4\nf 1 2 5\n");
    EXPECT_EQ(file.report.zeroAreaFaces, 1);
    EXPECT_THAT(warnings(file.report), ElementsAre("1 face of zero area kept"));
    EXPECT_EQ(topology(file.mesh).boundaries, 0);
    EXPECT_EQ(topology(file.mesh).euler(), 2);
}

TEST_F(Repair, OrientationOfAClosedSurfaceEndsUpOutward)
{
    for (size_t flips : {size_t{1}, size_t{200}}) {
        Mesh mixed = test::torus(2, 1, 12, 9);
        for (Vec3& p : mixed.positions)
            p += Vec3(100, -50, 7); // the sign of the volume must not depend on the origin
        for (size_t f = 0; f < flips; ++f) std::swap(mixed.faces[f][0], mixed.faces[f][1]);
        const MeshFile file = accept(obj(mixed));
        EXPECT_EQ(file.report.flippedFaces, static_cast<int64_t>(flips));
        Mesh centred = file.mesh;
        for (Vec3& p : centred.positions) p -= Vec3(100, -50, 7);
        EXPECT_GT(test::signedVolume(centred), 0);
    }
}

TEST_F(Repair, OrientationOfAnOpenSurfaceFollowsTheMajority)
{
    for (size_t flips : {size_t{3}, size_t{30}}) {
        Mesh mixed = test::square(4); // 32 triangles
        for (size_t f = 0; f < flips; ++f) std::swap(mixed.faces[f][0], mixed.faces[f][1]);
        const MeshFile file = accept(obj(mixed));
        EXPECT_EQ(file.report.flippedFaces, flips == 3 ? 3 : 2);
        EXPECT_THAT(warnings(file.report),
                    ElementsAre(HasSubstr("faces flipped for a consistent orientation")));
        const Triangle& t = file.mesh.faces[10];
        const auto& p = file.mesh.positions;
        EXPECT_EQ((p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]])[2] > 0, flips == 3);
    }
}

TEST_F(Repair, AMoebiusBandIsNotOrientable)
{
    EXPECT_EQ(topology(accept(obj(test::band(8, false))).mesh).boundaries, 2);
    const Result<MeshFile> file = readObj(obj(test::band(8, true)));
    ASSERT_FALSE(file.ok());
    EXPECT_EQ(file.error().kind, ErrorKind::NotOrientable);
    EXPECT_THAT(file.error().message,
                ::testing::ContainsRegex(
                    "not orientable: the two faces at edge [0-9]+-[0-9]+ cannot agree on a side"));
}

TEST_F(Repair, NonManifoldEdgesAreNamed)
{
    refuse("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 5 2 1\n",
           ErrorKind::NonManifoldEdge, "non-manifold edge 2-1: 3 faces");
    // Two more sheets on the edges of the first triangle.
    refuse("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 2\nv 0 0 3\nf 1 2 3\nf 1 2 4\nf 1 2 5\nf 2 3 "
           "6\nf 2 3 7\nf 1 2 7\n",
           ErrorKind::NonManifoldEdge, "non-manifold edge 1-2: 4 faces, and 1 more such edge");
}

TEST_F(Repair, NonManifoldVerticesAreNamed)
{
    // Two vertices inside a square become one, where both their fans then meet.
    Mesh pinched = test::square(8);
    for (Triangle& t : pinched.faces)
        for (int& v : t)
            if (v == 6 * 9 + 6) v = 2 * 9 + 2;
    refuse(obj(pinched), ErrorKind::NonManifoldVertex,
           "non-manifold vertex 21 at (0.25, 0.25, 0): 2 fans of faces meet only there");
}

TEST_F(Repair, OffCountsFromZero)
{
    const Result<MeshFile> file = readMesh(
        write("a.off", "OFF\n5 3 0\n0 0 0\n1 0 0\n0 1 0\n0 -1 0\n0 0 1\n3 0 1 2\n3 1 0 3\n3 0 1 4\n"));
    ASSERT_FALSE(file.ok());
    EXPECT_EQ(file.error().message, path("a.off") + ": non-manifold edge 0-1: 3 faces");
}

TEST_F(Repair, CoordinatesThatAreNotFiniteAreNamed)
{
    refuse("v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n", ErrorKind::NotFinite,
           "vertex 2 is not finite at (1, nan, 0)");
    refuse("v 0 0 0\nv 1 0 -inf\nv 0 1e999 0\nf 1 2 3\n", ErrorKind::NotFinite,
           "vertex 2 is not finite at (1, 0, -inf), and 1 more such vertex");
    EXPECT_EQ(accept("v 0 0 0\nv 1 0 1e-999\nv 0 1 0\nf 1 2 3\n").mesh.positions[1], Vec3(1, 0, 0));
}

TEST_F(Repair, AnStlFacetThatIsNotFiniteIsNamedByItsVertexAlthoughNothingWeldsToIt)
{
    const Result<MeshFile> file =
        readMesh(write("a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                                "vertex 0 1 0\nendloop\nendfacet\nfacet normal 0 0 1\nouter loop\n"
                                "vertex nan 0 0\nvertex 1 0 inf\nvertex 0 1 nan\nendloop\n"
                                "endfacet\nendsolid\n"));
    ASSERT_FALSE(file.ok());
    EXPECT_EQ(file.error().message,
              path("a.stl") + ": vertex 3 is not finite at (nan, 0, 0), and 2 more such vertices");
}

TEST_F(Repair, SeveralComponentsAreCountedAndTheLargestCanBeTaken)
{
    Mesh parts = test::tetrahedron();
    append(parts, test::torus(2, 1, 6, 5), Vec3(10, 0, 0));
    append(parts, test::square(1), Vec3(20, 0, 0));
    refuse(obj(parts), ErrorKind::SeveralComponents,
           "3 connected components, with 60, 4, 2 triangles; one is needed (the largest can be chosen)");
    const MeshFile file = accept(obj(parts), {.largestComponent = true});
    EXPECT_EQ(file.mesh.faceCount(), 60);
    EXPECT_EQ(file.mesh.vertexCount(), 30);
    EXPECT_EQ(file.mesh.positions[0], Vec3(13, 0, 0));
    EXPECT_THAT(warnings(file.report),
                ElementsAre("the largest of 3 components taken, 6 triangles of the others dropped"));
}

TEST_F(Repair, DefectsOfOtherComponentsDoNotMatter)
{
    Mesh parts = test::torus(2, 1, 6, 5);
    append(parts,
           {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, std::nan("")}},
            {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}},
           Vec3(10, 0, 0));
    EXPECT_EQ(accept(obj(parts), {.largestComponent = true}).mesh.faceCount(), 60);
    // But those of the chosen one do.
    parts.faces[0][1] = parts.faces[0][0] == 7 ? 8 : 7;
    EXPECT_FALSE(readObj(obj(parts), {.largestComponent = true}).ok());
}

TEST_F(Repair, PartsThatTouchInAVertexAreSeveralComponents)
{
    const std::string touching =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nv -1 -1 0\nf 1 2 3\nf 1 4 5\nf 4 6 5\n";
    refuse(touching, ErrorKind::SeveralComponents,
           "2 connected components, with 2, 1 triangles; one is needed (the largest can be chosen)");
    EXPECT_EQ(accept(touching, {.largestComponent = true}).mesh.faceCount(), 2);
}

TEST_F(Repair, RepeatedPositionsAreWeldedWhereThatHarmsNothing)
{
    // The eight sides of the sphere share positions along their borders: 6 corners x 4, 12 sides x 3 points
    // x 2.
    const Mesh sides = test::sphere(1, 2);
    ASSERT_EQ(sides.vertexCount(), 8 * 15);
    const MeshFile file = accept(obj(sides));
    EXPECT_EQ(file.mesh.vertexCount(), 66);
    EXPECT_EQ(file.report.repeatedPositions, 54);
    EXPECT_EQ(file.report.weldedVertices, 54);
    EXPECT_EQ(topology(file.mesh).euler(), 2);
    EXPECT_EQ(topology(file.mesh).boundaries, 0);
    EXPECT_THAT(warnings(file.report),
                ElementsAre("54 vertices welded to an earlier one at the same position"));

    refuse(obj(sides), ErrorKind::SeveralComponents,
           "8 connected components, with 16, 16, 16, 16, 16, ... triangles; one is needed (the largest can "
           "be chosen)",
           {.weld = Weld::Never});
}

TEST_F(Repair, WeldingThatWouldMakeADefectIsLeftOutAndSaidSo)
{
    // A face collapses: its two ends are at one place.
    const std::string sliver = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n";
    const MeshFile kept = accept(sliver);
    EXPECT_EQ(kept.mesh.faceCount(), 2);
    EXPECT_EQ(kept.report.repeatedPositions, 1);
    EXPECT_EQ(kept.report.weldedVertices, 0);
    EXPECT_EQ(kept.report.zeroAreaFaces, 1);
    EXPECT_EQ(kept.report.weldRefusal, "1 face with a repeated vertex");
    EXPECT_THAT(warnings(kept.report), Contains("1 vertex at the position of an earlier one left apart: "
                                                "welding would make 1 face with a repeated vertex"));
    const MeshFile forced = accept(sliver, {.weld = Weld::Always});
    EXPECT_EQ(forced.mesh.faceCount(), 1);
    EXPECT_EQ(forced.report.repeatedVertexFaces, 1);
}

TEST_F(Repair, WeldingThatWouldPinchIsLeftOut)
{
    Mesh touching = test::square(8);
    touching.positions[6 * 9 + 6] = touching.positions[2 * 9 + 2]; // two interior vertices at one place
    const MeshFile file = accept(obj(touching));
    EXPECT_EQ(file.report.weldRefusal, "1 non-manifold vertex");
    EXPECT_EQ(file.mesh.vertexCount(), 81);
    refuse(obj(touching), ErrorKind::NonManifoldVertex,
           "non-manifold vertex 21 at (0.25, 0.25, 0): 2 fans of faces meet only there",
           {.weld = Weld::Always});
}

TEST_F(Repair, WeldingThatWouldGlueThreeSheetsIsLeftOutAndTheRefusalSaysSo)
{
    const std::string sheets =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nv 1 0 0\nv 0 -1 0\nv 0 0 0\nv 1 0 0\nv 0 0 1\n"
        "f 1 2 3\nf 4 5 6\nf 7 8 9\n";
    refuse(sheets, ErrorKind::SeveralComponents,
           "3 connected components, with 1, 1, 1 triangles; one is needed (the largest can be chosen); "
           "4 repeated positions were not welded, which would make 1 non-manifold edge");
    refuse(sheets, ErrorKind::NonManifoldEdge, "non-manifold edge 1-2: 3 faces", {.weld = Weld::Always});
}

TEST_F(Repair, WeldingThatWouldLoseTheOrientationIsLeftOut)
{
    Mesh cut = test::band(8, true);
    // Cut the Moebius band open: the last two triangles get end vertices of their own.
    const int ends = cut.vertexCount();
    cut.positions.push_back(cut.positions[0]);
    cut.positions.push_back(cut.positions[1]);
    for (size_t f = cut.faces.size() - 2; f < cut.faces.size(); ++f)
        for (int& v : cut.faces[f])
            if (v < 2) v += ends;
    const MeshFile file = accept(obj(cut));
    EXPECT_EQ(file.report.weldRefusal, "a surface without orientation");
    EXPECT_EQ(topology(file.mesh).boundaries, 1);
}

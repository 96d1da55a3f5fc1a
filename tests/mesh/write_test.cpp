#include "gimg/mesh_io.h"
#include "shapes.h"
#include "temporary_files.h"

#include <gmock/gmock.h>

#include <limits>

using namespace gimg;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

namespace {

class WriteMesh : public test::TemporaryFiles
{
};

const Encoding kEncodings[] = {Encoding::Binary, Encoding::BinaryBigEndian, Encoding::Ascii};

} // namespace

TEST_F(WriteMesh, DoublesSurviveARoundTripInIndexedFormats)
{
    const Mesh torus = test::torus(2, 1.0 / 3, 12, 9);
    const std::vector<Vec3> normals = vertexNormals(torus);
    for (const char* name : {"a.obj", "a.ply", "a.off"})
        for (Encoding encoding : kEncodings)
            for (bool withNormals : {false, true}) {
                const Status status =
                    writeMesh(torus, path(name), withNormals ? normals : std::vector<Vec3>{}, encoding);
                ASSERT_TRUE(status.ok()) << status.error().message;
                const Result<MeshFile> file = readMesh(path(name));
                ASSERT_TRUE(file.ok()) << file.error().message;
                EXPECT_EQ(file->mesh.positions, torus.positions) << name;
                EXPECT_EQ(file->mesh.faces, torus.faces) << name;
                EXPECT_TRUE(warnings(file->report).empty());
            }
}

TEST_F(WriteMesh, AttributesSurviveARoundTripInPly)
{
    const Mesh mesh = test::tetrahedron();
    const std::vector<VertexAttribute> attributes = {
        {"color", 4, GIM_U16, true, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 65535, 13, 14, 15, 16}},
        {"uv", 2, GIM_F32, false, {0, 0.5, 1, 0.25, 2, 0.125, 3, 0}},
        {"group", 1, GIM_U8, false, {0, 1, 2, 255}}};
    for (const Encoding encoding : kEncodings) {
        ASSERT_TRUE(writeMesh(mesh, path("a.ply"), {}, encoding, attributes).ok());
        const Result<MeshFile> back = readMesh(path("a.ply"));
        ASSERT_TRUE(back.ok()) << back.error().message;
        ASSERT_EQ(back->attributed.attributes.size(), attributes.size());
        for (size_t k = 0; k < attributes.size(); ++k) {
            const VertexAttribute& found = back->attributed.attributes[k];
            EXPECT_EQ(found.name, attributes[k].name);
            EXPECT_EQ(found.type, attributes[k].type);
            EXPECT_EQ(found.normalized, attributes[k].normalized);
            // Vertices come in the order of the faces.
            for (int v = 0; v < mesh.vertexCount(); ++v) {
                const auto at = std::find(mesh.positions.begin(), mesh.positions.end(),
                                          back->attributed.mesh.positions[v]);
                const auto from = (at - mesh.positions.begin()) * found.channels;
                for (int c = 0; c < found.channels; ++c)
                    EXPECT_EQ(found.values[v * found.channels + c], attributes[k].values[from + c]);
            }
        }
    }
    std::vector<VertexAttribute> wrong = attributes;
    wrong[1].values.pop_back();
    EXPECT_EQ(writeMesh(mesh, path("a.ply"), {}, Encoding::Binary, wrong).error().kind,
              ErrorKind::BadArgument);
}

TEST_F(WriteMesh, PlyIsFloatWhereThatIsExact)
{
    Mesh mesh = test::tetrahedron();
    ASSERT_TRUE(writeMesh(mesh, path("a.ply")).ok());
    EXPECT_THAT(read(path("a.ply")),
                HasSubstr("property float x\nproperty float y\nproperty float z\nelement face 4\n"));
    const size_t header = read(path("a.ply")).find("end_header\n") + 11;
    EXPECT_EQ(read(path("a.ply")).size(), header + 4 * 12 + 4 * 13);
    mesh.positions[2][1] = 0.1;
    ASSERT_TRUE(writeMesh(mesh, path("a.ply")).ok());
    EXPECT_THAT(read(path("a.ply")), HasSubstr("property double x\n"));
}

TEST_F(WriteMesh, StlHoldsFloatsAndNormals)
{
    const Mesh torus = test::torus(2, 1.0 / 3, 12, 9);
    for (Encoding encoding : {Encoding::Binary, Encoding::Ascii}) {
        ASSERT_TRUE(writeMesh(torus, path("a.stl"), {}, encoding).ok());
        const Result<MeshFile> file = readMesh(path("a.stl"));
        ASSERT_TRUE(file.ok()) << file.error().message;
        EXPECT_EQ(file->mesh.vertexCount(), torus.vertexCount());
        EXPECT_EQ(file->mesh.faceCount(), torus.faceCount());
        EXPECT_EQ(file->report.weldedVertices, 3 * torus.faceCount() - torus.vertexCount());
        EXPECT_EQ(topology(file->mesh).genus, 1);
        EXPECT_NEAR(surfaceArea(file->mesh), surfaceArea(torus), 1e-6);
    }
    ASSERT_TRUE(
        writeMesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, path("b.stl"), {}, Encoding::Ascii).ok());
    EXPECT_EQ(read(path("b.stl")),
              "solid mesh\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
              "endloop\nendfacet\nendsolid mesh\n");
    ASSERT_TRUE(writeMesh(torus, path("c.stl")).ok());
    EXPECT_THAT(read(path("c.stl")), Not(StartsWith("solid")));
    EXPECT_EQ(read(path("c.stl")).size(), 84U + 50U * 216U);
}

TEST_F(WriteMesh, ObjAndOffCarryNormals)
{
    const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    const std::vector<Vec3> up(3, Vec3(0, 0, 1));
    ASSERT_TRUE(writeMesh(mesh, path("a.obj"), up).ok());
    EXPECT_EQ(read(path("a.obj")),
              "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 0 1\nvn 0 0 1\nf 1//1 2//2 3//3\n");
    ASSERT_TRUE(writeMesh(mesh, path("a.off"), up).ok());
    EXPECT_EQ(read(path("a.off")), "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n");
}

TEST_F(WriteMesh, WhatCannotBeWrittenIsRefusedBeforeAFileIsMade)
{
    const auto refusal = [this](const Mesh& mesh, const std::string& name,
                                const std::vector<Vec3>& normals = {}, Encoding encoding = Encoding::Binary) {
        const Status status = writeMesh(mesh, path(name), normals, encoding);
        EXPECT_FALSE(status.ok());
        EXPECT_FALSE(std::filesystem::exists(path(name)));
        return status.ok() ? Error{} : status.error();
    };
    Mesh mesh = test::tetrahedron();
    EXPECT_EQ(refusal(mesh, "a.gltf").kind, ErrorKind::FormatUnknown);
    EXPECT_EQ(refusal(mesh, "none/a.obj").kind, ErrorKind::FileNotWritable);
    EXPECT_EQ(refusal(mesh, "a.stl", {}, Encoding::BinaryBigEndian).kind, ErrorKind::BadArgument);
    EXPECT_THAT(refusal(mesh, "a.ply", {Vec3(0, 0, 1)}).message, HasSubstr("1 normals for 4 vertices"));
    mesh.positions[1][0] = 1e60;
    EXPECT_EQ(refusal(mesh, "a.stl").kind, ErrorKind::NotFinite); // beyond float32
    mesh.positions[1][0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT(refusal(mesh, "a.ply").message, HasSubstr("vertex 1 is not finite"));
    mesh = test::tetrahedron();
    mesh.faces[2][1] = 4;
    EXPECT_THAT(refusal(mesh, "a.off").message, HasSubstr("face 2 names vertex 4 of 4"));
}

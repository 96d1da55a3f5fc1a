// Every format as it occurs in the wild, read to the last digit.
#include "gimg/mesh_io.h"
#include "shapes.h"
#include "temporary_files.h"

#include <set>

#include <gmock/gmock.h>

#include <bit>

using namespace gimg;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

namespace {

class ReadFormats : public test::TemporaryFiles
{
protected:
    MeshFile accept(const std::string& name, std::string_view bytes, const ReadOptions& options = {})
    {
        Result<MeshFile> file = readMesh(write(name, bytes), options);
        EXPECT_TRUE(file.ok()) << file.error().message;
        return file.ok() ? *file : MeshFile{};
    }
};

// One triangle with a coordinate that float32 cannot hold.
void expectTriangle(const Mesh& mesh)
{
    ASSERT_EQ(mesh.vertexCount(), 3);
    EXPECT_EQ(mesh.positions[0], Vec3(0.1, 0, 0));
    EXPECT_EQ(mesh.positions[1], Vec3(1, 0, 0));
    EXPECT_EQ(mesh.positions[2], Vec3(0, 1, -2.5e-3));
    EXPECT_THAT(mesh.faces, ElementsAre(Triangle{0, 1, 2}));
}

template <class T> void append(std::string& bytes, T value, bool bigEndian)
{
    std::string raw(reinterpret_cast<const char*>(&value), sizeof value);
    if (bigEndian != (std::endian::native == std::endian::big)) raw = std::string(raw.rbegin(), raw.rend());
    bytes += raw;
}

} // namespace

TEST_F(ReadFormats, ObjPlain)
{
    expectTriangle(accept("a.obj", "# comment\nv 0.1 0 0\nv 1 0 0\nv 0 1 -2.5e-3\nf 1 2 3\n").mesh);
}

TEST_F(ReadFormats, ObjWithAttributesGroupsAndCrlf)
{
    expectTriangle(
        accept("a.OBJ", "mtllib none.mtl\r\no first\r\nv 0.1 0 0 1 0 0\r\nv +1. 0 0\r\nvt 0 0\r\nvn 0 0 1\r\n"
                        "o second\r\nv 0 1 -.0025\r\ng x\r\nusemtl red\r\ns off\r\nf 1/1/1 2//1 3/1\r\n")
            .mesh);
}

TEST_F(ReadFormats, ObjWithNegativeIndicesCountsFromTheFaceLine)
{
    const MeshFile file =
        accept("a.obj", "v 0.1 0 0\nv 1 0 0\nv 0 1 -2.5e-3\nf -3 -2 -1\nv 1 1 0\nf -2 -3 -1\n");
    EXPECT_THAT(file.mesh.faces, ElementsAre(Triangle{0, 1, 2}, Triangle{2, 1, 3}));
}

TEST_F(ReadFormats, ObjFaceMayPrecedeItsVerticesAndSpanLines)
{
    expectTriangle(accept("a.obj", "f 1 \\\n2 \\\r\n3\nv 0.1 0 0\nv 1 0 0\nv 0 1 -2.5e-3\n").mesh);
}

TEST_F(ReadFormats, ObjWithoutFinalLineEndIsReportedNotRefused)
{
    const MeshFile file = accept("a.obj", "v 0.1 0 0\nv 1 0 0\nv 0 1 -2.5e-3\nf 1 2 3");
    expectTriangle(file.mesh);
    EXPECT_TRUE(file.report.lastLineOpen);
    EXPECT_THAT(warnings(file.report), ElementsAre(HasSubstr("may have been cut short")));
}

TEST_F(ReadFormats, PlyTextWithExtrasOnBothElements)
{
    expectTriangle(accept("a.ply",
                          "ply\nformat ascii 1.0\ncomment made by \\\nobj_info x\nelement vertex 3\n"
                          "property uchar red\nproperty double x\nproperty double y\n"
                          "property list uchar float weights\nproperty double z\n"
                          "element edge 1\nproperty int a\nproperty int b\n"
                          "element face 1\nproperty list uchar float texcoord\n"
                          "property list uchar int vertex_index\nproperty uchar flags\nend_header\n"
                          "255 0.1 0 2 .5 .5 0\n0 1 0 0 0\n0 0 1 1 9 -2.5e-3\n7 8\n2 0.5 0.5 3 0 1 2 1\n")
                       .mesh);
}

TEST_F(ReadFormats, PlyFacesMayPrecedeVertices)
{
    expectTriangle(
        accept("a.ply",
               "ply\r\nformat ascii 1.0\r\nelement face 1\r\nproperty list uchar uint vertex_indices\r\n"
               "element vertex 3\r\nproperty double x\r\nproperty double y\r\nproperty double z\r\n"
               "end_header\r\n3 0 1 2\r\n0.1 0 0\r\n1 0 0\r\n0 1 -2.5e-3\r\n")
            .mesh);
}

TEST_F(ReadFormats, PlyBinaryBothByteOrdersDoublesAndExtras)
{
    for (bool big : {false, true}) {
        std::string bytes =
            std::string("ply\nformat binary_") + (big ? "big" : "little") +
            "_endian 1.0\nelement vertex 3\nproperty float64 x\nproperty double y\nproperty double z\n"
            "property ushort label\nelement face 1\nproperty list ushort float32 uv\n"
            "property list int16 uint16 vertex_indices\nend_header\n";
        for (const Vec3& p : {Vec3(0.1, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, -2.5e-3)}) {
            for (double x : p) append(bytes, x, big);
            append(bytes, uint16_t{0x0a0d}, big); // looks like line ends
        }
        append(bytes, uint16_t{2}, big);
        append(bytes, 0.5F, big);
        append(bytes, 0.5F, big);
        append(bytes, int16_t{3}, big);
        for (uint16_t v = 0; v < 3; ++v) append(bytes, v, big);
        const MeshFile file = accept("a.ply", bytes);
        expectTriangle(file.mesh);
        EXPECT_EQ(file.report.trailingBytes, 0);

        const MeshFile longer = accept("b.ply", bytes + "12345");
        EXPECT_EQ(longer.report.trailingBytes, 5);
        EXPECT_THAT(warnings(longer.report), ElementsAre("5 bytes after the end of the data ignored"));
    }
}

TEST_F(ReadFormats, PlyBinarySignedIntegerCoordinates)
{
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty char x\nproperty short y\n"
        "property int z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    for (int i : {-3, 0, 5}) {
        append(bytes, static_cast<int8_t>(i), false);
        append(bytes, static_cast<int16_t>(i * i), false);
        append(bytes, int32_t{-i}, false);
    }
    append(bytes, uint8_t{3}, false);
    for (int v : {0, 1, 2}) append(bytes, v, false);
    EXPECT_THAT(accept("a.ply", bytes).mesh.positions,
                ElementsAre(Vec3(-3, 9, 3), Vec3(0, 0, 0), Vec3(5, 25, -5)));
}

/// The values of an attribute at a place; empty if there is no such attribute.
std::set<std::vector<float>> valuesAt(const AttributedSurface& surface, const std::string& name,
                                      const Vec3& at)
{
    std::set<std::vector<float>> values;
    const VertexAttribute* attribute = findAttribute(surface.attributes, name);
    for (int v = 0; attribute != nullptr && v < surface.mesh.vertexCount(); ++v) {
        const auto first = attribute->values.begin() + v * attribute->channels;
        if (surface.mesh.positions[v] == at) values.insert({first, first + attribute->channels});
    }
    return values;
}

TEST_F(ReadFormats, PlyKeepsWhatItTellsOfVertices)
{
    // Two triangles of a square whose texture jumps along the diagonal, a vertex in no face, and a flipped
    // face.
    const Result<MeshFile> file = readMesh(write("a.ply", R"(ply
format ascii 1.0
element vertex 7
property float x
property float y
property float z
property float nx
property uchar red
property uchar green
property uchar blue
property float s
property float t
property ushort group
element face 2
property list uchar int vertex_indices
end_header
9 9 9 0 1 2 3 9 9 9
0 0 0 0 10 20 30 0 0 1
1 0 0 0 11 21 31 1 0 2
1 1 0 0 12 22 32 1 1 3
0 0 0 0 10 20 30 5 5 4
1 1 0 0 12 22 32 6 6 5
0 1 0 0 13 23 33 5 6 6
3 1 2 3
3 4 6 5
)"));
    ASSERT_TRUE(file.ok()) << file.error().message;
    EXPECT_EQ(file->mesh.vertexCount(), 4);
    EXPECT_EQ(file->report.weldedVertices, 2);
    const AttributedSurface& told = file->attributed;
    ASSERT_EQ(told.attributes.size(), 3u);
    EXPECT_EQ(told.mesh.vertexCount(), 6);
    const VertexAttribute& color = *findAttribute(told.attributes, "color");
    EXPECT_EQ(color.type, GIM_U8);
    EXPECT_TRUE(color.normalized);
    using Values = std::set<std::vector<float>>;
    EXPECT_EQ(valuesAt(told, "color", {1, 1, 0}), (Values{{12, 22, 32}}));
    EXPECT_EQ(valuesAt(told, "color", {0, 1, 0}), (Values{{13, 23, 33}}));
    EXPECT_EQ(valuesAt(told, "uv", {1, 1, 0}), (Values{{1, 1}, {6, 6}}));
    EXPECT_EQ(valuesAt(told, "uv", {0, 0, 0}), (Values{{0, 0}, {5, 5}}));
    EXPECT_EQ(valuesAt(told, "group", {1, 0, 0}), (Values{{2}}));
    EXPECT_EQ(findAttribute(told.attributes, "group")->type, GIM_U16);
    // Both faces look the way that repair made them look.
    const auto normalOf = [](const Mesh& mesh, int f) {
        const Triangle& t = mesh.faces[f];
        return (mesh.positions[t[1]] - mesh.positions[t[0]])
            .cross(mesh.positions[t[2]] - mesh.positions[t[0]]);
    };
    for (int f = 0; f < 2; ++f) EXPECT_GT(normalOf(told.mesh, f).dot(normalOf(file->mesh, f)), 0);
}

TEST_F(ReadFormats, ObjColorsCountIfEveryVertexHasOne)
{
    const std::string all = "v 0 0 0 1 0.5 0\nv 1 0 0 1 0.5 0.25\nv 0 1 0 0 0 1\nf 1 2 3\n";
    const Result<MeshFile> colored = readMesh(write("c.obj", all));
    ASSERT_TRUE(colored.ok());
    ASSERT_EQ(colored->attributed.attributes.size(), 1u);
    EXPECT_EQ(valuesAt(colored->attributed, "color", {1, 0, 0}),
              (std::set<std::vector<float>>{{1, 0.5, 0.25}}));
    const Result<MeshFile> partly =
        readMesh(write("p.obj", "v 0 0 0 1 0.5 0\nv 1 0 0\nv 0 1 0 1\nf 1 2 3\n"));
    ASSERT_TRUE(partly.ok());
    EXPECT_TRUE(partly->attributed.attributes.empty());
}

TEST_F(ReadFormats, OffWithCommentsColoursAndBlankLines)
{
    expectTriangle(
        accept("a.off", "OFF # a comment\n# another\n\n3 1 0\n0.1 0 0 # first\n\n1 0 0 255 0 0\n0 1 -2.5e-3\n"
                        "# faces\n3 0 1 2 0.1 0.2 0.3\n")
            .mesh);
    expectTriangle(
        accept("b.off", "COFF\n3 1 3\n0.1 0 0 1 0 0 1\n1 0 0 1 0 0 1\n0 1 -2.5e-3 1 0 0 1\n3 0 1 2\n").mesh);
    expectTriangle(
        accept("c.off", "NOFF 3 1 0\n0.1 0 0 0 0 1\n1 0 0 0 0 1\n0 1 -2.5e-3 0 0 1\n3 0 1 2").mesh);
    expectTriangle(
        accept("d.off", "3 1 0\n0.1 0 0\n1 0 0\n0 1 -2.5e-3\n3 0 1 2\n").mesh); // the keyword is optional
}

TEST_F(ReadFormats, StlTextIsWelded)
{
    const std::string facet =
        "  facet normal nan 0 -nan(ind)\n    outer loop\n      vertex 0.1 0 0\n      vertex 1 0 0\n"
        "      vertex 0 1 -2.5e-3\n    endloop\n  endfacet\n";
    const std::string other =
        "  FACET NORMAL 0 0 0\n    OUTER LOOP\n      VERTEX 1 0 0\n      VERTEX 0.1 -0 0\n"
        "      VERTEX 0.5 -1 0\n    ENDLOOP\n  ENDFACET\n";
    const MeshFile file = accept("a.stl", "solid some name\n" + facet + other + "endsolid some name\n");
    EXPECT_EQ(file.mesh.vertexCount(), 4);
    EXPECT_THAT(file.mesh.faces, ElementsAre(Triangle{0, 1, 2}, Triangle{1, 0, 3}));
    EXPECT_EQ(file.report.verticesRead, 6);
    EXPECT_EQ(file.report.weldedVertices, 2);
}

TEST_F(ReadFormats, StlBinaryIsWeldedEvenWhenItSaysSolid)
{
    for (const char* header : {"binary", "solid but binary\n"}) {
        std::string bytes = header;
        bytes.resize(80, ' ');
        append(bytes, uint32_t{2}, false);
        for (const auto& [p, q, r] : {std::tuple(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)),
                                      std::tuple(Vec3(1, 0, 0), Vec3(-0.0, 0, 0), Vec3(0.5, -1, 0))}) {
            for (int k = 0; k < 3; ++k) append(bytes, 0.F, false);
            for (const Vec3& v : {p, q, r})
                for (double x : v) append(bytes, static_cast<float>(x), false);
            append(bytes, uint16_t{0xffff}, false); // some programs put a colour here
        }
        const MeshFile file = accept("a.stl", bytes);
        EXPECT_EQ(file.mesh.vertexCount(), 4);
        EXPECT_EQ(file.mesh.faceCount(), 2);
    }
}

TEST_F(ReadFormats, StlNotWeldedIsOneComponentAFacet)
{
    const std::string name = path("a.stl");
    ASSERT_TRUE(writeMesh(test::tetrahedron(), name).ok());
    const Result<MeshFile> apart = readMesh(name, {.weld = Weld::Never});
    ASSERT_FALSE(apart.ok());
    EXPECT_EQ(apart.error().kind, ErrorKind::SeveralComponents);
    EXPECT_THAT(apart.error().message, HasSubstr("4 connected components, with 1, 1, 1, 1 triangles"));
    EXPECT_TRUE(readMesh(name).ok());
}

TEST_F(ReadFormats, TrianglesForMeasuringNeedNoTopology)
{
    // Three triangles on one edge and a lone one; a quad; an unreferenced NaN.
    const Result<Mesh> mesh = readTriangles(
        write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv nan 0 0\nv 9 9 9\nv 9 9 8\nv 9 8 9\n"
                       "f 1 2 3\nf 1 2 4\nf 1 2 5\nf 7 8 9\nf 3 4 5 2\n"));
    ASSERT_TRUE(mesh.ok()) << mesh.error().message;
    EXPECT_EQ(mesh->faceCount(), 6);
    const Result<Mesh> infinite = readTriangles(write("b.obj", "v 0 0 0\nv 1 0 0\nv 0 inf 0\nf 1 2 3\n"));
    ASSERT_FALSE(infinite.ok());
    EXPECT_EQ(infinite.error().kind, ErrorKind::NotFinite);
    EXPECT_THAT(infinite.error().message, HasSubstr("vertex 3 is not finite"));
}

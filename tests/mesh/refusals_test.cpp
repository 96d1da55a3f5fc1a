// Files that contradict themselves: one line each, naming what is wrong; never a crash, never a hang.
#include "gimg/mesh_io.h"
#include "shapes.h"
#include "temporary_files.h"

#include <gmock/gmock.h>

#include <random>

using namespace gimg;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

namespace {

class Refusals : public test::TemporaryFiles
{
protected:
    void refuse(const std::string& name, std::string_view bytes, ErrorKind kind, const std::string& message)
    {
        const std::string file = write(name, bytes);
        const Result<MeshFile> result = readMesh(file);
        ASSERT_FALSE(result.ok()) << name << " should have been refused: " << message;
        EXPECT_EQ(result.error().kind, kind) << result.error().message;
        EXPECT_THAT(result.error().message, StartsWith(file + ": "));
        EXPECT_THAT(result.error().message, HasSubstr(message));
        EXPECT_THAT(result.error().message, Not(HasSubstr("\n")));
        const Result<Mesh> triangles = readTriangles(file);
        ASSERT_FALSE(triangles.ok());
        EXPECT_EQ(triangles.error().kind, kind);
    }
};

std::string plyHeader(const std::string& format, const std::string& vertices, const std::string& faces)
{
    return "ply\nformat " + format + " 1.0\nelement vertex " + vertices +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
           "\nproperty list uchar int vertex_indices\nend_header\n";
}

const std::string kThreeVertices = "0 0 0\n1 0 0\n0 1 0\n";

} // namespace

TEST_F(Refusals, PathsThatAreNoFile)
{
    const Result<MeshFile> missing = readMesh(path("missing.obj"));
    ASSERT_FALSE(missing.ok());
    EXPECT_EQ(missing.error().kind, ErrorKind::FileNotReadable);
    EXPECT_EQ(missing.error().message, path("missing.obj") + ": no such file");

    std::filesystem::create_directory(path("folder.ply"));
    const Result<MeshFile> folder = readMesh(path("folder.ply"));
    ASSERT_FALSE(folder.ok());
    EXPECT_EQ(folder.error().message, path("folder.ply") + ": is a directory");

    const Result<MeshFile> unknown = readMesh(write("a.3ds", "x"));
    ASSERT_FALSE(unknown.ok());
    EXPECT_EQ(unknown.error().kind, ErrorKind::FormatUnknown);
    EXPECT_THAT(unknown.error().message,
                HasSubstr("unknown mesh format '.3ds', known are .obj, .ply, .off and .stl"));

    const Result<MeshFile> bare = readMesh(write("obj", "v 0 0 0"));
    ASSERT_FALSE(bare.ok());
    EXPECT_EQ(bare.error().kind, ErrorKind::FormatUnknown);
}

TEST_F(Refusals, NothingInTheFile)
{
    for (const char* name : {"a.obj", "a.ply", "a.off", "a.stl"})
        refuse(name, "", ErrorKind::EmptyMesh, "the file is empty");
    refuse("b.obj", "v 0 0 0\n", ErrorKind::EmptyMesh, "no faces (1 vertices)");
    refuse("b.obj", "\n", ErrorKind::EmptyMesh, "no faces (0 vertices)");
    refuse("b.ply", plyHeader("ascii", "3", "0") + kThreeVertices, ErrorKind::EmptyMesh,
           "no faces (3 vertices)");
    refuse("b.off", "OFF\n0 0 0\n", ErrorKind::EmptyMesh, "no faces");
    refuse("b.stl", "solid x\nendsolid x\n", ErrorKind::EmptyMesh, "no faces");
    refuse("c.stl", std::string(84, '\0'), ErrorKind::EmptyMesh, "no faces");
}

TEST_F(Refusals, Obj)
{
    const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    refuse("a.obj", v + "f 1 2 3\nf 1 2 9\n", ErrorKind::FileCorrupt,
           "face 2: vertex 9 does not exist, the file has 3");
    refuse("a.obj", v + "f 1 2 0\n", ErrorKind::FileCorrupt,
           "line 4: face 1 names a vertex 0 that cannot exist");
    refuse("a.obj", v + "f 1 2 -4\n", ErrorKind::FileCorrupt,
           "line 4: face 1 names a vertex -4 that cannot exist");
    refuse("a.obj", v + "f 1 2 99999999999\n", ErrorKind::FileCorrupt, "names a vertex 99999999999");
    refuse("a.obj", v + "f 1 2\nf 1 2 3\n", ErrorKind::FileCorrupt,
           "line 4: face 1 is not three or more vertex indices");
    refuse("a.obj", v + "f 1 2 three\n", ErrorKind::FileCorrupt, "line 4: face 1");
    refuse("a.obj", v + "f 1 2 3x\n", ErrorKind::FileCorrupt, "line 4: face 1");
    refuse("a.obj", v + "f 1 2 3/x\n", ErrorKind::FileCorrupt, "line 4: face 1");
    refuse("a.obj", "v 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", ErrorKind::FileCorrupt,
           "line 1: vertex 1 is not made of numbers");
    refuse("a.obj", "v 0 0 0\nv 1 O 0\nv 0 1 0\nf 1 2 3\n", ErrorKind::FileCorrupt,
           "line 2: vertex 2 is not made of numbers");
    refuse("a.obj", v + "f 1 2 3\nf 1 2", ErrorKind::FileTruncated, "the file ends within the 'f' of line 5");
    refuse("a.obj", v + "f 1 2 3\nv 0.5 -", ErrorKind::FileTruncated,
           "the file ends within the 'v' of line 5");
    refuse("a.obj", v + "f 1 2 3\nvn 0 1", ErrorKind::FileTruncated,
           "the file ends within the 'vn' of line 5");
}

TEST_F(Refusals, PlyHeader)
{
    refuse("a.ply", "plx\n", ErrorKind::FileCorrupt, "not a PLY file");
    refuse("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\n", ErrorKind::FileTruncated,
           "within the header");
    refuse("a.ply", "ply\nformat middle_endian 1.0\n", ErrorKind::FileCorrupt,
           "line 2: unknown format 'middle_endian'");
    refuse("a.ply", "ply\nformat ascii 2.0\n", ErrorKind::FileCorrupt, "line 2: only version 1.0");
    refuse("a.ply", "ply\nend_header\n", ErrorKind::FileCorrupt, "names no format");
    refuse("a.ply", "ply\nformat ascii 1.0\nelement vertex -1\n", ErrorKind::FileCorrupt,
           "line 3: bad element count");
    refuse("a.ply", "ply\nformat ascii 1.0\nelement vertex 9999999999\n", ErrorKind::FileCorrupt,
           "line 3: bad element count");
    refuse("a.ply", "ply\nformat ascii 1.0\nproperty int a\n", ErrorKind::FileCorrupt,
           "line 3: a property before any element");
    refuse("a.ply", "ply\nformat ascii 1.0\nelement v 1\nproperty quad x\n", ErrorKind::FileCorrupt,
           "line 4: unknown property type");
    refuse("a.ply", "ply\nformat ascii 1.0\nelement v 1\nelement v 1\n", ErrorKind::FileCorrupt,
           "line 4: element declared twice");
    refuse("a.ply", "ply\nformat ascii 1.0\nhello\n", ErrorKind::FileCorrupt,
           "line 3: unknown header keyword 'hello'");
    refuse("a.ply",
           "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n",
           ErrorKind::FileCorrupt, "element vertex has no property z");
    refuse("a.ply",
           "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int corners\nend_header\n3 0 1 2\n",
           ErrorKind::FileCorrupt, "element face has no list vertex_indices");
}

TEST_F(Refusals, PlyBody)
{
    const std::string header = plyHeader("ascii", "3", "2");
    refuse("a.ply", header + kThreeVertices + "3 0 1 2\n3 0 1\n", ErrorKind::FileTruncated,
           "the file ends within face 1, the header promises 2 of them");
    refuse("a.ply", header + "0 0 0\n1 0 0\n0 1 0\n", ErrorKind::FileTruncated,
           "the header promises 2 of element face, more than the file can hold");
    refuse("a.ply", plyHeader("ascii", "4", "1") + kThreeVertices + "3 0\n", ErrorKind::FileTruncated,
           "the file ends within vertex 3, the header promises 4 of them");
    refuse("a.ply", header + "0 0 zero\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 2\n", ErrorKind::FileCorrupt,
           "vertex 0 is malformed");
    refuse("a.ply", header + kThreeVertices + "3 0 1 2\n3 0 1 2.5\n", ErrorKind::FileCorrupt,
           "face 1 is malformed");
    refuse("a.ply", header + kThreeVertices + "3 0 1 2\n-1 0 1 2\n", ErrorKind::FileCorrupt,
           "face 1 is malformed");
    refuse("a.ply", header + kThreeVertices + "3 0 1 2\n3 0 1 -1\n", ErrorKind::FileCorrupt,
           "face 1: vertex -1 does not exist, the file has 3");
    refuse("a.ply", header + kThreeVertices + "3 0 1 2\n3 0 3 1\n", ErrorKind::FileCorrupt,
           "face 1: vertex 3 does not exist");
}

TEST_F(Refusals, CountsWithoutBytesBehindThem)
{
    for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
        refuse("a.ply", plyHeader(format, "4294967295", "4294967295"), ErrorKind::FileTruncated,
               "promises 4294967295 of element vertex, more than the file can hold");
        refuse("a.ply", plyHeader(format, "0", "4294967295") + "abc", ErrorKind::FileTruncated,
               "promises 4294967295 of element face, more than the file can hold");
    }
    // A list of 2^32 - 1 items in a file of a few bytes, and an element of no size at all.
    refuse("a.ply",
           "ply\nformat binary_little_endian 1.0\nelement vertex 0\nproperty float x\nproperty float "
           "y\nproperty float z\n"
           "element face 1\nproperty list uint int vertex_indices\nend_header\n\xff\xff\xff\xff",
           ErrorKind::FileTruncated, "the file ends within face 0");
    refuse("a.ply", "ply\nformat binary_little_endian 1.0\nelement nothing 4294967295\nend_header\n",
           ErrorKind::EmptyMesh, "no faces");
    refuse("a.off", "OFF\n99999999999 1 0\n0 0 0\n", ErrorKind::FileTruncated,
           "the file ends at vertex 1, the header promises 99999999999");
    refuse("a.off", "OFF\n1 1 0\n0 0 0\n4000000000 0 0 0\n", ErrorKind::FileCorrupt, "face 0 is malformed");
    std::string stl(84, '\xff');
    refuse("a.stl", stl, ErrorKind::FileTruncated, "within facet 0, the header promises 4294967295");
}

TEST_F(Refusals, Off)
{
    refuse("a.off", "OFF\n3 2 0\n" + kThreeVertices + "3 0 1 2\n", ErrorKind::FileTruncated,
           "the file ends at face 1, the header promises 2 of them");
    refuse("a.off", "OFF\n4 1 0\n" + kThreeVertices, ErrorKind::FileTruncated,
           "the file ends at vertex 3, the header promises 4");
    refuse("a.off", "OFF\n3 1 0\n" + kThreeVertices + "3 0 1", ErrorKind::FileTruncated,
           "the file ends at face 0");
    refuse("a.off", "OFF\n3 1 0\n0 0\n1 0 0\n0 1 0\n3 0 1 2\n", ErrorKind::FileCorrupt,
           "line 3: vertex 0 is malformed");
    refuse("a.off", "OFF\n3 1 0\n" + kThreeVertices + "3 0 1 3\n", ErrorKind::FileCorrupt,
           "face 0: vertex 3 does not exist, the file has 3");
    refuse("a.off", "OFF\n", ErrorKind::FileTruncated, "within the header");
    refuse("a.off", "OFF\n-3 1 0\n", ErrorKind::FileCorrupt, "line 2: no element counts");
    refuse("a.off", "OFF BINARY\n", ErrorKind::FormatUnknown, "binary OFF is not supported");
    refuse("a.off", "4OFF\n3 1 0\n", ErrorKind::FileCorrupt, "not a text OFF file of points in space");
    refuse("a.off", "<html>\n", ErrorKind::FileCorrupt, "not a text OFF file");
}

TEST_F(Refusals, Stl)
{
    const std::string facet =
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    refuse("a.stl", "solid\n" + facet, ErrorKind::FileTruncated,
           "the file ends at facet 1, before 'endsolid'");
    refuse("a.stl", "solid\n" + facet + "facet normal 0 0 1\nouter loop\nvertex 0 0",
           ErrorKind::FileTruncated, "the file ends at facet 1");
    refuse("a.stl",
           "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\nendsolid\n",
           ErrorKind::FileCorrupt, "facet 0 is malformed");
    refuse("a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 x\nendsolid\n", ErrorKind::FileCorrupt,
           "line 4: facet 0 is malformed");

    const std::string name = path("b.stl");
    ASSERT_TRUE(writeMesh(test::tetrahedron(), name).ok());
    const std::string whole = read(name);
    refuse("c.stl", whole.substr(0, whole.size() - 1), ErrorKind::FileTruncated,
           "the file ends within facet 3, the header promises 4 of them");
    refuse("c.stl", whole.substr(0, 83), ErrorKind::FileTruncated, "within the header of 84 bytes");
}

// Every way to cut a file short is noticed, except within the very last number of a text file.
TEST_F(Refusals, EveryPrefix)
{
    const struct
    {
        const char* name;
        Encoding encoding;
        size_t undetectable; // bytes at the end that may be missing
    } cases[] = {{"a.ply", Encoding::Binary, 0},
                 {"a.ply", Encoding::BinaryBigEndian, 0},
                 {"a.ply", Encoding::Ascii, 1},
                 {"a.off", Encoding::Ascii, 1},
                 {"a.stl", Encoding::Binary, 0},
                 {"a.stl", Encoding::Ascii, 6}}; // "endsolid" counts, its name does not
    for (const auto& c : cases) {
        ASSERT_TRUE(writeMesh(test::tetrahedron(), path(c.name), {}, c.encoding).ok());
        const std::string whole = read(path(c.name));
        ASSERT_TRUE(readMesh(path(c.name)).ok());
        for (size_t size = 0; size < whole.size(); ++size) {
            const Result<MeshFile> cut =
                readMesh(write("cut" + std::string(c.name + 1), whole.substr(0, size)));
            EXPECT_TRUE(!cut.ok() || size + c.undetectable >= whole.size()) << c.name << " cut to " << size;
        }
    }
}

// An OBJ file cut between lines is a valid one; whatever comes out must be sound.
TEST_F(Refusals, DamagedFilesNeverCrash)
{
    const Mesh ball = test::torus(2, 1, 8, 6);
    std::mt19937 random(1);
    for (const char* name : {"a.obj", "a.ply", "a.off", "a.stl"})
        for (Encoding encoding : {Encoding::Binary, Encoding::Ascii}) {
            ASSERT_TRUE(writeMesh(ball, path(name), {}, encoding).ok());
            const std::string whole = read(path(name));
            for (int round = 0; round < 150; ++round) {
                std::string damaged = whole.substr(0, round % 4 ? whole.size() : random() % whole.size());
                for (int k = 0; k < 3 && !damaged.empty(); ++k)
                    damaged[random() % damaged.size()] = static_cast<char>(random());
                const std::string file = write("damaged" + std::string(name + 1), damaged);
                const bool largest = round % 2 == 0;
                const Result<MeshFile> result = readMesh(file, {.largestComponent = largest});
                const Result<Mesh> triangles = readTriangles(file);
                if (!result) continue;
                EXPECT_TRUE(largest || triangles.ok())
                    << name << " round " << round << triangles.error().message;
                const Topology t = topology(result->mesh);
                EXPECT_EQ(t.vertices, result->mesh.vertexCount());
                EXPECT_GE(t.genus, 0);
            }
        }
}

// An independent library reads what gimg writes, and gimg reads what it writes.
#include "gimg/mesh_io.h"
#include "shapes.h"
#include "temporary_files.h"

#include <algorithm>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

using namespace gimg;
using Reference = OpenMesh::TriMesh_ArrayKernelT<>;

namespace {

class OpenMeshAgreement : public test::TemporaryFiles
{
protected:
    static Mesh roundTorus()
    {
        Mesh torus = test::torus(2, 1.0 / 3, 12, 9);
        for (Vec3& p : torus.positions) p = (p * 64).array().round() / 64; // few digits, in decimal too
        return torus;
    }
};

} // namespace

TEST_F(OpenMeshAgreement, ReadsWhatIsWritten)
{
    const Mesh torus = roundTorus();
    for (const char* name : {"a.obj", "a.ply", "a.off", "a.stl"})
        for (Encoding encoding : {Encoding::Binary, Encoding::BinaryBigEndian, Encoding::Ascii}) {
            if (!writeMesh(torus, path(name), vertexNormals(torus), encoding).ok())
                continue; // big-endian STL
            Reference mesh;
            ASSERT_TRUE(OpenMesh::IO::read_mesh(mesh, path(name))) << name;
            ASSERT_EQ(mesh.n_vertices(), 108U) << name;
            ASSERT_EQ(mesh.n_faces(), 216U) << name;
            if (std::string(name) == "a.stl") continue; // in an order of its own
            for (auto v : mesh.vertices())
                for (unsigned k = 0; k < 3; ++k)
                    EXPECT_EQ(double{mesh.point(v)[k]}, torus.positions[v.idx()][k]);
            for (auto f : mesh.faces()) {
                Triangle corners{};
                int k = 0;
                for (auto v : mesh.fv_ccw_range(f)) corners[k++] = v.idx();
                for (k = 0; k < 3 && corners[0] != torus.faces[f.idx()][0]; ++k)
                    std::rotate(corners.begin(), corners.begin() + 1, corners.end());
                EXPECT_EQ(corners, torus.faces[f.idx()]);
            }
        }
}

TEST_F(OpenMeshAgreement, WritesWhatIsRead)
{
    omlog().disable();
    const Mesh torus = roundTorus();
    Reference mesh;
    for (const Vec3& p : torus.positions)
        mesh.add_vertex(Reference::Point(float(p[0]), float(p[1]), float(p[2])));
    for (const Triangle& t : torus.faces)
        mesh.add_face(mesh.vertex_handle(unsigned(t[0])), mesh.vertex_handle(unsigned(t[1])),
                      mesh.vertex_handle(unsigned(t[2])));
    using OpenMesh::IO::Options;
    for (const char* name : {"a.obj", "a.ply", "a.off", "a.stl"})
        for (Options::value_type flags :
             {Options::value_type{Options::Default}, Options::value_type{Options::Binary},
              Options::value_type{Options::Binary | Options::MSB}}) {
            const bool binary = flags & Options::Binary;
            if (binary && (std::string(name) == "a.off" || std::string(name) == "a.obj")) continue;
            if (flags & Options::MSB && std::string(name) == "a.stl") continue;
            ASSERT_TRUE(OpenMesh::IO::write_mesh(mesh, path(name), Options(flags), 9)) << name;
            const Result<MeshFile> file = readMesh(path(name));
            ASSERT_TRUE(file.ok()) << file.error().message;
            EXPECT_EQ(file->mesh.vertexCount(), 108) << name;
            EXPECT_EQ(file->mesh.faceCount(), 216) << name;
            EXPECT_EQ(topology(file->mesh).genus, 1) << name;
            if (std::string(name) != "a.stl") {
                EXPECT_EQ(file->mesh.positions, torus.positions) << name << flags;
            }
        }
}

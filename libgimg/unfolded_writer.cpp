#include "gimg/unfolded_io.h"

#include "gimg/stretch.h"
#include "mesh_output.h"

#include <exception>

namespace gimg {
namespace {

void writeObj(const SquareDisk& square, const Parameterization& map, MeshOutput& out)
{
    for (const Vec3& p : square.surface.positions) out << "v " << p << "\n";
    for (const Vec2& st : map.st) out << "vt " << st[0] << " " << st[1] << "\n";
    for (const Triangle& t : square.disk.mesh.faces) {
        out << "f";
        for (int v : t) out << " " << square.disk.origin[v] + 1 << "/" << v + 1;
        out << "\n";
    }
    for (const CutPath& path : square.cut.paths) {
        out << "l";
        for (int v : path.vertices) out << " " << v + 1;
        out << "\n";
    }
}

void writePly(const SquareDisk& square, const Parameterization& map, MeshOutput& out)
{
    const Mesh& mesh = square.disk.mesh;
    out << "ply\nformat binary_little_endian 1.0\nelement vertex " << mesh.vertexCount() << "\n";
    for (const char* name : {"x", "y", "z", "s", "t"}) out << "property double " << name << "\n";
    out << "element face " << mesh.faceCount()
        << "\nproperty list uchar int vertex_indices\nproperty double quality\nend_header\n";
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
        for (double x : mesh.positions[v]) out.binary(x);
        for (double x : map.st[v]) out.binary(x);
    }
    const std::vector<double> stretch = faceStretch(mesh, map.st);
    for (size_t f = 0; f < mesh.faces.size(); ++f) {
        out.binary(3, 1);
        for (int v : mesh.faces[f]) out.binary(static_cast<uint64_t>(v), 4);
        out.binary(stretch[f]);
    }
}

} // namespace

Status writeUnfolded(const SquareDisk& square, const Parameterization& map, const std::string& path)
try {
    MeshOutput out;
    if (path.ends_with(".obj"))
        writeObj(square, map, out);
    else if (path.ends_with(".ply"))
        writePly(square, map, out);
    else
        return Error{ErrorKind::FormatUnknown, path + ": a map is written to .obj or .ply"};
    return out.save(path);
} catch (const std::exception& failure) {
    return Error{ErrorKind::FileNotWritable, path + ": " + failure.what()};
}

} // namespace gimg

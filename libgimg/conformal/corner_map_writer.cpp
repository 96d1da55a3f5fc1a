#include "gimg/corner_map.h"
#include "mesh_output.h"

#include <exception>

namespace gimg {
namespace {

void writeObj(const Mesh& mesh, const CornerMap& map, MeshOutput& out)
{
    for (const Vec3& p : mesh.positions) out << "v " << p << "\n";
    for (const Vec2& uv : map.uv) out << "vt " << uv[0] << " " << uv[1] << "\n";
    for (size_t f = 0; f < mesh.faces.size(); ++f) {
        out << "f";
        for (int k = 0; k < 3; ++k) out << " " << mesh.faces[f][k] + 1 << "/" << map.corners[f][k] + 1;
        out << "\n";
    }
}

void writePly(const Mesh& mesh, const CornerMap& map, std::span<const double> quality, MeshOutput& out)
{
    out << "ply\nformat binary_little_endian 1.0\nelement vertex " << mesh.vertexCount() << "\n";
    for (const char* name : {"x", "y", "z"}) out << "property double " << name << "\n";
    out << "element face " << mesh.faceCount() << "\nproperty list uchar int vertex_indices\n"
        << "property list uchar float texcoord\n";
    if (!quality.empty()) out << "property double quality\n";
    out << "end_header\n";
    for (const Vec3& p : mesh.positions)
        for (double x : p) out.binary(x);
    for (size_t f = 0; f < mesh.faces.size(); ++f) {
        out.binary(3, 1);
        for (int v : mesh.faces[f]) out.binary(static_cast<uint64_t>(v), 4);
        out.binary(6, 1);
        for (int c : map.corners[f])
            for (double x : map.uv[c]) out.binary(static_cast<float>(x));
        if (!quality.empty()) out.binary(quality[f]);
    }
}

Status checked(const Mesh& mesh, const CornerMap& map, std::span<const double> quality)
{
    if (map.corners.size() != mesh.faces.size())
        return Error{ErrorKind::BadArgument, "corners of " + std::to_string(map.corners.size()) +
                                                 " faces for a mesh of " + std::to_string(mesh.faceCount())};
    if (!quality.empty() && quality.size() != mesh.faces.size())
        return Error{ErrorKind::BadArgument, std::to_string(quality.size()) + " qualities for " +
                                                 std::to_string(mesh.faceCount()) + " faces"};
    for (size_t f = 0; f < map.corners.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            if (mesh.faces[f][k] < 0 || mesh.faces[f][k] >= mesh.vertexCount())
                return Error{ErrorKind::BadArgument, "face " + std::to_string(f) + " names no vertex"};
            if (map.corners[f][k] < 0 || map.corners[f][k] >= static_cast<int>(map.uv.size()))
                return Error{ErrorKind::BadArgument, "face " + std::to_string(f) + " names no point"};
        }
    return Done{};
}

} // namespace

Status writeCornerMap(const Mesh& mesh, const CornerMap& map, const std::string& path,
                      std::span<const double> quality)
try {
    if (const Status status = checked(mesh, map, quality); !status)
        return Error{status.error().kind, path + ": " + status.error().message};
    MeshOutput out;
    if (path.ends_with(".obj"))
        writeObj(mesh, map, out);
    else if (path.ends_with(".ply"))
        writePly(mesh, map, quality, out);
    else
        return Error{ErrorKind::FormatUnknown, path + ": a map is written to .obj or .ply"};
    return out.save(path);
} catch (const std::exception& failure) {
    return Error{ErrorKind::FileNotWritable, path + ": " + failure.what()};
}

} // namespace gimg

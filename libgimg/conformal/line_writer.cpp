#include "gimg/corner_map.h"
#include "mesh_output.h"

#include <exception>

namespace gimg {
namespace {

// Vertices that lines pass, numbered as they come.
struct LineVertices
{
    std::vector<int> numberOf; // per mesh vertex, -1 if no line passes
    std::vector<int> vertices;
};

LineVertices verticesOf(int vertexCount, std::span<const std::vector<int>> lines)
{
    LineVertices used{std::vector<int>(static_cast<size_t>(vertexCount), -1), {}};
    for (const std::vector<int>& line : lines)
        for (int v : line) {
            if (used.numberOf[v] >= 0) continue;
            used.numberOf[v] = static_cast<int>(used.vertices.size());
            used.vertices.push_back(v);
        }
    return used;
}

void writeObj(const Mesh& mesh, std::span<const std::vector<int>> lines, const LineVertices& used,
              MeshOutput& out)
{
    for (int v : used.vertices) out << "v " << mesh.positions[v] << "\n";
    for (const std::vector<int>& line : lines) {
        out << "l";
        for (int v : line) out << " " << used.numberOf[v] + 1;
        out << "\n";
    }
}

void writePly(const Mesh& mesh, std::span<const std::vector<int>> lines, const LineVertices& used,
              MeshOutput& out)
{
    size_t edges = 0;
    for (const std::vector<int>& line : lines) edges += line.empty() ? 0 : line.size() - 1;
    out << "ply\nformat ascii 1.0\nelement vertex " << used.vertices.size() << "\n";
    for (const char* name : {"x", "y", "z"}) out << "property double " << name << "\n";
    out << "element edge " << edges
        << "\nproperty int vertex1\nproperty int vertex2\nproperty int line\nend_header\n";
    for (int v : used.vertices) out << mesh.positions[v] << "\n";
    for (size_t i = 0; i < lines.size(); ++i)
        for (size_t k = 1; k < lines[i].size(); ++k)
            out << used.numberOf[lines[i][k - 1]] << " " << used.numberOf[lines[i][k]] << " " << i << "\n";
}

} // namespace

Status writeLines(const Mesh& mesh, std::span<const std::vector<int>> lines, const std::string& path)
try {
    for (const std::vector<int>& line : lines)
        for (int v : line)
            if (v < 0 || v >= mesh.vertexCount())
                return Error{ErrorKind::BadArgument, path + ": a line names vertex " + std::to_string(v) +
                                                         " of " + std::to_string(mesh.vertexCount())};
    const LineVertices used = verticesOf(mesh.vertexCount(), lines);
    MeshOutput out;
    if (path.ends_with(".obj"))
        writeObj(mesh, lines, used, out);
    else if (path.ends_with(".ply"))
        writePly(mesh, lines, used, out);
    else
        return Error{ErrorKind::FormatUnknown, path + ": lines are written to .obj or .ply"};
    return out.save(path);
} catch (const std::exception& failure) {
    return Error{ErrorKind::FileNotWritable, path + ": " + failure.what()};
}

} // namespace gimg

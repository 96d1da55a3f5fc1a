#include "gimg/mesh_io.h"

#include "mesh_repair.h"

#include <exception>

namespace gimg {

std::vector<std::string> warnings(const RepairReport& report)
{
    std::vector<std::string> lines;
    const auto say = [&lines](int64_t count, const char* one, const char* many, const std::string& what) {
        if (count <= 0) return;
        std::string& line = lines.emplace_back();
        line += std::to_string(count);
        line.append(" ").append(count == 1 ? one : many).append(" ").append(what);
    };
    if (report.lastLineOpen) lines.emplace_back("the last line has no end: the file may have been cut short");
    say(report.trailingBytes, "byte", "bytes", "after the end of the data ignored");
    say(report.polygonsSplit, "polygon", "polygons", "split into triangles");
    say(report.weldedVertices, "vertex", "vertices", "welded to an earlier one at the same position");
    if (!report.weldRefusal.empty())
        say(report.repeatedPositions, "vertex", "vertices",
            "at the position of an earlier one left apart: welding would make " + report.weldRefusal);
    say(report.repeatedVertexFaces, "face", "faces", "with a repeated vertex removed");
    say(report.duplicateFaces, "duplicate face", "duplicate faces", "removed");
    say(report.zeroAreaFaces, "face", "faces", "of zero area kept");
    say(report.unreferencedVertices, "vertex", "vertices", "in no face dropped");
    say(report.flippedFaces, "face", "faces", "flipped for a consistent orientation");
    if (report.components > 1)
        lines.push_back("the largest of " + std::to_string(report.components) + " components taken, " +
                        std::to_string(report.droppedFaces) +
                        (report.droppedFaces == 1 ? " triangle of the others dropped"
                                                  : " triangles of the others dropped"));
    return lines;
}

Result<MeshFile> readMesh(const std::string& path, const ReadOptions& options)
try {
    const Result<PolygonSoup> soup = readPolygonSoup(path);
    if (!soup) return soup.error();
    Result<MeshFile> file = repaired(*soup, options);
    if (!file) return Error{file.error().kind, path + ": " + file.error().message};
    return file;
} catch (const std::exception& failure) {
    return Error{ErrorKind::FileNotReadable, path + ": " + failure.what()};
}

Result<Mesh> readTriangles(const std::string& path)
try {
    Result<PolygonSoup> soup = readPolygonSoup(path);
    if (!soup) return soup.error();
    Mesh mesh;
    mesh.faces = triangulate(*soup);
    mesh.positions = std::move(soup->positions);
    for (const Triangle& t : mesh.faces)
        for (int v : t)
            if (!mesh.positions[v].allFinite())
                return Error{ErrorKind::NotFinite,
                             path + ": vertex " + std::to_string(v + soup->firstNumber) + " is not finite"};
    if (mesh.faces.empty()) return Error{ErrorKind::EmptyMesh, path + ": no triangles"};
    return mesh;
} catch (const std::exception& failure) {
    return Error{ErrorKind::FileNotReadable, path + ": " + failure.what()};
}

} // namespace gimg

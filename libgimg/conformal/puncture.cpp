#include "gimg/double_cover.h"

#include <string>

namespace gimg {

Result<PuncturedSurface> puncture(const Mesh& mesh, std::span<const int> vertices)
{
    const Halfedges he(mesh.faces, mesh.vertexCount());
    std::vector<int> holeOf(mesh.positions.size(), -1); // the puncture whose rim or middle a vertex is
    for (int h = 0; h < he.count(); ++h)
        if (he.onBoundary(h)) holeOf[he.tail(h)] = holeOf[he.head(h)] = -2;
    std::vector<bool> gone(mesh.faces.size(), false);
    for (size_t i = 0; i < vertices.size(); ++i) {
        const int v = vertices[i];
        const std::string name = "vertex " + std::to_string(v);
        if (v < 0 || v >= mesh.vertexCount() || he.outgoing(v) < 0)
            return Error{ErrorKind::BadArgument, name + " is not of the surface"};
        const auto claim = [&](int w) {
            const bool isFree = holeOf[w] == -1;
            holeOf[w] = static_cast<int>(i);
            return isFree;
        };
        bool isFree = claim(v);
        for (int h = he.outgoing(v); isFree && !gone[h / 3]; h = he.rotateCcw(h)) {
            gone[h / 3] = true;
            isFree = claim(he.head(h));
        }
        if (!isFree)
            return Error{ErrorKind::BadArgument, name + " is too near the boundary or another puncture"};
    }

    PuncturedSurface punctured;
    std::vector<int> numberOf(mesh.positions.size(), -1);
    for (int f = 0; f < mesh.faceCount(); ++f) {
        if (gone[f]) continue;
        punctured.faceOf.push_back(f);
        for (int v : mesh.faces[f]) numberOf[v] = 0;
    }
    if (punctured.faceOf.empty()) return Error{ErrorKind::EmptyMesh, "no face is left beside the punctures"};
    for (int v = 0; v < mesh.vertexCount(); ++v) {
        if (numberOf[v] < 0) continue;
        numberOf[v] = static_cast<int>(punctured.vertexOf.size());
        punctured.vertexOf.push_back(v);
        punctured.mesh.positions.push_back(mesh.positions[v]);
    }
    for (int f : punctured.faceOf) {
        const Triangle& t = mesh.faces[f];
        punctured.mesh.faces.push_back({numberOf[t[0]], numberOf[t[1]], numberOf[t[2]]});
    }
    return punctured;
}

} // namespace gimg

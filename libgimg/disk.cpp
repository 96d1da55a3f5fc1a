#include "gimg/disk.h"

#include <unordered_map>

namespace gimg {
namespace {

uint64_t directedEdge(int v, int w) { return static_cast<uint64_t>(v) << 32 | static_cast<uint32_t>(w); }

struct PathEdge
{
    int path;
    int index; // between path.vertices[index] and [index + 1]
    bool reversed;
};

} // namespace

int DiskMesh::borderLength() const
{
    size_t length = 0;
    for (const DiskSide& side : sides) length += side.vertices.size() - 1;
    return static_cast<int>(length);
}

Result<DiskMesh> openAlong(const Mesh& mesh, const CutGraph& cut)
{
    const Halfedges he(mesh.faces, mesh.vertexCount());
    std::unordered_map<uint64_t, PathEdge> pathEdges;
    for (size_t p = 0; p < cut.paths.size(); ++p) {
        const std::vector<int>& v = cut.paths[p].vertices;
        for (size_t i = 0; i + 1 < v.size(); ++i) {
            pathEdges[directedEdge(v[i], v[i + 1])] = {static_cast<int>(p), static_cast<int>(i), false};
            pathEdges[directedEdge(v[i + 1], v[i])] = {static_cast<int>(p), static_cast<int>(i), true};
        }
    }
    std::vector<int> cutEdge(he.count(), 0); // per halfedge: is its edge in the cut
    int borderEdges = 0;
    for (int h = 0; h < he.count(); ++h) {
        cutEdge[h] = pathEdges.count(directedEdge(he.tail(h), he.head(h))) > 0;
        borderEdges += cutEdge[h];
        if (he.onBoundary(h) && !cutEdge[h])
            return Error{ErrorKind::NotADisk, "the cut misses a boundary edge"};
    }
    if (borderEdges == 0) return Error{ErrorKind::NotADisk, "the cut is empty"};

    // Corner h of a face belongs to vertex tail(h). Corners that no cut edge parts share a disk vertex.
    DiskMesh disk;
    disk.mesh.faces.resize(mesh.faces.size());
    std::vector<int> diskVertex(he.count(), -1);
    for (int corner = 0; corner < he.count(); ++corner) {
        if (diskVertex[corner] >= 0) continue;
        int first = corner;
        while (!cutEdge[first]) {
            first = he.rotateCw(first);
            if (first == corner) break;
        }
        const int id = static_cast<int>(disk.origin.size());
        disk.origin.push_back(he.tail(corner));
        disk.mesh.positions.push_back(mesh.positions[he.tail(corner)]);
        for (int h = first;;) {
            diskVertex[h] = id;
            if (cutEdge[Halfedges::prev(h)]) break;
            h = he.rotateCcw(h);
            if (h == first) break;
        }
    }
    for (int h = 0; h < he.count(); ++h) disk.mesh.faces[h / 3][h % 3] = diskVertex[h];

    // Walk the border from the beginning of a side.
    const auto edgeOf = [&](int h) { return pathEdges.at(directedEdge(he.tail(h), he.head(h))); };
    const auto beginsSide = [&](const PathEdge& e) {
        return e.reversed ? e.index + 2 == static_cast<int>(cut.paths[e.path].vertices.size()) : e.index == 0;
    };
    int start = 0;
    while (!(cutEdge[start] && beginsSide(edgeOf(start)))) ++start;
    int walked = 0;
    for (int h = start;;) {
        const PathEdge edge = edgeOf(h);
        if (beginsSide(edge)) disk.sides.push_back({edge.path, edge.reversed, {diskVertex[h]}});
        disk.sides.back().vertices.push_back(diskVertex[Halfedges::next(h)]);
        ++walked;
        h = Halfedges::next(h);
        while (!cutEdge[h]) h = Halfedges::next(he.twin(h));
        if (h == start) break;
    }
    const int euler =
        static_cast<int>(disk.origin.size()) - (he.count() + borderEdges) / 2 + mesh.faceCount();
    if (walked != borderEdges || euler != 1)
        return Error{ErrorKind::NotADisk, "the cut leaves Euler characteristic " + std::to_string(euler) +
                                              " and more than " + std::to_string(walked) + " border edges"};
    return disk;
}

} // namespace gimg

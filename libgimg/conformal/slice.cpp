#include "gimg/slice.h"

#include <algorithm>
#include <string>

namespace gimg {
namespace {

// Numbers the wedges of one vertex: walks around it from corner to corner and begins a new one behind each
// slit edge. (Corner k of face f is that of halfedge 3 f + k.)
void openVertex(const Halfedges& he, const std::vector<bool>& slit, int v, std::vector<int>& wedge,
                int& count)
{
    int first = he.outgoing(v);
    if (!he.onBoundary(first)) {
        // From a slit edge on, so that no wedge is begun in its middle.
        int h = first;
        do h = he.rotateCcw(h);
        while (h != first && !slit[h]);
        first = h;
    }
    for (int h = first; h >= 0;) {
        if (h == first || slit[h]) ++count;
        wedge[h] = count - 1;
        h = he.rotateCcw(h);
        if (h == first) break;
    }
}

} // namespace

Result<SlicedMesh> sliceAlong(const Mesh& mesh, std::span<const Loop> loops)
{
    const Halfedges he(mesh.faces, mesh.vertexCount());
    std::vector<bool> slit(static_cast<size_t>(he.count()), false);
    for (const Loop& loop : loops)
        for (int h : loop.halfedges) {
            if (h < 0 || h >= he.count())
                return Error{ErrorKind::BadArgument, "the mesh has no halfedge " + std::to_string(h)};
            slit[h] = true;
            if (!he.onBoundary(h)) slit[he.twin(h)] = true;
        }
    SlicedMesh sliced;
    std::vector<int> wedge(slit.size(), -1);
    int count = 0;
    for (int v = 0; v < mesh.vertexCount(); ++v) {
        if (he.outgoing(v) < 0) continue;
        openVertex(he, slit, v, wedge, count);
        sliced.origin.resize(static_cast<size_t>(count), v);
    }
    for (int v : sliced.origin) sliced.mesh.positions.push_back(mesh.positions[v]);
    for (int f = 0; f < mesh.faceCount(); ++f)
        sliced.mesh.faces.push_back({wedge[3 * f], wedge[3 * f + 1], wedge[3 * f + 2]});
    return sliced;
}

} // namespace gimg

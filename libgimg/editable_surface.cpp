#include "editable_surface.h"

namespace gimg {

EditableSurface::EditableSurface(const Mesh& mesh) : positions_(mesh.positions)
{
    const Halfedges he(mesh.faces, mesh.vertexCount());
    tail_.resize(static_cast<size_t>(he.count()));
    twin_.resize(tail_.size());
    for (int h = 0; h < he.count(); ++h) {
        tail_[h] = he.tail(h);
        twin_[h] = he.twin(h);
    }
    outgoing_.resize(positions_.size());
    for (int v = 0; v < vertexCount(); ++v) outgoing_[v] = he.outgoing(v);
}

bool EditableSurface::areAdjacent(int v, int w) const
{
    bool found = false;
    forEachEdgeAt(v, [&](int, int other) { found = found || other == w; });
    return found;
}

int EditableSurface::halfedgeBetween(int v, int w) const
{
    int found = -1;
    forEachEdgeAt(v, [&](int h, int other) {
        if (other == w) found = tail(h) == v ? h : twin(h);
    });
    return found;
}

int EditableSurface::addVertex(const Vec3& position)
{
    positions_.push_back(position);
    outgoing_.push_back(-1);
    return vertexCount() - 1;
}

int EditableSurface::addFace(const Triangle& corners)
{
    const int first = halfedgeCount();
    for (int k = 0; k < 3; ++k) {
        tail_.push_back(corners[k]);
        twin_.push_back(-1);
        if (outgoing_[corners[k]] < 0) outgoing_[corners[k]] = first + k;
    }
    return first;
}

void EditableSurface::glue(int h, int g)
{
    if (h >= 0) twin_[h] = g;
    if (g >= 0) twin_[g] = h;
}

void EditableSurface::merge(int from, int to)
{
    std::vector<int> corners;
    forEachEdgeAt(from, [&](int h, int) { corners.push_back(tail(h) == from ? h : next(h)); });
    for (int corner : corners)
        if (tail(corner) == from) tail_[corner] = to;
    outgoing_[from] = -1;
}

EditableSurface::Cut EditableSurface::cutAlong(const std::vector<int>& loop)
{
    const size_t n = loop.size();
    Cut cut;
    cut.left.vertices = loop;
    for (size_t i = 0; i < n; ++i) {
        const int v = loop[i], w = loop[(i + 1) % n];
        cut.left.sides.push_back(halfedgeBetween(v, w));
        cut.right.sides.push_back(halfedgeBetween(w, v));
    }
    for (size_t i = 0; i < n; ++i) {
        const int v = loop[i];
        const int leaving = cut.right.sides[i], arriving = cut.right.sides[(i + n - 1) % n];
        const int copy = addVertex(position(v));
        cut.right.vertices.push_back(copy);
        // The corners on the right, clockwise from the leaving edge; beyond a gap in the surface, counter-
        // clockwise from the arriving one.
        int corner = leaving < 0 ? -1 : next(leaving);
        while (corner >= 0) {
            relabel(corner, copy);
            if (corner == arriving) break;
            corner = twin(corner) < 0 ? -1 : next(twin(corner));
        }
        if (corner != arriving)
            for (corner = arriving; corner >= 0; corner = twin(prev(corner))) relabel(corner, copy);
        outgoing_[v] = cut.left.sides[i];
        if (outgoing_[v] < 0) {
            const int before = cut.left.sides[(i + n - 1) % n];
            if (before >= 0) outgoing_[v] = next(before);
        }
    }
    for (size_t i = 0; i < n; ++i) {
        if (cut.left.sides[i] >= 0) twin_[cut.left.sides[i]] = -1;
        if (cut.right.sides[i] >= 0) twin_[cut.right.sides[i]] = -1;
    }
    return cut;
}

Mesh EditableSurface::mesh() const
{
    std::vector<int> label(positions_.size(), -1);
    for (int v : tail_) label[v] = 0;
    Mesh mesh;
    for (int v = 0; v < vertexCount(); ++v) {
        if (label[v] < 0) continue;
        label[v] = mesh.vertexCount();
        mesh.positions.push_back(positions_[v]);
    }
    for (size_t h = 0; h < tail_.size(); h += 3)
        mesh.faces.push_back({label[tail_[h]], label[tail_[h + 1]], label[tail_[h + 2]]});
    return mesh;
}

} // namespace gimg

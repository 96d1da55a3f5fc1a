#pragma once

#include "gimg/mesh.h"

#include <vector>

namespace gimg {

/// An oriented manifold surface whose connectivity can be changed in place. Halfedges are numbered as in
/// Halfedges: 3 f + k from corner k of face f to the next one. Faces are only ever added.
class EditableSurface
{
public:
    /// @param mesh  manifold and oriented
    explicit EditableSurface(const Mesh& mesh);

    int vertexCount() const { return static_cast<int>(positions_.size()); }
    int halfedgeCount() const { return static_cast<int>(tail_.size()); }
    const Vec3& position(int v) const { return positions_[v]; }

    static int next(int h) { return Halfedges::next(h); }
    static int prev(int h) { return Halfedges::prev(h); }
    int tail(int h) const { return tail_[h]; }
    int head(int h) const { return tail_[next(h)]; }
    int twin(int h) const { return twin_[h]; } ///< -1 on the boundary
    double length(int h) const { return (positions_[head(h)] - positions_[tail(h)]).norm(); }

    /// Calls visit(h, w) for every edge at v: h one of its halfedges, w the other end.
    template <class Visit> void forEachEdgeAt(int v, Visit visit) const
    {
        const int first = outgoing_[v];
        if (first < 0) return;
        for (int h = first;;) {
            visit(h, head(h));
            const int incoming = prev(h);
            h = twin_[incoming];
            if (h == first) return;
            if (h >= 0) continue;
            visit(incoming, tail(incoming));
            break;
        }
        // The ring has a gap: what lies clockwise of the first edge.
        for (int h = first; twin_[h] >= 0;) {
            h = next(twin_[h]);
            visit(h, head(h));
        }
    }

    bool areAdjacent(int v, int w) const;
    int halfedgeBetween(int v, int w) const; ///< from v to w; -1 if there is none

    int addVertex(const Vec3& position);
    /// Returns the first halfedge. All three are boundary until they are glued.
    int addFace(const Triangle& corners);
    /// Makes two halfedges twins; either may be -1, which leaves the other one on the boundary.
    void glue(int h, int g);
    /// Gives all corners of vertex `from` to vertex `to`; `from` is in no face then.
    void merge(int from, int to);

    /// Two sides of a cut.
    struct Loop
    {
        std::vector<int> vertices;
        std::vector<int> sides; ///< halfedges from each vertex to the next (or back); -1 on the boundary
    };
    struct Cut
    {
        Loop left, right; ///< left has the old vertices; halfedges of right run against the loop
    };
    /// Cuts along a closed chain of edges that visits no vertex twice. Vertices on its right become new ones.
    Cut cutAlong(const std::vector<int>& loop);

    /// Without vertices that are in no face; the others keep their order, faces all.
    Mesh mesh() const;

private:
    void relabel(int corner, int v) { tail_[corner] = v, outgoing_[v] = corner; }

    std::vector<Vec3> positions_;
    std::vector<int> tail_;
    std::vector<int> twin_;
    std::vector<int> outgoing_; // any halfedge that leaves the vertex; -1 if it is in no face
};

} // namespace gimg

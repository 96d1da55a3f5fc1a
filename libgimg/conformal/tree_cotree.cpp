#include "conformal/tree_cotree.h"

#include <algorithm>
#include <numeric>

namespace gimg {
namespace {

struct DualEdge
{
    double length; ///< of the loop
    int halfedge;
};

// Edges outside the tree of paths, those with the longest loops first.
std::vector<DualEdge> dualEdges(const ClosedSurface& surface, const ShortestPaths& paths)
{
    const Halfedges& he = surface.halfedges;
    std::vector<DualEdge> edges;
    for (int h = 0; h < he.count(); ++h) {
        if (h > he.twin(h)) continue;
        const int u = he.tail(h), v = he.head(h);
        if (paths.entry(v) == h || paths.entry(u) == he.twin(h)) continue;
        edges.push_back({paths.distance(u) + surface.length(h) + paths.distance(v), h});
    }
    std::sort(edges.begin(), edges.end(), [](const DualEdge& a, const DualEdge& b) {
        return a.length > b.length || (a.length == b.length && a.halfedge < b.halfedge);
    });
    return edges;
}

int rootOf(std::vector<int>& parent, int f)
{
    while (parent[f] != f) f = parent[f] = parent[parent[f]];
    return f;
}

} // namespace

TreeCotree treeCotree(const ClosedSurface& surface, const ShortestPaths& paths)
{
    const Halfedges& he = surface.halfedges;
    const size_t faces = surface.surface.faces.size();
    std::vector<int> parent(faces);
    std::iota(parent.begin(), parent.end(), 0);
    std::vector<bool> inTree(static_cast<size_t>(he.count()), false);
    TreeCotree result;
    for (const DualEdge& edge : dualEdges(surface, paths)) {
        const int twin = he.twin(edge.halfedge);
        const int f = rootOf(parent, Halfedges::face(edge.halfedge)),
                  g = rootOf(parent, Halfedges::face(twin));
        if (f == g) {
            result.loopEdges.push_back(edge.halfedge);
        } else {
            parent[f] = g;
            inTree[edge.halfedge] = inTree[twin] = true;
        }
    }
    std::reverse(result.loopEdges.begin(), result.loopEdges.end());

    result.hangsBy.assign(faces, -1);
    result.faceOrder = {0};
    result.faceOrder.reserve(faces);
    for (size_t i = 0; i < result.faceOrder.size(); ++i) {
        const int f = result.faceOrder[i];
        for (int h = 3 * f; h < 3 * f + 3; ++h) {
            if (!inTree[h] || h == result.hangsBy[f]) continue;
            result.hangsBy[Halfedges::face(he.twin(h))] = he.twin(h);
            result.faceOrder.push_back(Halfedges::face(he.twin(h)));
        }
    }
    return result;
}

std::vector<int> closedLoop(const ClosedSurface& surface, const ShortestPaths& paths, int halfedge)
{
    const Halfedges& he = surface.halfedges;
    const std::vector<int> out = paths.pathTo(he.tail(halfedge)), back = paths.pathTo(he.head(halfedge));
    size_t common = 0;
    while (common < out.size() && common < back.size() && out[common] == back[common]) ++common;
    std::vector<int> loop(out.begin() + static_cast<long>(common), out.end());
    loop.push_back(halfedge);
    for (size_t i = back.size(); i > common; --i) loop.push_back(he.twin(back[i - 1]));
    return loop;
}

} // namespace gimg

#include "gimg/homology.h"

#include <unordered_map>

namespace gimg {
namespace {

/// One visit of a walk at a vertex, both edges as halfedges that leave the vertex.
struct Passing
{
    int in, out;
    bool turnsBack() const { return in == out; }
};

template <class Visit> void forEachPassing(const Halfedges& he, const Loop& loop, Visit visit)
{
    for (size_t i = 0; i < loop.halfedges.size(); ++i) {
        const int before = i == 0 ? loop.halfedges.back() : loop.halfedges[i - 1];
        const int out = loop.halfedges[i];
        visit(he.tail(out), Passing{he.twin(before), out});
    }
}

enum Side
{
    Right = -1,
    Along = 0,
    Left = 1
};

// Where a walk that comes or goes by the edge of h is, seen from the passing. Where that turns back on its
// edge it has no sides: its shift to the left wraps the vertex one way and that to the right the other way,
// and their mean is what counts.
Side sideOf(const Halfedges& he, int h, const Passing& passing)
{
    if (h == passing.in || h == passing.out || passing.turnsBack()) return Along;
    for (int k = he.rotateCcw(passing.out); k != passing.in; k = he.rotateCcw(k))
        if (k == h) return Left;
    return Right;
}

using Passings = std::unordered_map<int, std::vector<Passing>>;

Passings passingsOf(const Halfedges& he, const Loop& loop)
{
    Passings passings;
    forEachPassing(he, loop, [&](int v, const Passing& passing) { passings[v].push_back(passing); });
    return passings;
}

// The index of Fig. 21, summed over all pairs of visits at common vertices: 2 for a crossing from left to
// right, 1 for coming from the left or leaving to the right where the walks run together on the other side.
int intersections(const Halfedges& he, const Loop& a, const Passings& b)
{
    int indices = 0;
    forEachPassing(he, a, [&](int v, const Passing& passing) {
        const auto others = b.find(v);
        if (others == b.end()) return;
        for (const Passing& other : others->second)
            indices += sideOf(he, passing.in, other) - sideOf(he, passing.out, other);
    });
    return indices / 2;
}

} // namespace

int intersectionNumber(const Halfedges& halfedges, const Loop& a, const Loop& b)
{
    return intersections(halfedges, a, passingsOf(halfedges, b));
}

Eigen::MatrixXi intersectionMatrix(const Halfedges& halfedges, std::span<const Loop> loops)
{
    const Eigen::Index n = static_cast<Eigen::Index>(loops.size());
    Eigen::MatrixXi q = Eigen::MatrixXi::Zero(n, n);
    for (Eigen::Index j = 0; j < n; ++j) {
        const Passings passings = passingsOf(halfedges, loops[j]);
        for (Eigen::Index i = 0; i < j; ++i) {
            q(i, j) = intersections(halfedges, loops[i], passings);
            q(j, i) = -q(i, j);
        }
    }
    return q;
}

// A walk shifted to its left crosses what leaves its vertices on that side, each edge once.
OneForm poincareDual(const Halfedges& halfedges, const Loop& loop)
{
    OneForm form = OneForm::Zero(halfedges.count());
    forEachPassing(halfedges, loop, [&](int, const Passing& passing) {
        for (int h = halfedges.rotateCcw(passing.out); h != passing.in; h = halfedges.rotateCcw(h)) {
            form[h] += 1;
            form[halfedges.twin(h)] -= 1;
        }
    });
    return form;
}

} // namespace gimg

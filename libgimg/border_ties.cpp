#include "border_ties.h"

#include <algorithm>
#include <cmath>

namespace gimg {
namespace {

Vec2 sideCorner(int edge) { return Vec2(edge == 1 || edge == 2 ? 1 : 0, edge >= 2 ? 1 : 0); }

// Where a disk side lies on the square's border: position of its begin, in lowest-grid units.
struct Placed
{
    const DiskSide* side = nullptr;
    int begin = 0;
};

// The square's side at border position x, and the point of its line that would be position `at`.
int squareSideAt(double x, int side) { return static_cast<int>(std::floor(x / side)) & 3; }
Vec2 onLineOf(int edge, double at, int side) { return sideCorner(edge) + sideDirection(edge) * (at / side); }

// From the side that runs along the path to its mate, near path parameter u.
GridMotion towardsMate(const Placed& forward, const Placed& backward, int length, double u, int side)
{
    const double from = forward.begin + u, to = backward.begin + length - u;
    const int edge = squareSideAt(from, side), mateEdge = squareSideAt(to, side);
    // Both lines at parameter 0, an exact multiple of the step.
    const double wrapFrom = side * std::floor(from / side), wrapTo = side * std::floor(to / side);
    const Vec2 p = onLineOf(edge, forward.begin - wrapFrom, side);
    const Vec2 q = onLineOf(mateEdge, backward.begin + length - wrapTo, side);
    GridMotion motion{(mateEdge + 6 - edge) & 3, Vec2::Zero()};
    motion.shift = q - motion.turned(p);
    return motion;
}

struct Tie
{
    int to;
    GridMotion motion; // position of `to` from that of the vertex
    int path, edge;    // the path that ties them; the square's side that `to` is on there
};

} // namespace

Vec2 sideDirection(int edge)
{
    constexpr int kX[4] = {1, 0, -1, 0}, kY[4] = {0, 1, 0, -1};
    return Vec2(kX[edge], kY[edge]);
}

Vec2 GridMotion::turned(const Vec2& p) const
{
    switch (turns) {
    case 0:
        return p;
    case 1:
        return {-p.y(), p.x()};
    case 2:
        return -p;
    default:
        return {p.y(), -p.x()};
    }
}

GridMotion GridMotion::operator*(const GridMotion& first) const
{
    return {(turns + first.turns) & 3, turned(first.shift) + shift};
}

GridMotion GridMotion::inverse() const
{
    GridMotion back{(4 - turns) & 3, Vec2::Zero()};
    back.shift = -back.turned(shift);
    return back;
}

BorderTies borderTies(const SquareDisk& square)
{
    const Mesh& disk = square.disk.mesh;
    const Halfedges he(disk.faces, disk.vertexCount());
    const int side = square.lowest - 1, vertices = disk.vertexCount();
    BorderTies ties;
    ties.leader.resize(vertices);
    for (int v = 0; v < vertices; ++v) ties.leader[v] = v;
    ties.motion.resize(vertices);
    ties.free.assign(vertices, {true, true});
    ties.across.resize(he.count());

    std::vector<std::vector<Tie>> tied(vertices);
    std::vector<bool> onBoundary(vertices, false), isNode(vertices, false);
    std::vector<Placed> forward(square.cut.paths.size()), backward(square.cut.paths.size());
    int begin = square.start;
    for (const DiskSide& s : square.disk.sides) {
        (s.reversed ? backward : forward)[s.path] = {&s, begin};
        begin += square.pathLength[s.path];
        isNode[s.vertices.front()] = isNode[s.vertices.back()] = true;
        if (square.cut.paths[s.path].boundary)
            for (int v : s.vertices) onBoundary[v] = true;
    }
    for (size_t p = 0; p < square.cut.paths.size(); ++p) {
        if (square.cut.paths[p].boundary) continue;
        const std::vector<double>& u = square.pathParameter[p];
        const std::vector<int>& a = forward[p].side->vertices;
        const std::vector<int>& b = backward[p].side->vertices;
        const size_t last = a.size() - 1;
        for (size_t i = 0; i < last; ++i) {
            const double middle = 0.5 * (u[i] + u[i + 1]);
            const GridMotion there = towardsMate(forward[p], backward[p], square.pathLength[p], middle, side);
            const int edge = squareSideAt(forward[p].begin + middle, side);
            const int mateEdge = squareSideAt(backward[p].begin + square.pathLength[p] - middle, side);
            ties.across[he.outgoing(a[i])] = there.inverse();
            ties.across[he.outgoing(b[last - i - 1])] = there;
            for (size_t k : {i, i + 1}) {
                tied[a[k]].push_back({b[last - k], there, static_cast<int>(p), mateEdge});
                tied[b[last - k]].push_back({a[k], there.inverse(), static_cast<int>(p), edge});
            }
        }
    }

    std::vector<bool> seen(vertices, false);
    int leaderOfFirstNode = -1;
    bool anyFixed = false;
    for (int v = 0; v < vertices; ++v) {
        if (square.squareSides[v] == 0 || seen[v]) continue;
        seen[v] = true;
        std::vector<int> copies = {v};
        ties.copies.push_back({v, -1, -1, -1});
        int quarters = 0;
        bool boundary = false, node = false;
        for (size_t i = 0; i < copies.size(); ++i) {
            const int w = copies[i];
            quarters += (square.squareSides[w] & (square.squareSides[w] - 1)) != 0 ? 1 : 2;
            boundary = boundary || onBoundary[w];
            node = node || isNode[w];
            for (const Tie& tie : tied[w]) {
                if (seen[tie.to]) continue;
                seen[tie.to] = true;
                ties.leader[tie.to] = v;
                ties.motion[tie.to] = tie.motion * ties.motion[w];
                copies.push_back(tie.to);
                ties.copies.push_back({tie.to, w, tie.path, tie.edge});
            }
        }
        if (node && leaderOfFirstNode < 0) leaderOfFirstNode = v;
        if (boundary) {
            const bool slides = copies.size() == 1 && quarters == 2 && !node;
            const bool horizontal = (square.squareSides[v] & 5) != 0;
            ties.free[v] = {slides && horizontal, slides && !horizontal};
        } else if (quarters != 4) {
            ties.free[v] = {false, false};
        }
        anyFixed = anyFixed || !ties.free[v][0] || !ties.free[v][1];
    }
    if (!anyFixed && leaderOfFirstNode >= 0) {
        ties.free[leaderOfFirstNode] = {false, false};
        ties.anchor = leaderOfFirstNode;
    }
    return ties;
}

} // namespace gimg

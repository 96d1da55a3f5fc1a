#include "conformal/handle_tori.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <queue>
#include <string>
#include <utility>

namespace gimg {
namespace {

constexpr int kRoots = 8;          // from which loops are looked for
constexpr size_t kLoops = 24;      // the shortest ones, of which each gets its way back
constexpr size_t kBeginnings = 16; // of a loop that are tried
constexpr double kFar = std::numeric_limits<double>::infinity();

/// Shortest paths along edges.
struct PathTree
{
    std::vector<double> distance; // kFar where no path leads
    std::vector<int> arrival;     // the halfedge by which the path comes, -1 at its beginning
};

class Sets
{
public:
    explicit Sets(int count) : parent_(static_cast<size_t>(count))
    {
        std::iota(parent_.begin(), parent_.end(), 0);
    }
    bool join(int a, int b)
    {
        a = of(a), b = of(b);
        parent_[a] = b;
        return a != b;
    }

private:
    int of(int i)
    {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    std::vector<int> parent_;
};

class HandleFinder
{
public:
    HandleFinder(const Mesh& mesh, const Halfedges& he, const ComplexOneForm& form)
        : mesh_(mesh), he_(he), form_(form), length_(form.cwiseAbs()), free_(mesh.positions.size(), true)
    {
        for (int v = 0; v < mesh.vertexCount(); ++v) free_[v] = he.outgoing(v) >= 0;
    }

    /// The next handle; its neighbourhood is then closed to loops.
    Result<HandleTorus> next()
    {
        HandleTorus best;
        double bestOblong = kFar;
        for (const std::vector<int>& a : shortLoops()) {
            const std::vector<int> path = shortestReturn(a);
            if (path.empty()) continue;
            HandleTorus torus{{a}, {closedAlong(a, path)}, neighbourhood(a, path)};
            const double oblong = oblongness(torus);
            if (oblong >= bestOblong || !isTorusWithOneHole(torus.faces)) continue;
            bestOblong = oblong;
            best = std::move(torus);
        }
        if (best.faces.empty())
            return Error{ErrorKind::TargetUnreachable,
                         "the mesh is too coarse to keep the loops of its handles apart"};
        for (int f : best.faces)
            for (int v : mesh_.faces[f]) free_[v] = false;
        return best;
    }

    /// The shortest loop, turned to where the way back to its beginning is shortest, and that way.
    Result<CrossingLoops> crossing() const
    {
        CrossingLoops best;
        double shortest = kFar;
        const std::vector<std::vector<int>> loops = shortLoops();
        for (size_t i = 0; i < loops.size() && shortest == kFar; ++i) { // later ones if the first have no way
            const std::vector<int>& loop = loops[i];
            const size_t stride = std::max(loop.size() / kBeginnings, size_t{1});
            for (size_t begin = 0; begin < loop.size(); begin += stride) {
                const std::vector<int> back = shortestReturn(loop, he_.tail(loop[begin]));
                const double length = lengthOf(back);
                if (back.empty() || length >= shortest) continue;
                shortest = length;
                best = {{loop}, {back}};
                std::rotate(best.a.halfedges.begin(),
                            best.a.halfedges.begin() + static_cast<std::ptrdiff_t>(begin),
                            best.a.halfedges.end());
            }
        }
        if (shortest < kFar) return best;
        return Error{ErrorKind::TargetUnreachable,
                     "the mesh is too coarse for two loops that cross in one vertex"};
    }

private:
    PathTree pathsFrom(int root) const
    {
        PathTree tree{std::vector<double>(mesh_.positions.size(), kFar),
                      std::vector<int>(mesh_.positions.size(), -1)};
        std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>> open;
        tree.distance[root] = 0;
        open.push({0, root});
        while (!open.empty()) {
            const auto [d, v] = open.top();
            open.pop();
            if (d > tree.distance[v]) continue;
            forOutgoing(v, [&](int h) {
                const int w = he_.head(h);
                if (!free_[w] || d + length_[h] >= tree.distance[w]) return;
                tree.distance[w] = d + length_[h];
                tree.arrival[w] = h;
                open.push({tree.distance[w], w});
            });
        }
        return tree;
    }

    template <class Visit> void forOutgoing(int v, Visit visit) const
    {
        const int first = he_.outgoing(v);
        int h = first;
        do {
            visit(h);
            h = he_.rotateCcw(h);
        } while (h != first);
    }

    // The loops that a tree of shortest paths and one more edge make, and that separate nothing: those edges
    // that join no two faces which the other edges outside the tree, the longest loops first, have not
    // joined. Where vertices are taken all edges join: it is a hole, as if closed by a disk.
    std::vector<std::vector<int>> shortLoops() const
    {
        std::vector<std::pair<double, std::vector<int>>> found;
        std::vector<double> nearest(mesh_.positions.size(), kFar);
        int root = static_cast<int>(std::find(free_.begin(), free_.end(), true) - free_.begin());
        for (int k = 0; k < kRoots && root < mesh_.vertexCount(); ++k) {
            const PathTree tree = pathsFrom(root);
            for (int h : loopEdges(tree)) {
                std::vector<int> loop = loopOver(tree, h);
                const double length = lengthOf(loop);
                found.emplace_back(length, std::move(loop));
            }
            double farthest = 0; // the next root is the vertex farthest from all before
            for (int v = 0; v < mesh_.vertexCount(); ++v) {
                nearest[v] = std::min(nearest[v], tree.distance[v]);
                if (nearest[v] == kFar || nearest[v] <= farthest) continue;
                farthest = nearest[v];
                root = v;
            }
        }
        std::sort(found.begin(), found.end());
        std::vector<std::vector<int>> loops;
        for (size_t i = 0; i < std::min(found.size(), kLoops); ++i)
            loops.push_back(std::move(found[i].second));
        return loops;
    }

    std::vector<int> loopEdges(const PathTree& tree) const
    {
        const auto reached = [&](int v) { return tree.distance[v] < kFar; };
        Sets faces(mesh_.faceCount());
        std::vector<std::pair<double, int>> others;
        for (int h = 0; h < he_.count(); ++h) {
            const int v = he_.tail(h), w = he_.head(h), twin = he_.twin(h);
            if (h > twin) continue;
            if (!reached(v) || !reached(w))
                faces.join(h / 3, twin / 3);
            else if (tree.arrival[w] != h && tree.arrival[v] != twin)
                others.push_back({-(tree.distance[v] + tree.distance[w] + length_[h]), h});
        }
        std::sort(others.begin(), others.end());
        std::vector<int> left;
        for (const auto& [minusLength, h] : others)
            if (!faces.join(h / 3, he_.twin(h) / 3)) left.push_back(h);
        return left;
    }

    // From where the paths to both ends of h part, along one of them, h, and back along the other.
    std::vector<int> loopOver(const PathTree& tree, int h) const
    {
        const auto chainTo = [&](int v) {
            std::vector<int> chain;
            for (; tree.arrival[v] >= 0; v = he_.tail(tree.arrival[v])) chain.push_back(tree.arrival[v]);
            std::reverse(chain.begin(), chain.end());
            return chain;
        };
        std::vector<int> there = chainTo(he_.tail(h));
        const std::vector<int> back = chainTo(he_.head(h));
        size_t common = 0;
        while (common < std::min(there.size(), back.size()) && there[common] == back[common]) ++common;
        there.erase(there.begin(), there.begin() + static_cast<std::ptrdiff_t>(common));
        there.push_back(h);
        for (size_t i = back.size(); i > common; --i) there.push_back(he_.twin(back[i - 1]));
        return there;
    }

    // From the left side of the loop to its right side, through vertices that are not on it; if a vertex of
    // it is given, from there and back there.
    std::vector<int> shortestReturn(const std::vector<int>& loop, int at = -1) const
    {
        enum Side : char
        {
            None,
            Left,
            Right
        };
        std::vector<char> side(static_cast<size_t>(he_.count()),
                               None); // of outgoing halfedges of its vertices
        std::vector<bool> onLoop(mesh_.positions.size(), false);
        for (size_t i = 0; i < loop.size(); ++i) {
            const int ahead = loop[i], behind = he_.twin(loop[(i + loop.size() - 1) % loop.size()]);
            onLoop[he_.tail(ahead)] = true;
            if (at >= 0 && he_.tail(ahead) != at) continue;
            for (int h = he_.rotateCcw(ahead); h != behind; h = he_.rotateCcw(h)) side[h] = Left;
            for (int h = he_.rotateCcw(behind); h != ahead; h = he_.rotateCcw(h)) side[h] = Right;
        }
        PathTree tree{std::vector<double>(mesh_.positions.size(), kFar),
                      std::vector<int>(mesh_.positions.size(), -1)};
        std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>> open;
        double shortest = kFar;
        int last = -1;
        const auto take = [&](double d, int h) { // a path of length d that ends with h
            const int w = he_.head(h);
            if (onLoop[w]) {
                if (side[he_.twin(h)] != Right || d >= shortest) return;
                shortest = d;
                last = h;
            } else if (free_[w] && d < tree.distance[w]) {
                tree.distance[w] = d;
                tree.arrival[w] = h;
                open.push({d, w});
            }
        };
        for (int h = 0; h < he_.count(); ++h)
            if (side[h] == Left) take(length_[h], h);
        while (!open.empty()) {
            const auto [d, v] = open.top();
            open.pop();
            if (d > tree.distance[v]) continue;
            if (d >= shortest) break;
            forOutgoing(v, [&, d = d](int h) { take(d + length_[h], h); });
        }
        std::vector<int> path;
        for (int h = last; h >= 0; h = onLoop[he_.tail(h)] ? -1 : tree.arrival[he_.tail(h)])
            path.push_back(h);
        std::reverse(path.begin(), path.end());
        return path;
    }

    // The path, closed along the loop by the shorter way.
    std::vector<int> closedAlong(const std::vector<int>& loop, std::vector<int> path) const
    {
        const auto at = [&](int v) {
            size_t i = 0;
            while (he_.tail(loop[i]) != v) ++i;
            return i;
        };
        const size_t begin = at(he_.head(path.back())), end = at(he_.tail(path.front())), n = loop.size();
        std::vector<int> ahead, behind;
        for (size_t i = begin; i != end; i = (i + 1) % n) ahead.push_back(loop[i]);
        for (size_t i = begin; i != end; i = (i + n - 1) % n)
            behind.push_back(he_.twin(loop[(i + n - 1) % n]));
        const std::vector<int>& arc = lengthOf(ahead) <= lengthOf(behind) ? ahead : behind;
        path.insert(path.end(), arc.begin(), arc.end());
        return path;
    }

    double lengthOf(const std::vector<int>& chain) const
    {
        double length = 0;
        for (int h : chain) length += length_[h];
        return length;
    }

    // 1 for loops straight and at right angles in the plane; the largest number where their parallelogram is
    // flat or turned over.
    double oblongness(const HandleTorus& torus) const
    {
        const std::complex<double> a = integrate(form_, torus.a.halfedges),
                                   b = integrate(form_, torus.b.halfedges);
        const double lengths = lengthOf(torus.a.halfedges) * lengthOf(torus.b.halfedges);
        const double area = (std::conj(a) * b).imag();
        return area > 0 ? lengths / area : std::numeric_limits<double>::max();
    }

    // All faces around the vertices of both.
    std::vector<int> neighbourhood(const std::vector<int>& loop, const std::vector<int>& path) const
    {
        std::vector<int> faces;
        for (const std::vector<int>* chain : {&loop, &path})
            for (int along : *chain)
                for (int v : {he_.tail(along), he_.head(along)})
                    forOutgoing(v, [&](int h) { faces.push_back(h / 3); });
        std::sort(faces.begin(), faces.end());
        faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
        return faces;
    }

    bool isTorusWithOneHole(const std::vector<int>& faces) const
    {
        Mesh part{mesh_.positions, {}};
        for (int f : faces) part.faces.push_back(mesh_.faces[f]);
        const Halfedges he(part.faces, part.vertexCount());
        std::vector<int> borders(part.positions.size(), 0);
        for (int h = 0; h < he.count(); ++h)
            if (he.onBoundary(h) && ++borders[he.tail(h)] > 1) return false; // the part touches itself there
        const Topology type = topology(part);
        return type.euler() == -1 && type.boundaries == 1;
    }

    const Mesh& mesh_;
    const Halfedges& he_;
    const ComplexOneForm& form_;
    Eigen::VectorXd length_; // of each halfedge in the plane
    std::vector<bool> free_; // per vertex: no face of a handle found before touches it
};

} // namespace

Result<std::vector<HandleTorus>> handleTori(const Mesh& mesh, const Halfedges& halfedges,
                                            const ComplexOneForm& form, int genus)
{
    HandleFinder finder(mesh, halfedges, form);
    std::vector<HandleTorus> tori;
    for (int k = 0; k < genus; ++k) {
        Result<HandleTorus> torus = finder.next();
        if (!torus) return torus.error();
        tori.push_back(std::move(*torus));
    }
    return tori;
}

Result<CrossingLoops> crossingLoops(const Mesh& mesh, const Halfedges& halfedges, const ComplexOneForm& form)
{
    return HandleFinder(mesh, halfedges, form).crossing();
}

} // namespace gimg

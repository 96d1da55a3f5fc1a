#include "gimg/cut.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <set>

namespace gimg {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
using QueueEntry = std::pair<double, int>; // distance, element
using DistanceQueue = std::priority_queue<QueueEntry, std::vector<QueueEntry>, std::greater<>>;

class Cutter
{
public:
    explicit Cutter(const Mesh& mesh)
        : mesh_(mesh), he_(mesh.faces, mesh.vertexCount()), inCut_(he_.count(), true),
          degree_(mesh.vertexCount(), 0), distance_(mesh.vertexCount(), kInfinity),
          parent_(mesh.vertexCount(), -1)
    {
    }

    CutGraph run(std::span<const int> extrema)
    {
        const int seed = extremalFace();
        openFaces(seed);
        countDegrees();
        trim();
        if (std::none_of(degree_.begin(), degree_.end(), [](int d) { return d > 0; })) addTwoEdges(seed);
        CutGraph cut = extractPaths();
        for (int round = 0; round < 2; ++round)
            for (CutPath& path : cut.paths)
                if (!path.boundary) straighten(path);
        if (extrema.empty()) return cut;
        for (int extremum : extrema) extendTo(extremum);
        return extractPaths();
    }

    CutGraph star(std::span<const int> tips)
    {
        std::fill(inCut_.begin(), inCut_.end(), false);
        const int centre = centreOf(tips);
        if (centre < 0) return {};
        for (int tip : tips) {
            const std::vector<int> path = shortestPath(centre, tip, ring(centre), ring(tip), kInfinity);
            if (path.empty()) return {};
            setPathCut(path, true);
        }
        CutGraph cut = extractPaths();
        for (int round = 0; round < 2; ++round)
            for (CutPath& path : cut.paths) straighten(path);
        return cut;
    }

private:
    double edgeLength(int h) const
    {
        return (mesh_.positions[he_.head(h)] - mesh_.positions[he_.tail(h)]).norm();
    }
    Vec3 centroid(int f) const
    {
        const Triangle& t = mesh_.faces[f];
        return (mesh_.positions[t[0]] + mesh_.positions[t[1]] + mesh_.positions[t[2]]) / 3.0;
    }

    void setCut(int h, bool value)
    {
        inCut_[h] = value;
        if (!he_.onBoundary(h)) inCut_[he_.twin(h)] = value;
    }

    // Visits faces by geodesic distance from `seed` over the dual graph; entry[f] is the halfedge of the
    // previous face that was crossed into f. Returns the face reached last.
    int sweepFaces(int seed, std::vector<int>& entry) const
    {
        std::vector<double> distance(mesh_.faces.size(), kInfinity);
        entry.assign(mesh_.faces.size(), -1);
        DistanceQueue queue;
        distance[seed] = 0;
        queue.push({0.0, seed});
        int last = seed;
        while (!queue.empty()) {
            const auto [d, f] = queue.top();
            queue.pop();
            if (d > distance[f]) continue;
            last = f;
            for (int h = 3 * f; h < 3 * f + 3; ++h) {
                if (he_.onBoundary(h)) continue;
                const int g = Halfedges::face(he_.twin(h));
                const double through = d + (centroid(g) - centroid(f)).norm();
                if (through < distance[g]) {
                    distance[g] = through;
                    entry[g] = h;
                    queue.push({through, g});
                }
            }
        }
        return last;
    }

    // An end of the surface: the face farthest from the face farthest from face 0.
    int extremalFace() const
    {
        std::vector<int> entry;
        return sweepFaces(sweepFaces(0, entry), entry);
    }

    // Phase one: removing the edges crossed by the sweep leaves a cut through every vertex.
    void openFaces(int seed)
    {
        std::vector<int> entry;
        sweepFaces(seed, entry);
        for (int h : entry)
            if (h >= 0) setCut(h, false);
    }

    bool isEdgeRepresentative(int h) const { return he_.onBoundary(h) || h < he_.twin(h); }

    void countDegrees()
    {
        for (int h = 0; h < he_.count(); ++h) {
            if (!inCut_[h] || !isEdgeRepresentative(h)) continue;
            ++degree_[he_.tail(h)];
            ++degree_[he_.head(h)];
        }
    }

    // Calls visit(h, w) for every edge at v: h one of its halfedges, w the other end.
    template <class Visit> void forEdgesAt(int v, Visit visit) const
    {
        const int first = he_.outgoing(v);
        for (int h = first; h >= 0;) {
            visit(h, he_.head(h));
            const int incoming = Halfedges::prev(h);
            if (he_.onBoundary(incoming)) visit(incoming, he_.tail(incoming));
            h = he_.rotateCcw(h);
            if (h == first) break;
        }
    }

    // Phase two: edge trees shrink away; loops and boundary edges stay.
    void trim()
    {
        std::vector<int> dangling;
        for (int v = 0; v < mesh_.vertexCount(); ++v)
            if (degree_[v] == 1) dangling.push_back(v);
        while (!dangling.empty()) {
            const int v = dangling.back();
            dangling.pop_back();
            if (degree_[v] != 1) continue;
            int cutEdge = -1, other = -1;
            forEdgesAt(v, [&](int h, int w) {
                if (inCut_[h]) cutEdge = h, other = w;
            });
            setCut(cutEdge, false);
            --degree_[v];
            if (--degree_[other] == 1) dangling.push_back(other);
        }
    }

    // A sphere's cut trims away to nothing: open it along two edges at the vertex farthest from the seed,
    // as straight through that vertex as its edges allow.
    void addTwoEdges(int seed)
    {
        std::vector<int> entry;
        const int far = sweepFaces(seed, entry);
        const int middle = mesh_.faces[far][0];
        std::vector<int> around;
        forEdgesAt(middle, [&](int h, int) { around.push_back(h); });
        const auto direction = [&](int h) {
            return (mesh_.positions[he_.head(h)] - mesh_.positions[he_.tail(h)]).normalized();
        };
        int a = around[0], b = around[1];
        double straightest = 2;
        for (int h : around)
            for (int g : around) {
                const double cosine = direction(h).dot(direction(g));
                if (h != g && cosine < straightest) straightest = cosine, a = h, b = g;
            }
        for (int h : {a, b}) {
            setCut(h, true);
            ++degree_[he_.tail(h)];
            ++degree_[he_.head(h)];
        }
    }

    CutGraph extractPaths() const
    {
        CutGraph cut;
        std::vector<bool> used(he_.count(), false);
        const auto markUsed = [&](int h) {
            used[h] = true;
            if (!he_.onBoundary(h)) used[he_.twin(h)] = true;
        };
        const auto follow = [&](int start, int firstEdge, int next) {
            CutPath path;
            path.boundary = he_.onBoundary(firstEdge);
            path.vertices = {start, next};
            markUsed(firstEdge);
            while (degree_[path.vertices.back()] == 2 && path.vertices.back() != start) {
                int edge = -1, onward = -1;
                forEdgesAt(path.vertices.back(), [&](int h, int w) {
                    if (inCut_[h] && !used[h]) edge = h, onward = w;
                });
                markUsed(edge);
                path.vertices.push_back(onward);
            }
            cut.paths.push_back(std::move(path));
        };
        const auto followAllFrom = [&](int v) {
            forEdgesAt(v, [&](int h, int w) {
                if (inCut_[h] && !used[h]) follow(v, h, w);
            });
        };
        for (int v = 0; v < mesh_.vertexCount(); ++v)
            if (degree_[v] > 0 && degree_[v] != 2) followAllFrom(v);
        // A disk: its one boundary loop has no cut-node, so any vertex starts it.
        for (int v = 0; v < mesh_.vertexCount(); ++v)
            if (degree_[v] == 2) followAllFrom(v);
        return cut;
    }

    int halfedgeBetween(int v, int w) const
    {
        int found = -1;
        forEdgesAt(v, [&](int h, int head) {
            if (head == w && he_.tail(h) == v) found = h;
        });
        return found;
    }

    // All outgoing halfedges of v.
    std::vector<int> ring(int v) const
    {
        std::vector<int> out;
        forEdgesAt(v, [&](int h, int) { out.push_back(h); });
        return out;
    }

    // The vertex with the least sum of distances to the tips that has more edges than there are tips.
    int centreOf(std::span<const int> tips) const
    {
        std::vector<double> sum(mesh_.positions.size(), 0.0);
        for (int tip : tips) {
            std::vector<double> distance(mesh_.positions.size(), kInfinity);
            DistanceQueue queue;
            distance[tip] = 0;
            queue.push({0.0, tip});
            while (!queue.empty()) {
                const auto [d, v] = queue.top();
                queue.pop();
                if (d > distance[v]) continue;
                sum[v] += d;
                forEdgesAt(v, [&](int h, int w) {
                    const double through = d + edgeLength(h);
                    if (through >= distance[w]) return;
                    distance[w] = through;
                    queue.push({through, w});
                });
            }
        }
        int best = -1;
        for (int v = 0; v < mesh_.vertexCount(); ++v) {
            if (he_.outgoing(v) < 0 || std::find(tips.begin(), tips.end(), v) != tips.end()) continue;
            if (ring(v).size() <= tips.size()) continue;
            if (best < 0 || sum[v] < sum[best]) best = v;
        }
        return best;
    }

    // Outgoing halfedges of v in the sector around `first` that other cut edges bound.
    std::vector<int> sector(int first) const
    {
        std::vector<int> out = {first};
        for (int h = he_.rotateCcw(first); h >= 0 && h != first && !inCut_[h]; h = he_.rotateCcw(h))
            out.push_back(h);
        if (out.size() > 1 && he_.rotateCcw(out.back()) == first) return out; // the whole ring of v
        for (int h = he_.rotateCw(first); h >= 0 && !inCut_[h]; h = he_.rotateCw(h)) out.push_back(h);
        return out;
    }

    void setPathCut(const std::vector<int>& vertices, bool value)
    {
        for (size_t i = 0; i + 1 < vertices.size(); ++i) {
            setCut(halfedgeBetween(vertices[i], vertices[i + 1]), value);
            const int step = value ? 1 : -1;
            degree_[vertices[i]] += step;
            degree_[vertices[i + 1]] += step;
        }
    }

    // Replaces the path by the shortest one between its cut-nodes that touches no other part of the cut and
    // leaves and enters the nodes in the same sectors. Without this path the cut leaves an annulus; an arc
    // between the same two corners of its borders opens it again, so the cut stays valid.
    // The search never leaves the ball of the old path's length around its first node.
    void straighten(CutPath& path)
    {
        if (path.vertices.size() < 3) return;
        double oldLength = 0;
        for (size_t i = 0; i + 1 < path.vertices.size(); ++i)
            oldLength += (mesh_.positions[path.vertices[i + 1]] - mesh_.positions[path.vertices[i]]).norm();
        const int start = path.vertices.front(), goal = path.vertices.back();
        const int firstEdge = halfedgeBetween(start, path.vertices[1]);
        const int lastEdge = halfedgeBetween(goal, path.vertices[path.vertices.size() - 2]);
        setPathCut(path.vertices, false);
        const std::vector<int> departures = sector(firstEdge);
        const std::vector<int> arrivals = sector(lastEdge);
        std::vector<int> shortest = shortestPath(start, goal, departures, arrivals, oldLength);
        if (!shortest.empty()) path.vertices = std::move(shortest);
        setPathCut(path.vertices, true);
    }

    std::vector<int> shortestPath(int start, int goal, const std::vector<int>& departures,
                                  const std::vector<int>& arrivals, double limit)
    {
        std::vector<int> touched;
        DistanceQueue queue;
        const auto relax = [&](int v, double d, int from) {
            if (degree_[v] > 0 || v == start || v == goal || d >= distance_[v] || d >= limit) return;
            if (distance_[v] == kInfinity) touched.push_back(v);
            distance_[v] = d;
            parent_[v] = from;
            queue.push({d, v});
        };
        for (int h : departures) relax(he_.head(h), edgeLength(h), -1);
        double best = limit * (1 - 1e-9);
        int bestEnd = -1;
        // The arrival edges: last vertex before the goal, and what the last edge adds.
        std::vector<std::pair<int, double>> lastSteps;
        for (int h : arrivals) lastSteps.push_back({he_.head(h), edgeLength(h)});
        std::sort(lastSteps.begin(), lastSteps.end());
        while (!queue.empty()) {
            const auto [d, v] = queue.top();
            queue.pop();
            if (d > distance_[v]) continue;
            if (d >= best) break;
            const auto step = std::lower_bound(lastSteps.begin(), lastSteps.end(), std::pair(v, -1.0));
            if (step != lastSteps.end() && step->first == v && d + step->second < best) {
                best = d + step->second;
                bestEnd = v;
            }
            forEdgesAt(v, [&](int h, int w) { relax(w, d + edgeLength(h), v); });
        }
        std::vector<int> result;
        if (bestEnd >= 0) {
            result.push_back(goal);
            for (int v = bestEnd; v >= 0; v = parent_[v]) result.push_back(v);
            result.push_back(start);
            std::reverse(result.begin(), result.end());
        }
        for (int v : touched) distance_[v] = kInfinity, parent_[v] = -1;
        return result;
    }

    // Opens the shortest path from the cut to the vertex; the cut gains a branch and stays valid.
    void extendTo(int extremum)
    {
        if (degree_[extremum] > 0) return;
        std::vector<int> touched = {extremum};
        DistanceQueue queue;
        distance_[extremum] = 0;
        queue.push({0.0, extremum});
        int reached = -1;
        while (!queue.empty() && reached < 0) {
            const auto [d, v] = queue.top();
            queue.pop();
            if (d > distance_[v]) continue;
            if (degree_[v] > 0) reached = v;
            forEdgesAt(v, [&](int h, int w) {
                const double through = d + edgeLength(h);
                if (through >= distance_[w]) return;
                if (distance_[w] == kInfinity) touched.push_back(w);
                distance_[w] = through;
                parent_[w] = v;
                queue.push({through, w});
            });
        }
        std::vector<int> path = {reached};
        while (path.back() != extremum) path.push_back(parent_[path.back()]);
        setPathCut(path, true);
        for (int v : touched) distance_[v] = kInfinity, parent_[v] = -1;
    }

    const Mesh& mesh_;
    const Halfedges he_;
    std::vector<bool> inCut_;      // per halfedge
    std::vector<int> degree_;      // per vertex: cut edges at it
    std::vector<double> distance_; // per vertex: infinite between searches
    std::vector<int> parent_;
};

} // namespace

CutGraph starCut(const Mesh& mesh, std::span<const int> tips) { return Cutter(mesh).star(tips); }

int CutGraph::nodeCount() const
{
    std::set<int> nodes;
    for (const CutPath& path : paths) {
        nodes.insert(path.vertices.front());
        nodes.insert(path.vertices.back());
    }
    return static_cast<int>(nodes.size());
}

double cutLength(const Mesh& mesh, const CutGraph& cut)
{
    double length = 0;
    for (const CutPath& path : cut.paths)
        for (size_t i = 0; i + 1 < path.vertices.size(); ++i)
            length += (mesh.positions[path.vertices[i + 1]] - mesh.positions[path.vertices[i]]).norm();
    return length;
}

CutGraph cutToDisk(const Mesh& mesh, std::span<const int> extrema) { return Cutter(mesh).run(extrema); }

} // namespace gimg

#pragma once

#include "gimg/mesh.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <string>

namespace gimg::test {

/// What a triangle list is as an abstract simplicial complex, from vertex numbers alone and without the
/// library's own connectivity: an edge is a pair of vertices, whoever uses it.
struct ManifoldCheck
{
    std::string fault; ///< empty for a connected, oriented 2-manifold with or without boundary
    int genus = 0;
    int boundaries = 0;
};

inline ManifoldCheck checkManifold(const std::vector<Triangle>& faces)
{
    ManifoldCheck check;
    std::map<std::pair<int, int>, int> directed;
    std::set<std::pair<int, int>> edges;
    std::map<int, std::map<int, int>> link; // vertex -> ring vertex -> the next one
    for (const Triangle& f : faces) {
        if (f[0] == f[1] || f[1] == f[2] || f[2] == f[0]) return {"a face repeats a vertex", 0, 0};
        for (int k = 0; k < 3; ++k) {
            const int a = f[k], b = f[(k + 1) % 3], c = f[(k + 2) % 3];
            if (++directed[{a, b}] > 1)
                return {"edge " + std::to_string(a) + "-" + std::to_string(b) + " runs twice the same way", 0,
                        0};
            edges.insert(std::minmax(a, b));
            if (!link[a].insert({b, c}).second)
                return {"vertex " + std::to_string(a) + " has a forked link", 0, 0};
        }
    }
    // Every link must be one chain: an arc (boundary) or a cycle.
    for (const auto& [v, next] : link) {
        std::set<int> targets;
        for (const auto& [from, to] : next) targets.insert(to);
        int start = next.begin()->first;
        for (const auto& [from, to] : next)
            if (targets.count(from) == 0) start = from;
        size_t steps = 0;
        for (int at = start; next.count(at) && steps < next.size(); at = next.at(at)) ++steps;
        if (steps != next.size()) return {"vertex " + std::to_string(v) + " joins several fans", 0, 0};
    }
    std::map<int, int> boundaryNext;
    for (const auto& [edge, count] : directed)
        if (directed.count({edge.second, edge.first}) == 0) boundaryNext[edge.first] = edge.second;
    std::set<int> walked;
    for (const auto& [start, unused] : boundaryNext) {
        if (walked.count(start)) continue;
        ++check.boundaries;
        for (int v = start; walked.insert(v).second;) v = boundaryNext.at(v);
    }
    std::map<int, int> root;
    for (const auto& [v, unused] : link) root[v] = v;
    const auto find = [&](int v) {
        while (root[v] != v) v = root[v] = root[root[v]];
        return v;
    };
    for (const auto& [a, b] : edges) root[find(a)] = find(b);
    int components = 0;
    for (const auto& [v, parent] : root) components += v == parent;
    if (components != 1) return {std::to_string(components) + " components", 0, 0};
    const int euler =
        static_cast<int>(link.size()) - static_cast<int>(edges.size()) + static_cast<int>(faces.size());
    check.genus = (2 - euler - check.boundaries) / 2;
    return check;
}

} // namespace gimg::test

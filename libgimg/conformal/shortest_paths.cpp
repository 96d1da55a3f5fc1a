#include "conformal/shortest_paths.h"

#include <algorithm>
#include <limits>

namespace gimg {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

ShortestPaths::ShortestPaths(const ClosedSurface& surface)
    : surface_(surface), distance_(static_cast<size_t>(surface.surface.vertexCount), kInfinity),
      entry_(distance_.size(), -1)
{
}

void ShortestPaths::searchFrom(std::span<const int> roots, double radius)
{
    for (int v : touched_) distance_[v] = kInfinity, entry_[v] = -1;
    touched_.clear();
    radius_ = radius;
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
    for (int root : roots) {
        distance_[root] = 0;
        touched_.push_back(root);
        front.push({0.0, root});
    }
    const Halfedges& he = surface_.halfedges;
    while (!front.empty()) {
        const auto [d, v] = front.top();
        front.pop();
        if (d > distance_[v]) continue;
        const int first = he.outgoing(v);
        int h = first;
        do {
            const int w = he.head(h);
            const double through = d + surface_.length(h);
            if (through < distance_[w] && through < radius) {
                if (distance_[w] == kInfinity) touched_.push_back(w);
                distance_[w] = through;
                entry_[w] = h;
                front.push({through, w});
            }
            h = he.rotateCcw(h);
        } while (h != first);
    }
}

std::vector<int> ShortestPaths::pathTo(int v) const
{
    std::vector<int> path;
    for (int h = entry_[v]; h >= 0; h = entry_[surface_.halfedges.tail(h)]) path.push_back(h);
    std::reverse(path.begin(), path.end());
    return path;
}

} // namespace gimg

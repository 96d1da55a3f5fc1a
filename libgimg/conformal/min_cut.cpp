#include "conformal/min_cut.h"

#include <algorithm>
#include <limits>

namespace gimg {
namespace {

/// Arc 2 e runs from a to b of edge e, arc 2 e + 1 back; what flows along one is room for the other.
class FlowNetwork
{
public:
    FlowNetwork(int nodes, std::span<const CapacityEdge> edges)
        : first_(static_cast<size_t>(nodes) + 1, 0), arcs_(2 * edges.size()), head_(2 * edges.size()),
          room_(2 * edges.size()), level_(static_cast<size_t>(nodes)), current_(static_cast<size_t>(nodes))
    {
        for (const CapacityEdge& e : edges) ++first_[e.a + 1], ++first_[e.b + 1];
        for (int v = 0; v < nodes; ++v) first_[v + 1] += first_[v];
        std::vector<int> end(first_.begin(), first_.end() - 1);
        for (size_t e = 0; e < edges.size(); ++e) {
            arcs_[end[edges[e].a]++] = static_cast<int>(2 * e);
            arcs_[end[edges[e].b]++] = static_cast<int>(2 * e + 1);
            head_[2 * e] = edges[e].b;
            head_[2 * e + 1] = edges[e].a;
            room_[2 * e] = room_[2 * e + 1] = edges[e].capacity;
        }
    }

    /// Distances from the source in arcs with room. Returns whether the sink is within reach.
    bool measure(int source, int sink)
    {
        std::fill(level_.begin(), level_.end(), -1);
        queue_.assign(1, source);
        level_[source] = 0;
        for (size_t i = 0; i < queue_.size(); ++i) {
            const int v = queue_[i];
            for (int k = first_[v]; k < first_[v + 1]; ++k) {
                const int arc = arcs_[k], w = head_[arc];
                if (room_[arc] == 0 || level_[w] >= 0) continue;
                level_[w] = level_[v] + 1;
                queue_.push_back(w);
            }
        }
        return level_[sink] >= 0;
    }

    /// Fills paths along which the distance grows until each is blocked. Returns what flows.
    int64_t fill(int source, int sink)
    {
        std::copy(first_.begin(), first_.end() - 1, current_.begin());
        int64_t total = 0;
        path_.clear();
        for (int v = source;;) {
            if (v == sink) {
                total += push();
                // Back to the tail of the first arc that is full.
                size_t keep = 0;
                while (room_[path_[keep]] > 0) ++keep;
                v = head_[path_[keep] ^ 1];
                path_.resize(keep);
                continue;
            }
            const int arc = nextArc(v);
            if (arc >= 0) {
                path_.push_back(arc);
                v = head_[arc];
            } else {
                if (v == source) return total;
                level_[v] = -1;
                v = head_[path_.back() ^ 1];
                path_.pop_back();
            }
        }
    }

    bool reached(int v) const { return level_[v] >= 0; }

private:
    int nextArc(int v)
    {
        for (int& k = current_[v]; k < first_[v + 1]; ++k)
            if (room_[arcs_[k]] > 0 && level_[head_[arcs_[k]]] == level_[v] + 1) return arcs_[k];
        return -1;
    }

    int64_t push()
    {
        int64_t amount = std::numeric_limits<int64_t>::max();
        for (int arc : path_) amount = std::min(amount, room_[arc]);
        for (int arc : path_) {
            room_[arc] -= amount;
            room_[arc ^ 1] += amount;
        }
        return amount;
    }

    std::vector<int> first_, arcs_, head_;
    std::vector<int64_t> room_;
    std::vector<int> level_, current_, queue_, path_;
};

} // namespace

MinimumCut minimumCut(int nodes, std::span<const CapacityEdge> edges, int source, int sink)
{
    FlowNetwork network(nodes, edges);
    MinimumCut cut;
    while (network.measure(source, sink)) cut.capacity += network.fill(source, sink);
    for (int v = 0; v < nodes; ++v) cut.inside.push_back(network.reached(v));
    return cut;
}

} // namespace gimg

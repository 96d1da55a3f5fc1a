#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace gimg {

struct CapacityEdge
{
    int a, b;
    int64_t capacity; ///< both ways, >= 0
};

/// A set of nodes with the least capacity of edges that leave it.
struct MinimumCut
{
    std::vector<bool> inside; ///< per node; the smallest such set
    int64_t capacity = 0;
};

/// Of all sets that have the source and not the sink. Source: Dinitz 1970, "Algorithm for solution of a
/// problem of maximum flow in networks with power estimation".
MinimumCut minimumCut(int nodes, std::span<const CapacityEdge> edges, int source, int sink);

} // namespace gimg

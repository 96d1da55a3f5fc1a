#include "conformal/min_cut.h"

#include <gtest/gtest.h>

#include <random>

namespace gimg {
namespace {

int64_t leaving(const std::vector<CapacityEdge>& edges, unsigned inside)
{
    int64_t sum = 0;
    for (const CapacityEdge& e : edges)
        if ((inside >> e.a & 1) != (inside >> e.b & 1)) sum += e.capacity;
    return sum;
}

// Node 0 is the source, node n - 1 the sink; every set of nodes is looked at.
TEST(MinimumCut, IsTheLeastOfAllSetsAndTheSmallestOfThose)
{
    std::mt19937 random(7);
    for (int round = 0; round < 200; ++round) {
        const int n = 9;
        std::vector<CapacityEdge> edges;
        for (int k = 0; k < 16; ++k) {
            const int a = static_cast<int>(random() % n), b = static_cast<int>(random() % n);
            if (a != b) edges.push_back({a, b, static_cast<int64_t>(random() % 4)});
        }
        int64_t least = leaving(edges, 1);
        unsigned smallest = 1; // minimal sets are closed under intersection, so this is the one
        for (unsigned set = 1; set < 1u << (n - 1); set += 2) {
            const int64_t capacity = leaving(edges, set);
            if (capacity < least) least = capacity, smallest = set;
            if (capacity == least) smallest &= set;
        }
        const MinimumCut cut = minimumCut(n, edges, 0, n - 1);
        EXPECT_EQ(cut.capacity, least) << round;
        for (int v = 0; v < n; ++v) EXPECT_EQ(cut.inside[v], (smallest >> v & 1) != 0) << round;
    }
}

} // namespace
} // namespace gimg

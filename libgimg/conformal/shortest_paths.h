#pragma once

#include "conformal/closed_surface.h"

#include <queue>
#include <span>
#include <vector>

namespace gimg {

/// Shortest paths along edges from one or several roots. The same object serves any number of searches, each
/// in time that depends on what it reaches.
class ShortestPaths
{
public:
    explicit ShortestPaths(const ClosedSurface& surface); ///< must outlive this

    /// Reaches all vertices nearer than `radius`.
    void searchFrom(std::span<const int> roots, double radius);
    void searchFrom(int root, double radius) { searchFrom(std::span(&root, 1), radius); }

    bool isReached(int v) const { return distance_[v] < radius_; }
    double distance(int v) const { return distance_[v]; } ///< of a vertex that is reached
    int entry(int v) const { return entry_[v]; }          ///< the path's last halfedge; -1 at a root

    /// The halfedges of the path from a root to v.
    std::vector<int> pathTo(int v) const;

private:
    const ClosedSurface& surface_;
    double radius_ = 0;
    std::vector<double> distance_;
    std::vector<int> entry_;
    std::vector<int> touched_;
};

} // namespace gimg

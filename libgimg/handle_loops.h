#pragma once

#include "edge_classes.h"
#include "editable_surface.h"

#include <optional>
#include <queue>
#include <vector>

namespace gimg {

/// A closed chain of edges that does not separate the surface and visits no vertex twice.
struct HandleLoop
{
    double length = 0;
    std::vector<int> vertices;
};

/// Finds the shortest loop of a surface that does not separate it, again and again while the surface is cut
/// along what was found. Every such loop passes an edge with a class, so one end of each of these edges is a
/// *root*, and the shortest loop is the shortest through any root. How short that can be is known for each
/// root from below, and only the least bound is ever looked into.
class HandleLoops
{
public:
    /// Both must outlive this object; the surface must be connected.
    HandleLoops(const EditableSurface& surface, const EdgeClasses& classes);

    /// The shortest loop, if it is at most `longest` long.
    std::optional<HandleLoop> shortest(double longest);

    /// Called after the surface was cut: `copy` stands where `original` was, on the other side.
    void addCopy(int original, int copy);
    /// Called after the surface gained a vertex.
    void addRoot(int v);

private:
    struct Reached
    {
        double distance;
        int entry; ///< halfedge of the edge from the parent; -1 at the root
        int parent;
        bool settled;
    };
    using Entry = std::pair<double, int>;
    using Queue = std::priority_queue<Entry, std::vector<Entry>, std::greater<>>;

    std::optional<HandleLoop> shortestThrough(int root, double radius);
    void reach(int v, const Reached& how);
    void closeLoops(int v, std::optional<int>& closing, double& length);
    std::vector<int> loopOver(int closing) const;
    void raiseBounds(double bound);
    void grow();

    const EditableSurface& surface_;
    const EdgeClasses& classes_;
    double firstRadius_;
    std::vector<double> bound_; // per vertex: no loop through it is shorter; negative if it is no root
    Queue roots_;               // by a bound that may have been raised since

    // Of the search in progress.
    std::vector<int> slot_; // per vertex: into reached_; -1
    std::vector<int> touched_;
    std::vector<Reached> reached_;
    std::vector<uint64_t> classOf_; // per slot: of the path from the root
    HomologyClass sum_;
    Queue front_;
};

} // namespace gimg

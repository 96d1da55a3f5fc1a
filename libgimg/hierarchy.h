#pragma once

#include "gimg/mesh.h"

#include <cstdint>
#include <vector>

namespace gimg {

/// A mesh (most often a disk) with an editable coarse version: interior vertices are removed one at a time by
/// half-edge collapses, each recorded so that it can be undone (a progressive mesh of the disk's interior).
/// The border is kept, and no collapse joins two border vertices by a new edge.
class Hierarchy
{
public:
    /// @param squareSides  per vertex: non-zero on the border
    Hierarchy(const Mesh& disk, const std::vector<uint8_t>& squareSides);

    /// Collapses, cheapest first, until one interior vertex is left, the hub of a wheel. (In a disk without
    /// interior edges between border vertices some collapse is always possible.)
    void coarsen() { coarsenTo(1); }

    /// The same until `interior` of the removable vertices are left, or no collapse is possible.
    void coarsenTo(int interior);

    /// The current mesh, with `vertexOf[i]` the disk's index of its vertex i.
    Mesh current(std::vector<int>& vertexOf) const;
    int interiorCount() const { return interior_; }
    bool isFull() const { return removals_.empty(); }

    /// Undoes the last collapse. Returns the vertex that came back.
    int refine();

    /// Faces at a vertex of the current mesh, as triangles that begin with it.
    std::vector<Triangle> star(int v) const;

private:
    struct Removal
    {
        int vertex, target;
        std::vector<int> moved; // faces that were re-attached from vertex to target
        int deleted[2];         // faces between them
    };
    struct Candidate;

    void findRing(int v); // sets ring_
    bool findCollapse(int v, size_t largestValence, Candidate& candidate);
    void coarsen(size_t largestValence, int interior);
    int commonNeighbours(int u); // of u and the vertex whose ring is marked
    void collapse(const Candidate& candidate);
    double quadricError(int v, int target) const;

    const Mesh& disk_;
    const std::vector<uint8_t>& squareSides_;
    std::vector<Triangle> faces_;
    std::vector<bool> faceAlive_;
    std::vector<bool> vertexAlive_;
    std::vector<std::vector<int>> facesOf_;
    std::vector<Eigen::Matrix4d> quadric_;
    std::vector<Removal> removals_;
    std::vector<int> ring_; // ordered neighbours of the vertex last looked at
    std::vector<std::pair<int, int>> steps_;
    std::vector<std::pair<Vec3, double>> normals_;
    std::vector<int> ringMark_, seenMark_; // per vertex: stamps of the latest ring and neighbourhood
    int mark_ = 0, seen_ = 0;
    int interior_ = 0;
    double scale_ = 0; // weight of edge length against distance to planes
};

} // namespace gimg

#pragma once

#include "gimg/mesh.h"
#include "nearest_tree.h"

#include <vector>

namespace gimg {

/// The sharp edges of a mesh, as chains of segments that end at corners.
class CreaseNet
{
public:
    /// A sharp edge of the mesh.
    struct Segment
    {
        Vec3 from, to;
        Vec3 side;              ///< unit normal of the plane that halves the angle between the two faces
        Vec3 outwards;          ///< sum of the two faces' unit normals
        std::array<int, 2> end; ///< vertices of the mesh
        std::array<int, 2> next = {-1, -1}; ///< the segment that goes on at `from`, `to`; -1: the chain ends
        int chain = -1;

        Vec3 direction() const { return (to - from).normalized(); }
        Vec3 nearest(const Vec3& q) const;
    };

    /// Where three chains or more meet, or one turns sharply.
    struct Corner
    {
        Vec3 at;
        Vec3 outwards; ///< of the segments there
        std::vector<int> chains;
    };

    struct Place
    {
        Vec3 point;
        int segment = -1;
    };

    /// @param angle     degrees between the normals of two faces from which on their edge is sharp
    /// @param shortest  loose ends and pieces that are shorter are left out
    CreaseNet(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces, double angle,
              double shortest);

    const std::vector<Segment>& segments() const { return segments_; }
    const std::vector<Corner>& corners() const { return corners_; }
    int chainCount() const { return chains_; }
    double length() const;

    /// The nearest place on all chains. There must be a segment.
    Place nearest(const Vec3& q) const;
    /// The nearest place on the chain of a segment, found by walking along from there.
    Place nearestAlong(const Vec3& q, int segment) const;

private:
    void linkChains(int vertexCount);

    std::vector<Segment> segments_;
    std::vector<Corner> corners_;
    int chains_ = 0;
    NearestTree tree_; ///< of the segments, as triangles without area
};

} // namespace gimg

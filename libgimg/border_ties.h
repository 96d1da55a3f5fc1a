#pragma once

#include "gimg/border.h"
#include "gimg/mesh.h"

#include <array>
#include <vector>

namespace gimg {

/// A rigid motion of the plane: counter-clockwise quarter turns about the origin, then a shift. Motions
/// between the sides of the square shift by multiples of the lowest grid's step, so they are exact.
struct GridMotion
{
    int turns = 0; ///< 0 to 3
    Vec2 shift = Vec2::Zero();

    Vec2 turned(const Vec2& p) const;
    Vec2 operator()(const Vec2& p) const { return turned(p) + shift; }
    GridMotion operator*(const GridMotion& first) const;
    GridMotion inverse() const;
    bool operator==(const GridMotion& other) const { return turns == other.turns && shift == other.shift; }
};

/// How the border of the square moves when its seam may slide over the surface: the square with its mates
/// glued is a flat surface with a few cone points, and only those need stay where they are.
struct BorderTies
{
    /// Per disk vertex: the copy that leads (the vertex itself inside), and the motion that takes the
    /// leader's position to this copy's.
    std::vector<int> leader;
    std::vector<GridMotion> motion;
    /// Per disk vertex, meaningful for leaders: whether s and t may change. Both are free inside, and where
    /// the angles of the copies make a full turn; on the surface's boundary the coordinate along the square's
    /// side is; neither at cone points.
    std::vector<std::array<bool, 2>> free;
    /// Per halfedge of the disk (and of the surface): the motion from the coordinates of the face across the
    /// edge to those of this face; the identity off the seam.
    std::vector<GridMotion> across;

    /// All border vertices, each after the copy it was reached from.
    struct Copy
    {
        int vertex;
        int parent; ///< -1 for leaders
        int path;   ///< the cut-path that ties it to the parent
        int edge;   ///< the square's side, 0 to 3 from the bottom counter-clockwise, that it is on along that
                    ///< path
    };
    std::vector<Copy> copies;
    int anchor = -1; ///< the leader that is held although it sits at no cone point, since something has to be
};

/// Of the square's side `edge`, counter-clockwise.
Vec2 sideDirection(int edge);

BorderTies borderTies(const SquareDisk& square);

} // namespace gimg

#pragma once

#include "gimg/mesh.h"

#include <array>
#include <vector>

namespace gimg {

/// How far a piecewise linear map is from conformal, and how unevenly it spreads the surface.
struct Conformality
{
    double medianAngleError = 0; ///< |angle in the image - angle on the surface| over all corners, in degrees
    double angleError95 = 0;     ///< 95 % of the corners have no more
    double largestAngleError = 0; ///< of any corner
    /// Mean over the surface's area of the larger singular value over the smaller; 1 for a conformal map.
    double quasiConformalRatio = 1;
    /// Standard deviation over the surface's area of the natural logarithm of area in the image over area on
    /// the surface; 0 where all areas are scaled alike.
    double areaDistortion = 0;
    int degenerate = 0; ///< triangles without area, on the surface or in the image; left out of all above
};

/// Of the map that takes every vertex of `surface` to its point in space; triangles are flat there. (A
/// triangle's orientation is not looked at: in space it has none.)
/// @param image  one point per vertex
Conformality conformality(const Mesh& surface, const std::vector<Vec3>& image);

/// Of a map to the plane.
/// @param image  one point per vertex
Conformality conformality(const Mesh& surface, const std::vector<Vec2>& image);

/// Of a map to the plane that jumps across seams.
/// @param image  per face: where its three corners go
Conformality conformality(const Mesh& surface, const std::vector<std::array<Vec2, 3>>& image);

} // namespace gimg

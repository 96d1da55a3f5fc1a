#pragma once

#include "gimg/image_io.h"
#include "gimg/mesh.h"

#include <algorithm>

namespace gimg {

/// A point of the decoder's triangles.
struct OnTriangle
{
    Vec3 point;
    Vec3 normal; ///< of the triangle, not of unit length
};

/// Where the point (s, t), in cells, lies on the decoder's triangles of a square geometry image.
/// @param cells  gridMesh(geometry).faces
inline OnTriangle onTriangles(const FloatImage& geometry, const std::vector<Triangle>& cells, double s,
                              double t)
{
    const int last = geometry.width - 1;
    const auto pixel = [&](int i, int j) {
        return Vec3(geometry.at(i, j, 0), geometry.at(i, j, 1), geometry.at(i, j, 2));
    };
    const int column = std::min(static_cast<int>(s), last - 1), row = std::min(static_cast<int>(t), last - 1);
    const double u = s - column, v = t - row;
    const Vec3 a = pixel(column, row), b = pixel(column + 1, row), c = pixel(column + 1, row + 1),
               d = pixel(column, row + 1);
    // The first triangle of a cell starts a b; its last corner tells the diagonal.
    const int third = cells[2 * (static_cast<size_t>(row) * last + column)][2];
    const auto at = [](const Vec3& corner, double x, const Vec3& along, double y, const Vec3& up) {
        return OnTriangle{corner + x * (along - corner) + y * (up - corner),
                          (along - corner).cross(up - corner)};
    };
    if (third == (row + 1) * geometry.width + column + 1)
        return u >= v ? OnTriangle{Vec3(a + (u - v) * (b - a) + v * (c - a)), (b - a).cross(c - a)}
                      : OnTriangle{Vec3(a + u * (c - a) + (v - u) * (d - a)), (c - a).cross(d - a)};
    return u + v <= 1 ? at(a, u, b, v, d) : at(c, 1 - u, d, 1 - v, b);
}

} // namespace gimg

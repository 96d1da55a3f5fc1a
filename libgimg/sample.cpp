#include "gimg/sample.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace gimg {
namespace {

struct Image
{
    int n;
    std::vector<Vec3> value;
    std::vector<double> inside; // smallest barycentric coordinate of the triangle that gave the value

    explicit Image(int size)
        : n(size), value(static_cast<size_t>(size) * size, Vec3::Zero()), inside(value.size(), -1e-6)
    {
    }
    size_t index(int i, int j) const { return static_cast<size_t>(j) * n + i; }
};

// Interpolates over every grid point in or on the triangle. Where triangles meet, rounding may put a point
// outside both, by a hair: the one that holds it best wins.
void rasterize(const std::array<Vec2, 3>& corner, const std::array<Vec3, 3>& value, Image& image)
{
    const auto [loX, hiX] = std::minmax({corner[0].x(), corner[1].x(), corner[2].x()});
    const auto [loY, hiY] = std::minmax({corner[0].y(), corner[1].y(), corner[2].y()});
    constexpr double kHair = 1e-7;
    const int i0 = std::max(0, static_cast<int>(std::ceil(loX - kHair)));
    const int i1 = std::min(image.n - 1, static_cast<int>(std::floor(hiX + kHair)));
    const int j0 = std::max(0, static_cast<int>(std::ceil(loY - kHair)));
    const int j1 = std::min(image.n - 1, static_cast<int>(std::floor(hiY + kHair)));
    const Vec2 a = corner[1] - corner[0], b = corner[2] - corner[0];
    const double doubled = a.x() * b.y() - a.y() * b.x();
    for (int j = j0; j <= j1; ++j)
        for (int i = i0; i <= i1; ++i) {
            const Vec2 p = Vec2(i, j) - corner[0];
            const double u = (p.x() * b.y() - p.y() * b.x()) / doubled;
            const double v = (a.x() * p.y() - a.y() * p.x()) / doubled;
            const double smallest = std::min({u, v, 1 - u - v});
            const size_t at = image.index(i, j);
            if (!(smallest > image.inside[at])) continue;
            image.inside[at] = smallest;
            image.value[at] = (1 - u - v) * value[0] + u * value[1] + v * value[2];
        }
}

// Grid point at border position k, counter-clockwise from (0,0).
std::pair<int, int> borderPoint(int k, int n)
{
    const int side = n - 1, along = k % side;
    switch (k / side % 4) {
    case 0:
        return {along, 0};
    case 1:
        return {side, along};
    case 2:
        return {side - along, side};
    default:
        return {0, side - along};
    }
}

// Value at parameter u of a path, always computed in the path's own direction.
Vec3 alongPath(const CutPath& path, const std::vector<double>& parameter,
               const std::vector<Vec3>& surfaceValue, double u)
{
    const size_t upper = static_cast<size_t>(
        std::clamp<long>(std::upper_bound(parameter.begin(), parameter.end(), u) - parameter.begin(), 1,
                         static_cast<long>(parameter.size()) - 1));
    const double w = (u - parameter[upper - 1]) / (parameter[upper] - parameter[upper - 1]);
    const Vec3& from = surfaceValue[path.vertices[upper - 1]];
    const Vec3& to = surfaceValue[path.vertices[upper]];
    if (w == 0) return from;
    if (w == 1) return to;
    return (1 - w) * from + w * to;
}

void sampleBorder(const SquareDisk& square, const std::vector<Vec3>& surfaceValue, Image& image)
{
    const int ratio = (image.n - 1) / (square.lowest - 1);
    const int perimeter = 4 * (image.n - 1);
    int begin = square.start * ratio;
    for (const DiskSide& side : square.disk.sides) {
        const int length = square.pathLength[side.path] * ratio;
        for (int k = 0; k <= length; ++k) {
            const double u = static_cast<double>(side.reversed ? length - k : k) / ratio;
            const auto [i, j] = borderPoint((begin + k) % perimeter, image.n);
            const size_t at = image.index(i, j);
            image.inside[at] = 1;
            image.value[at] =
                alongPath(square.cut.paths[side.path], square.pathParameter[side.path], surfaceValue, u);
        }
        begin += length;
    }
}

Result<Image> sampleValues(const SquareDisk& square, const Parameterization& parameterization,
                           const std::vector<Vec3>& surfaceValue, int n)
{
    if (n < square.lowest || (n - 1) % (square.lowest - 1) != 0 || ((n - 1) & (n - 2)) != 0)
        return Error{ErrorKind::BadArgument, "cannot sample " + std::to_string(n) + " x " +
                                                 std::to_string(n) +
                                                 ": the size must be 2^j + 1 and at least the lowest level " +
                                                 std::to_string(square.lowest)};
    Image image(n);
    const DiskMesh& disk = square.disk;
    for (const Triangle& f : disk.mesh.faces) {
        std::array<Vec2, 3> corner;
        std::array<Vec3, 3> value;
        for (int k = 0; k < 3; ++k) {
            corner[k] = parameterization.st[f[k]] * (n - 1);
            value[k] = surfaceValue[disk.origin[f[k]]];
        }
        rasterize(corner, value, image);
    }
    sampleBorder(square, surfaceValue, image);
    for (size_t at = 0; at < image.value.size(); ++at)
        if (image.inside[at] <= -1e-6)
            return Error{ErrorKind::FlippedTriangle, "grid point " + std::to_string(at % n) + ", " +
                                                         std::to_string(at / n) + " lies in no triangle"};
    return image;
}

FloatImage toFloat(const Image& image)
{
    FloatImage out{image.n, image.n, {}};
    out.samples.reserve(image.value.size() * 3);
    for (const Vec3& v : image.value)
        for (int k = 0; k < 3; ++k) out.samples.push_back(static_cast<float>(v[k]));
    return out;
}

} // namespace

Result<FloatImage> sampleGeometry(const SquareDisk& square, const Parameterization& parameterization, int n)
{
    const Result<Image> image = sampleValues(square, parameterization, square.surface.positions, n);
    if (!image) return image.error();
    return toFloat(*image);
}

Result<FloatImage> sampleNormals(const SquareDisk& square, const Parameterization& parameterization, int n)
{
    Result<Image> image = sampleValues(square, parameterization, vertexNormals(square.surface), n);
    if (!image) return image.error();
    for (Vec3& v : image->value) {
        const double length = v.norm();
        v = length > 0 ? Vec3(v / length) : Vec3(0, 0, 1);
    }
    return toFloat(*image);
}

} // namespace gimg

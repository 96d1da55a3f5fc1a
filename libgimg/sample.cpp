#include "gimg/sample.h"

#include "codec/border.h"
#include "stretch_element.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace gimg {
namespace {

constexpr double kHair = 1e-6; // grid steps

struct Image
{
    int n;
    std::vector<Vec3> value;
    std::vector<double> inside; // how far inside the triangle that gave the value, in grid steps

    explicit Image(int size)
        : n(size), value(static_cast<size_t>(size) * size, Vec3::Zero()), inside(value.size(), -kHair)
    {
    }
    size_t index(int i, int j) const { return static_cast<size_t>(j) * n + i; }
};

// How far p lies to the left of the line from a to b; 0 if they coincide.
double leftOf(const Vec2& a, const Vec2& b, const Vec2& p)
{
    const Vec2 along = b - a, to = p - a;
    const double length = along.norm();
    return length > 0 ? (along.x() * to.y() - along.y() * to.x()) / length : 0;
}

// Interpolates over every grid point in or on the triangle. Where triangles meet, rounding may put a point
// outside both, by a hair: the one that holds it best wins. Distances decide, since barycentric coordinates
// amplify rounding in slivers.
void rasterize(const std::array<Vec2, 3>& corner, const std::array<Vec3, 3>& value, Image& image)
{
    const auto [loX, hiX] = std::minmax({corner[0].x(), corner[1].x(), corner[2].x()});
    const auto [loY, hiY] = std::minmax({corner[0].y(), corner[1].y(), corner[2].y()});
    const int i0 = std::max(0, static_cast<int>(std::ceil(loX - kHair)));
    const int i1 = std::min(image.n - 1, static_cast<int>(std::floor(hiX + kHair)));
    const int j0 = std::max(0, static_cast<int>(std::ceil(loY - kHair)));
    const int j1 = std::min(image.n - 1, static_cast<int>(std::floor(hiY + kHair)));
    for (int j = j0; j <= j1; ++j)
        for (int i = i0; i <= i1; ++i) {
            const Vec2 p(i, j);
            const double inside = std::min({leftOf(corner[0], corner[1], p), leftOf(corner[1], corner[2], p),
                                            leftOf(corner[2], corner[0], p)});
            const size_t at = image.index(i, j);
            if (!(inside > image.inside[at])) continue;
            image.inside[at] = inside;
            double weight[3], sum = 0;
            for (int k = 0; k < 3; ++k) {
                weight[k] = std::max(0.0, doubleArea({p, corner[(k + 1) % 3], corner[(k + 2) % 3]}));
                sum += weight[k];
            }
            image.value[at] = (weight[0] * value[0] + weight[1] * value[1] + weight[2] * value[2]) / sum;
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
            const size_t at = codec::borderSample(static_cast<uint32_t>(image.n),
                                                  static_cast<uint32_t>((begin + k) % perimeter));
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
    if (n < square.lowest || n > BorderOptions::kLargestGrid || (n - 1) % (square.lowest - 1) != 0 ||
        ((n - 1) & (n - 2)) != 0)
        return Error{ErrorKind::BadArgument, "cannot sample " + std::to_string(n) + " x " +
                                                 std::to_string(n) +
                                                 ": the size must be 2^j + 1, at least the lowest level " +
                                                 std::to_string(square.lowest) + " and at most " +
                                                 std::to_string(BorderOptions::kLargestGrid)};
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
        if (image.inside[at] <= -kHair)
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

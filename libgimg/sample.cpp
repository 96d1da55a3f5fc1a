#include "gimg/sample.h"

#include "codec/border.h"
#include "codec/seam.h"
#include "lifts.h"
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

// Border samples that are one on the surface get the value of the one that a triangle holds best.
void mergeMates(const SquareDisk& square, Image& image)
{
    const std::uint32_t n = static_cast<std::uint32_t>(image.n);
    const std::vector<std::uint32_t> classes = codec::borderClasses(
        {static_cast<std::uint32_t>(square.lowest), static_cast<std::uint32_t>(square.start), square.seam()},
        n);
    std::vector<size_t> best(classes.size());
    const auto sample = [&](size_t position) {
        return size_t{codec::borderSample(n, static_cast<std::uint32_t>(position))};
    };
    for (size_t k = 0; k < classes.size(); ++k) best[k] = sample(k);
    for (size_t k = 0; k < classes.size(); ++k)
        if (image.inside[sample(k)] > image.inside[best[classes[k]]]) best[classes[k]] = sample(k);
    for (size_t k = 0; k < classes.size(); ++k) {
        image.value[sample(k)] = image.value[best[classes[k]]];
        image.inside[sample(k)] = image.inside[best[classes[k]]];
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
    const Result<std::vector<Lift>> lifts = liftsOverSquare(square, borderTies(square), parameterization.st);
    if (!lifts) return lifts.error();
    for (const Lift& lift : *lifts) {
        const Triangle& f = disk.mesh.faces[lift.face];
        std::array<Vec2, 3> corner;
        std::array<Vec3, 3> value;
        for (int k = 0; k < 3; ++k) {
            corner[k] = lift.motion(parameterization.st[f[k]]) * (n - 1);
            value[k] = surfaceValue[disk.origin[f[k]]];
        }
        rasterize(corner, value, image);
    }
    mergeMates(square, image);
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

double seamLength(const GridSeam& seam, const FloatImage& geometry)
{
    const std::uint32_t n = static_cast<std::uint32_t>(geometry.width), perimeter = 4 * (n - 1);
    const std::uint32_t ratio = (n - 1) / static_cast<std::uint32_t>(seam.lowest - 1);
    const auto at = [&](std::uint32_t position) {
        const float* p = &geometry.samples[3 * size_t{codec::borderSample(n, position % perimeter)}];
        return Vec3(p[0], p[1], p[2]);
    };
    double length = 0;
    std::uint32_t begin = static_cast<std::uint32_t>(seam.start) * ratio;
    for (const gim_side& side : seam.sides) {
        for (std::uint32_t k = 0; k < side.length * ratio && side.kind != GIM_SIDE_MATE; ++k)
            length += (at(begin + k + 1) - at(begin + k)).norm();
        begin += side.length * ratio;
    }
    return length;
}

} // namespace gimg

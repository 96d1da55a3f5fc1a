#include "gimg/conformal_image.h"

#include "codec/border.h"
#include "codec/seam.h"
#include "gimg/border.h"

#include <string>

namespace gimg {
namespace {

constexpr int kSmallest = 5; // the middles of its sides are apart from the corners by more than a step

FloatImage toFloat(const std::vector<Vec3>& samples, int n)
{
    FloatImage image{n, n, {}};
    image.samples.reserve(samples.size() * 3);
    for (const Vec3& v : samples)
        for (int k = 0; k < 3; ++k) image.samples.push_back(static_cast<float>(v[k]));
    return image;
}

} // namespace

ConformalSquare::ConformalSquare(const Mesh& mesh, SphereMap sphere, const Moebius& toSphere,
                                 SphereLocator locator)
    : surface_(std::make_shared<const Mesh>(mesh)), sphere_(std::move(sphere)), toSphere_(toSphere),
      locator_(std::move(locator))
{
}

Result<ConformalSquare> ConformalSquare::of(const Mesh& mesh, const Progress& progress)
{
    Result<SphereMap> sphere = sphereMap(mesh, {}, progress);
    if (!sphere) return sphere.error();
    Result<SphereLocator> locator = SphereLocator::of(mesh.faces, sphere->position);
    if (!locator) return locator.error();
    const Moebius placed = placementOnSquare(mesh, sphere->position);
    return ConformalSquare(mesh, std::move(*sphere), placed.inverse(), std::move(*locator));
}

// The surface stays where it is on the sphere, and the square is laid around it: limbs that are as small as
// doubles can tell would not survive being moved.
Result<std::vector<Vec3>> ConformalSquare::sample(const std::vector<Vec3>& value, int n) const
{
    if (n < kSmallest || n > BorderOptions::kLargestGrid || ((n - 1) & (n - 2)) != 0)
        return Error{ErrorKind::BadArgument, "cannot sample " + std::to_string(n) + " x " +
                                                 std::to_string(n) + ": the size must be 2^j + 1, at least " +
                                                 std::to_string(kSmallest) + " and at most " +
                                                 std::to_string(BorderOptions::kLargestGrid)};
    std::vector<Vec3> samples(static_cast<size_t>(n) * n);
    int near = 0;
    for (int j = 0; j < n; ++j)
        for (int step = 0; step < n; ++step) {
            const int i = j % 2 == 0 ? step : n - 1 - step; // there and back, so that the last face is near
            const Vec3 direction = toSphere_(sphereOfSquare(Vec2(i, j) / (n - 1)));
            const SurfacePoint at = locator_.locate(direction, near);
            near = at.face;
            Vec3 sum = Vec3::Zero();
            for (int k = 0; k < 3; ++k) sum += at.barycentric[k] * value[surface_->faces[at.face][k]];
            samples[static_cast<size_t>(j) * n + i] = sum;
        }
    const GridSeam seam = foldedSquareSeam(n);
    const auto grid = static_cast<std::uint32_t>(n);
    const std::vector<std::uint32_t> classes = codec::borderClasses(
        {static_cast<std::uint32_t>(seam.lowest), static_cast<std::uint32_t>(seam.start), seam.sides}, grid);
    for (size_t k = 0; k < classes.size(); ++k)
        samples[codec::borderSample(grid, static_cast<std::uint32_t>(k))] =
            samples[codec::borderSample(grid, classes[k])];
    return samples;
}

Result<FloatImage> ConformalSquare::geometry(int n) const
{
    const Result<std::vector<Vec3>> samples = sample(surface_->positions, n);
    if (!samples) return samples.error();
    return toFloat(*samples, n);
}

Result<FloatImage> ConformalSquare::normals(int n) const
{
    Result<std::vector<Vec3>> samples = sample(vertexNormals(*surface_), n);
    if (!samples) return samples.error();
    for (Vec3& v : *samples) {
        const double length = v.norm();
        v = length > 0 ? Vec3(v / length) : Vec3(0, 0, 1);
    }
    return toFloat(*samples, n);
}

} // namespace gimg

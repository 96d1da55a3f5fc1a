#include "gimg/sphere_correspondence.h"

#include "mesh_check.h"

#include <cstdint>
#include <string>

namespace gimg {
namespace {

double determinant(const Vec3& a, const Vec3& b, const Vec3& c) { return a.dot((b - a).cross(c - a)); }

} // namespace

Vec3 pointAt(const Mesh& mesh, const SurfacePoint& point)
{
    const Triangle& t = mesh.faces[point.face];
    return point.barycentric[0] * mesh.positions[t[0]] + point.barycentric[1] * mesh.positions[t[1]] +
           point.barycentric[2] * mesh.positions[t[2]];
}

SphereLocator::SphereLocator(std::vector<Triangle> faces, std::vector<Vec3> position)
    : faces_(std::move(faces)), position_(std::move(position)),
      he_(faces_, static_cast<int>(position_.size()))
{
}

Result<SphereLocator> SphereLocator::of(const std::vector<Triangle>& faces, const std::vector<Vec3>& position)
{
    if (const auto objection = objectionToTriangles(Mesh{position, faces}, "the sphere")) return *objection;
    if (const int flipped = flippedOnSphere(faces, position); flipped > 0)
        return Error{ErrorKind::FlippedTriangle,
                     std::to_string(flipped) + " triangles on the sphere are flipped"};
    SphereLocator locator(faces, position);
    for (int h = 0; h < locator.he_.count(); ++h)
        if (locator.he_.onBoundary(h))
            return Error{ErrorKind::BadArgument, "the surface on the sphere is not closed"};
    return locator;
}

// Where two edges lead on, chance decides: a walk that always took the first could go round in circles.
SurfacePoint SphereLocator::locate(const Vec3& direction, int near) const
{
    const Vec3 d = direction.normalized();
    const auto holds = [&](int f) {
        for (int k = 0; k < 3; ++k)
            if (sphereOrientation(position_[faces_[f][k]], position_[faces_[f][(k + 1) % 3]], d) < 0)
                return false;
        return true;
    };
    int f = near >= 0 && near < static_cast<int>(faces_.size()) ? near : 0;
    uint32_t random = 1;
    bool found = false;
    for (size_t step = 0; step < 4 * faces_.size() && !found; ++step) {
        random = random * 1664525u + 1013904223u;
        const int first = static_cast<int>((random >> 16) % 3);
        found = true;
        for (int i = 0; i < 3 && found; ++i) {
            const int k = (first + i) % 3;
            if (sphereOrientation(position_[faces_[f][k]], position_[faces_[f][(k + 1) % 3]], d) >= 0)
                continue;
            f = Halfedges::face(he_.twin(3 * f + k));
            found = false;
        }
    }
    for (int g = 0; g < static_cast<int>(faces_.size()) && !found; ++g)
        if (holds(g)) f = g, found = true;
    const Vec3 &a = position_[faces_[f][0]], &b = position_[faces_[f][1]], &c = position_[faces_[f][2]];
    Vec3 weight(determinant(d, b, c), determinant(a, d, c), determinant(a, b, d));
    weight = weight.cwiseMax(0.0); // rounding
    const double sum = weight.sum();
    return {f, sum > 0 ? Vec3(weight / sum) : Vec3(Vec3::Constant(1.0 / 3))};
}

Result<std::vector<SurfacePoint>> mapThroughSphere(const std::vector<Vec3>& points, const Moebius& between,
                                                   const Mesh& to, const SphereMap& toSphere)
{
    const Result<SphereLocator> locator = SphereLocator::of(to.faces, toSphere.position);
    if (!locator) return locator.error();
    std::vector<SurfacePoint> found;
    for (const Vec3& p : points)
        found.push_back(locator->locate(between(p), found.empty() ? 0 : found.back().face));
    return found;
}

} // namespace gimg

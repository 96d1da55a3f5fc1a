#include "gimg/mean_value.h"

#include "convex_combination.h"

#include <algorithm>
#include <cmath>

namespace gimg {
namespace {

// tan(angle / 2) at p between the directions to a and b; bounded where the triangle is degenerate.
double halfAngleTangent(const Vec3& p, const Vec3& a, const Vec3& b)
{
    constexpr double kLargest = 1e4;
    const Vec3 u = a - p, v = b - p;
    const double lengths = u.norm() * v.norm();
    const double sine = u.cross(v).norm(), cosine = u.dot(v);
    // (1 - cos) / sin, and for small angles sin / (1 + cos).
    const double tangent = cosine > 0 ? sine / (lengths + cosine) : (lengths - cosine) / sine;
    return std::isfinite(tangent) ? std::clamp(tangent, 1.0 / kLargest, kLargest) : kLargest;
}

} // namespace

Status meanValueMap(const Mesh& mesh, const std::vector<bool>& fixed, std::vector<Vec2>& position)
{
    const double shortest = 1e-7 * boundingBoxDiagonal(mesh);
    std::vector<MeanWeight> weights;
    for (const Triangle& f : mesh.faces)
        for (int k = 0; k < 3; ++k) {
            const int v = f[k];
            if (fixed[v]) continue;
            const int ends[2] = {f[(k + 1) % 3], f[(k + 2) % 3]};
            const double tangent =
                halfAngleTangent(mesh.positions[v], mesh.positions[ends[0]], mesh.positions[ends[1]]);
            for (int w : ends) {
                const double length = (mesh.positions[w] - mesh.positions[v]).norm();
                weights.push_back({v, w, tangent / std::max(shortest, length)});
            }
        }
    return placeAtMeans(weights, Weights::General, fixed, position);
}

} // namespace gimg

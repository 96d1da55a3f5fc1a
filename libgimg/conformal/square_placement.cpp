#include "gimg/conformal_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace gimg {
namespace {

// A part of the surface: where it is on the sphere, its area there, and its own.
struct Part
{
    Vec3 at;
    double onSphere, area;
};

// So many vertices, by their numbers, stand for all.
std::vector<Part> partsOf(const Mesh& mesh, const std::vector<Vec3>& position)
{
    constexpr size_t kMost = 4000;
    const std::vector<double> area = vertexMasses(mesh), onSphere = vertexMasses({position, mesh.faces});
    const size_t stride = std::max<size_t>(1, position.size() / kMost);
    std::vector<Part> parts;
    for (size_t v = 0; v < position.size(); v += stride)
        if (onSphere[v] > 0) parts.push_back({position[v], onSphere[v], area[v]});
    return parts;
}

// Mean over the area of the root of surface over square.
double meanSpacing(const std::vector<Part>& parts, const Moebius& map)
{
    double sum = 0, total = 0;
    for (const Part& part : parts) {
        // Areas grow by the square of the factor between the lengths of homogeneous coordinates.
        const Vec3& p = part.at;
        const bool upper = p.z() >= 0;
        const std::complex<double> first = upper ? std::complex<double>(p.x(), p.y()) : 1 - p.z(),
                                   second = upper ? 1 + p.z() : std::complex<double>(p.x(), -p.y());
        const double before = std::norm(first) + std::norm(second);
        const double after =
            std::norm(map.a() * first + map.b() * second) + std::norm(map.c() * first + map.d() * second);
        const double growth = before / after;
        const double inSquare = part.onSphere * growth * growth * squareDensity(map(p));
        sum += part.area * std::sqrt(part.area / inSquare);
        total += part.area;
    }
    return sum / total;
}

struct Placed
{
    double spacing;
    Moebius map;
};

// Along one direction after the other, with steps that shrink where none helps.
void descend(const std::vector<Part>& parts, Placed& best, double first, double last)
{
    for (double step = first; step > last;) {
        const double before = best.spacing;
        for (int k = 0; k < 6; ++k)
            for (double sign : {1.0, -1.0}) {
                const Vec3 axis = Vec3::Unit(k % 3);
                const Moebius move =
                    k < 3 ? Moebius::rotating(Eigen::AngleAxisd(sign * step, axis).toRotationMatrix())
                          : Moebius::centring(0.5 * sign * step * axis);
                const Moebius tried = move * best.map;
                const double spacing = meanSpacing(parts, tried);
                if (spacing < best.spacing) best = {spacing, tried};
            }
        if (!(best.spacing < before * (1 - 1e-3))) step *= 0.5;
    }
}

} // namespace

Moebius placementOnSquare(const Mesh& mesh, const std::vector<Vec3>& position)
{
    constexpr int kAxes = 24, kTurns = 8, kKept = 6; // the square's own symmetry is a quarter turn
    const std::vector<Part> parts = partsOf(mesh, position);
    std::vector<Placed> tried;
    for (int axis = 0; axis < kAxes; ++axis) {
        const double z = 1 - (2 * axis + 1.0) / kAxes, r = std::sqrt(1 - z * z),
                     turn = std::numbers::pi * (3 - std::sqrt(5.0)) * axis;
        const Eigen::Matrix3d tilt =
            Eigen::Quaterniond::FromTwoVectors(Vec3(r * std::cos(turn), r * std::sin(turn), z), Vec3::UnitZ())
                .toRotationMatrix();
        for (int k = 0; k < kTurns; ++k) {
            const double angle = std::numbers::pi / 2 * k / kTurns;
            const Moebius map =
                Moebius::rotating(Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix() * tilt);
            tried.push_back({meanSpacing(parts, map), map});
        }
    }
    std::stable_sort(tried.begin(), tried.end(),
                     [](const Placed& a, const Placed& b) { return a.spacing < b.spacing; });
    tried.resize(kKept);
    for (Placed& placed : tried) descend(parts, placed, 0.2, 0.02);
    Placed& best = *std::min_element(tried.begin(), tried.end(),
                                     [](const Placed& a, const Placed& b) { return a.spacing < b.spacing; });
    descend(parts, best, 0.02, 1e-4);
    return best.map;
}

} // namespace gimg

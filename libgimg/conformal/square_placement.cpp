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

std::vector<Part> allParts(const Mesh& mesh, const std::vector<Vec3>& position)
{
    const std::vector<double> area = vertexMasses(mesh), onSphere = vertexMasses({position, mesh.faces});
    std::vector<Part> parts;
    for (size_t v = 0; v < position.size(); ++v)
        if (onSphere[v] > 0) parts.push_back({position[v], onSphere[v], area[v]});
    return parts;
}

// The ends of limbs: where the sphere has least room for the surface, not next to each other.
std::vector<Part> tipsOf(const std::vector<Part>& parts)
{
    constexpr int kMost = 6;
    constexpr double kApart = 0.02;
    std::vector<Part> tips;
    for (int k = 0; k < kMost; ++k) {
        const Part* best = nullptr;
        for (const Part& part : parts) {
            if (best != nullptr && part.area * best->onSphere <= best->area * part.onSphere) continue;
            const bool taken = std::any_of(tips.begin(), tips.end(), [&](const Part& tip) {
                return (tip.at - part.at).squaredNorm() < kApart * kApart;
            });
            if (!taken) best = &part;
        }
        if (best == nullptr) break;
        tips.push_back(*best);
    }
    return tips;
}

// Every so many of them stand for all.
std::vector<Part> thinned(const std::vector<Part>& parts)
{
    constexpr size_t kMost = 4000;
    std::vector<Part> some;
    for (size_t i = 0; i < parts.size(); i += 1 + parts.size() / kMost) some.push_back(parts[i]);
    return some;
}

// Mean over the surface's area of surface over square: 1 / stretchEfficiency() up to a factor.
double meanStretch(const std::vector<Part>& parts, const Moebius& map)
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
        sum += part.area * part.area / inSquare;
        total += part.area;
    }
    return sum / total;
}

struct Placed
{
    double stretch;
    Moebius map;
};

// Along one direction after the other, with steps that shrink where none helps.
void descend(const std::vector<Part>& parts, Placed& best, double first, double last)
{
    for (double step = first; step > last;) {
        const double before = best.stretch;
        for (int k = 0; k < 6; ++k)
            for (double sign : {1.0, -1.0}) {
                const Vec3 axis = Vec3::Unit(k % 3);
                const Moebius move =
                    k < 3 ? Moebius::rotating(Eigen::AngleAxisd(sign * step, axis).toRotationMatrix())
                          : Moebius::centring(0.5 * sign * step * axis);
                const Moebius tried = move * best.map;
                const double stretch = meanStretch(parts, tried);
                if (stretch < best.stretch) best = {stretch, tried};
            }
        if (!(best.stretch < before * (1 - 1e-3))) step *= 0.5;
    }
}

// Rotations, and maps that take three tips to three middles of sides.
std::vector<Moebius> startsFor(const std::vector<Part>& tips)
{
    constexpr int kAxes = 24, kTurns = 8; // the square's own symmetry is a quarter turn
    std::vector<Moebius> starts;
    for (int axis = 0; axis < kAxes; ++axis) {
        const double z = 1 - (2 * axis + 1.0) / kAxes, r = std::sqrt(1 - z * z),
                     turn = std::numbers::pi * (3 - std::sqrt(5.0)) * axis;
        const Eigen::Matrix3d tilt =
            Eigen::Quaterniond::FromTwoVectors(Vec3(r * std::cos(turn), r * std::sin(turn), z), Vec3::UnitZ())
                .toRotationMatrix();
        for (int k = 0; k < kTurns; ++k)
            starts.push_back(Moebius::rotating(
                Eigen::AngleAxisd(std::numbers::pi / 2 * k / kTurns, Vec3::UnitZ()).toRotationMatrix() *
                tilt));
    }
    for (const Part& first : tips)
        for (const Part& second : tips)
            for (const Part& third : tips) {
                const Result<Moebius> map = Moebius::byThreePoints(
                    {first.at, second.at, third.at}, {Vec3::UnitX(), Vec3::UnitY(), -Vec3::UnitX()});
                if (map) starts.push_back(*map);
            }
    return starts;
}

} // namespace

Moebius placementOnSquare(const Mesh& mesh, const std::vector<Vec3>& position)
{
    constexpr int kKept = 6;
    constexpr double kFirst = 0.2, kCoarse = 0.01, kFine = 1e-7; // steps, in radians
    const std::vector<Part> all = allParts(mesh, position), tips = tipsOf(all);
    std::vector<Part> parts = thinned(all);
    parts.insert(parts.end(), tips.begin(), tips.end());
    std::vector<Placed> tried;
    for (const Moebius& map : startsFor(tips)) tried.push_back({meanStretch(parts, map), map});
    std::stable_sort(tried.begin(), tried.end(),
                     [](const Placed& a, const Placed& b) { return a.stretch < b.stretch; });
    tried.resize(kKept);
    for (Placed& placed : tried) descend(parts, placed, kFirst, kCoarse);
    Placed& best = *std::min_element(tried.begin(), tried.end(),
                                     [](const Placed& a, const Placed& b) { return a.stretch < b.stretch; });
    descend(parts, best, kCoarse, kFine);
    return best.map;
}

} // namespace gimg

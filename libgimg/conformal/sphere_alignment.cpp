#include "gimg/sphere_correspondence.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace gimg {
namespace {

// Evenly spread over the sphere, on a spiral.
std::vector<Vec3> spiral(int count)
{
    const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) {
        const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z);
        points.push_back({r * std::cos(golden * i), r * std::sin(golden * i), z});
    }
    return points;
}

// The logarithm of area on the sphere over area on the surface, per vertex.
std::vector<double> logEnlargement(const Mesh& mesh, const std::vector<Vec3>& position)
{
    const std::vector<double> before = vertexMasses(mesh), after = vertexMasses({position, mesh.faces});
    std::vector<double> logs;
    for (size_t v = 0; v < before.size(); ++v) logs.push_back(std::log(after[v] / before[v]));
    return logs;
}

// A function on the sphere, sampled by longitude and latitude.
class Panorama
{
public:
    Panorama(const SphereLocator& locator, const std::vector<Triangle>& faces,
             const std::vector<double>& value)
    {
        int near = 0;
        for (int row = 0; row < kRows; ++row)
            for (int column = 0; column < kColumns; ++column) {
                const double latitude = std::numbers::pi * (0.5 - (row + 0.5) / kRows),
                             longitude = 2 * std::numbers::pi * column / kColumns;
                const SurfacePoint at =
                    locator.locate({std::cos(latitude) * std::cos(longitude),
                                    std::cos(latitude) * std::sin(longitude), std::sin(latitude)},
                                   near);
                near = at.face;
                double sum = 0;
                for (int k = 0; k < 3; ++k) sum += at.barycentric[k] * value[faces[at.face][k]];
                samples_.push_back(sum);
            }
    }
    double at(const Vec3& p) const
    {
        const double y =
            std::clamp((0.5 - std::asin(std::clamp(p.z(), -1.0, 1.0)) / std::numbers::pi) * kRows - 0.5, 0.0,
                       kRows - 1.0);
        double x = std::atan2(p.y(), p.x()) / (2 * std::numbers::pi) * kColumns;
        if (x < 0) x += kColumns;
        const int row = std::min(static_cast<int>(y), kRows - 2), column = static_cast<int>(x);
        const double u = x - column, v = y - row;
        const auto sample = [&](int r, int c) { return samples_[r * kColumns + c % kColumns]; };
        return (1 - v) * ((1 - u) * sample(row, column) + u * sample(row, column + 1)) +
               v * ((1 - u) * sample(row + 1, column) + u * sample(row + 1, column + 1));
    }

private:
    static constexpr int kRows = 128, kColumns = 256;
    std::vector<double> samples_;
};

double correlationOf(const std::vector<Vec3>& points, const std::vector<double>& values,
                     const Panorama& other, const Eigen::Matrix3d& rotation)
{
    const auto count = static_cast<double>(points.size());
    double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    for (size_t i = 0; i < points.size(); ++i) {
        const double x = values[i], y = other.at(rotation * points[i]);
        a += x, b += y, aa += x * x, bb += y * y, ab += x * y;
    }
    const double spread = std::sqrt(std::max(0.0, aa - a * a / count) * std::max(0.0, bb - b * b / count));
    return spread > 0 ? (ab - a * b / count) / spread : 0;
}

struct Candidate
{
    double correlation;
    Eigen::Matrix3d rotation;
};

} // namespace

Result<Moebius> alignLandmarks(const SphereMap& from, const SphereMap& to,
                               const std::vector<std::pair<int, int>>& pairs)
{
    std::vector<Vec3> first, second;
    for (const auto& [a, b] : pairs) {
        if (a < 0 || b < 0 || a >= static_cast<int>(from.position.size()) ||
            b >= static_cast<int>(to.position.size()))
            return Error{ErrorKind::BadArgument,
                         "there is no landmark " + std::to_string(a) + " - " + std::to_string(b)};
        first.push_back(from.position[a]);
        second.push_back(to.position[b]);
    }
    if (pairs.size() == 3)
        return Moebius::byThreePoints({first[0], first[1], first[2]}, {second[0], second[1], second[2]});
    return bestMoebius(first, second);
}

Result<Eigen::Matrix3d> alignRotation(const Mesh& from, const SphereMap& fromSphere, const Mesh& to,
                                      const SphereMap& toSphere, double* correlation)
{
    constexpr int kPoints = 1500, kAxes = 300, kTurns = 30, kRefined = 8;
    constexpr double kCoarse = 0.1, kFine = 1e-5; // radians
    const Result<SphereLocator> here = SphereLocator::of(from.faces, fromSphere.position),
                                there = SphereLocator::of(to.faces, toSphere.position);
    if (!here) return here.error();
    if (!there) return there.error();
    const Panorama mine(*here, from.faces, logEnlargement(from, fromSphere.position)),
        other(*there, to.faces, logEnlargement(to, toSphere.position));
    const std::vector<Vec3> points = spiral(kPoints);
    std::vector<double> values;
    for (const Vec3& p : points) values.push_back(mine.at(p));

    std::vector<Candidate> candidates;
    for (const Vec3& axis : spiral(kAxes)) {
        const Eigen::Matrix3d tilt =
            Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), axis).toRotationMatrix();
        for (int turn = 0; turn < kTurns; ++turn) {
            const Eigen::Matrix3d rotation =
                tilt *
                Eigen::AngleAxisd(2 * std::numbers::pi * turn / kTurns, Vec3::UnitZ()).toRotationMatrix();
            candidates.push_back({correlationOf(points, values, other, rotation), rotation});
        }
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.correlation > b.correlation; });
    candidates.resize(kRefined);
    for (Candidate& best : candidates)
        for (double step = kCoarse; step > kFine;) {
            const double before = best.correlation;
            for (int k = 0; k < 3; ++k)
                for (double sign : {1.0, -1.0}) {
                    const Eigen::Matrix3d tried =
                        Eigen::AngleAxisd(sign * step, Vec3::Unit(k)).toRotationMatrix() * best.rotation;
                    const double reached = correlationOf(points, values, other, tried);
                    if (reached > best.correlation) best = {reached, tried};
                }
            if (best.correlation == before) step *= 0.5;
        }
    const auto best =
        std::max_element(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
            return a.correlation < b.correlation;
        });
    if (correlation != nullptr) *correlation = best->correlation;
    return best->rotation;
}

std::array<PlanarChart, 2> stereographicCharts(const std::vector<Triangle>& faces,
                                               const std::vector<Vec3>& position)
{
    std::array<PlanarChart, 2> charts;
    for (size_t f = 0; f < faces.size(); ++f) {
        const bool upper =
            position[faces[f][0]].z() + position[faces[f][1]].z() + position[faces[f][2]].z() >= 0;
        PlanarChart& chart = charts[upper ? 0 : 1];
        std::array<Vec2, 3> corners;
        for (int k = 0; k < 3; ++k) {
            // A half turn about x takes the lower half up.
            const Vec3& p = position[faces[f][k]];
            const std::complex<double> z = stereographic(upper ? p : Vec3(p.x(), -p.y(), -p.z()));
            corners[k] = {z.real(), z.imag()};
        }
        chart.faces.push_back(static_cast<int>(f));
        chart.corners.push_back(corners);
    }
    return charts;
}

} // namespace gimg

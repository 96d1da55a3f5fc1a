#include "gimg/sphere_map.h"

#include "conformal/dirichlet_solver.h"
#include "conformal/punctured_plane.h"
#include "conformal/sphere_check.h"
#include "conformal/sphere_relaxation.h"
#include "gimg/intrinsic.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace gimg {
namespace {

using Complex = std::complex<double>;
using SparseMatrix = Eigen::SparseMatrix<double>;

constexpr double kCentred = 1e-9; // a mass centre nearer to the sphere's is left there

// Limbs shrink by exp(-length / radius), below what coordinates of doubles can tell apart. Where the scale u
// falls below `from`, weights times exp(steepness (u - from)) make it fall more slowly, `slowed` times: along
// a tube of radius 1, f'' + steepness f' = f has solutions that decay by slowed = 1 / (slowed + steepness).
struct Inflation
{
    double from = 0;
    double slowed = 1;
    double steepness() const { return 1 / slowed - slowed; }
};

// @param logScale  of the sphere over the surface, up to a constant
Inflation neededInflation(Eigen::VectorXd& logScale, const Eigen::VectorXd& vertexArea)
{
    constexpr double kSmallest = 3e-14; // triangle on the sphere, as the root of its area
    constexpr double kShallowest = -12; // where conformality may be given up
    constexpr double kSlowest = 0.3;    // preferred
    constexpr double kSteepest = 600;   // exponent that weights may fall to
    // The sphere has an area of 4 pi; the surface is taken to have that, too.
    const double highest = logScale.maxCoeff(), area = vertexArea.sum();
    logScale.array() -=
        highest + 0.5 * std::log(vertexArea.dot((2 * (logScale.array() - highest)).exp().matrix()) / area);
    double smallest = 0;
    for (int v = 0; v < logScale.size(); ++v)
        smallest =
            std::min(smallest, logScale[v] + 0.5 * std::log(vertexArea[v] * 4 * std::numbers::pi / area));
    const double missing = std::log(kSmallest) - smallest, deepest = logScale.minCoeff();
    if (missing <= 0) return {};
    const double from = std::min(kShallowest, deepest + missing / (1 - kSlowest)), depth = from - deepest;
    if (!(depth > 0)) return {};
    return {from, std::max({1 - missing / depth, depth / kSteepest, 0.01})};
}

// The cotangent Laplacian, with smaller weights in limbs that need it.
SparseMatrix inflatedLaplacian(const SparseMatrix& laplacian, const Eigen::VectorXd& logScale,
                               const Inflation& inflation)
{
    SparseMatrix out = laplacian;
    if (inflation.slowed >= 1) return out;
    for (int column = 0; column < out.outerSize(); ++column) {
        double sum = 0;
        double* diagonal = nullptr;
        for (SparseMatrix::InnerIterator entry(out, column); entry; ++entry) {
            if (entry.row() == column) {
                diagonal = &entry.valueRef();
                continue;
            }
            const double depth = 0.5 * (logScale[entry.row()] + logScale[column]) - inflation.from;
            if (depth < 0) entry.valueRef() *= std::exp(inflation.steepness() * depth);
            sum += entry.value();
        }
        if (diagonal != nullptr) *diagonal = -sum;
    }
    return out;
}

double weightedMedian(std::vector<std::pair<double, double>> valueAndWeight)
{
    std::sort(valueAndWeight.begin(), valueAndWeight.end());
    double total = 0, sum = 0;
    for (const auto& entry : valueAndWeight) total += entry.second;
    for (const auto& [value, weight] : valueAndWeight)
        if ((sum += weight) >= total / 2) return value;
    return 0;
}

// Half of the surface lies within the circle that becomes the equator.
struct Equator
{
    Complex centre;
    double radius = 1;

    Equator(const std::vector<Complex>& plane, const std::vector<double>& mass)
    {
        const auto median = [&](auto measured) {
            std::vector<std::pair<double, double>> values;
            for (size_t v = 0; v < plane.size(); ++v) values.push_back({measured(plane[v]), mass[v]});
            return weightedMedian(std::move(values));
        };
        centre = {median([](Complex z) { return z.real(); }), median([](Complex z) { return z.imag(); })};
        radius = median([&](Complex z) { return std::abs(z - centre); });
    }
    Complex operator()(const Complex& z) const { return (z - centre) / radius; }
};

// Harmonic in the stereographic plane over the cap around `pole`, with what lies beyond it held.
Status makeCapHarmonic(const SparseMatrix& laplacian, const Vec3& pole, std::vector<Vec3>& position)
{
    constexpr double kCap = -0.6; // height down to which it reaches
    const Eigen::Matrix3d upright =
        Eigen::Quaterniond::FromTwoVectors(pole, Vec3::UnitZ()).toRotationMatrix();
    std::vector<bool> fixed;
    Eigen::MatrixXd plane(position.size(), 2);
    for (size_t v = 0; v < position.size(); ++v) {
        const Vec3 p = upright * position[v];
        const Complex z = stereographic(p);
        plane.row(static_cast<Eigen::Index>(v)) << z.real(), z.imag();
        fixed.push_back(p.z() < kCap);
    }
    if (std::count(fixed.begin(), fixed.end(), true) < 3) return Done{};
    const DirichletSolver solver(laplacian, fixed);
    if (!solver.isSolvable())
        return Error{ErrorKind::SolverFailure, "the linear system of the map could not be solved"};
    solver.solve(plane);
    for (size_t v = 0; v < position.size(); ++v) {
        const auto row = static_cast<Eigen::Index>(v);
        if (!fixed[v]) position[v] = upright.transpose() * ontoSphere({plane(row, 0), plane(row, 1)});
    }
    return Done{};
}

class SphereMapper
{
public:
    SphereMapper(const Mesh& mesh, const SphereMapOptions& options, const Progress& progress)
        : mesh_(mesh), options_(options), progress_(progress), mass_(vertexMasses(mesh))
    {
    }

    Result<SphereMap> run()
    {
        if (const Status started = start(); !started) return started.error();
        tell(0.6);
        map_.flippedBefore = flippedOnSphere(mesh_.faces, map_.position);
        SphereRelaxation relaxation(mesh_, map_.position);
        relaxation.untangle();
        relaxation.smooth(options_.smoothing);
        tell(0.9);
        // Moving all points rounds them anew, which may flip the smallest triangles.
        constexpr int kTries = 5;
        bool clean = false;
        for (int round = 0; round < kTries && !clean; ++round) {
            if (const Status placed = place(); !placed) return placed.error();
            clean = relaxation.untangle() &&
                    (!options_.centre || massCentre(map_.position, mass_).norm() < kCentred);
        }
        map_.untangled = relaxation.movedByUntangling();
        map_.massCentre = massCentre(map_.position, mass_);
        if (const int flipped = flippedOnSphere(mesh_.faces, map_.position); flipped > 0)
            return Error{ErrorKind::FlippedTriangle, std::to_string(flipped) + " of " +
                                                         std::to_string(mesh_.faceCount()) +
                                                         " triangles on the sphere could not be untangled"};
        if (!clean)
            return Error{ErrorKind::TargetUnreachable,
                         "no map was found that has its mass centre in the sphere's and no triangle flipped"};
        map_.quality = conformality(mesh_, map_.position);
        tell(1);
        return std::move(map_);
    }

private:
    void tell(double fraction) const
    {
        if (progress_) progress_(fraction);
    }

    Status start()
    {
        Result<IntrinsicTriangulation> surface = IntrinsicTriangulation::of(mesh_);
        if (!surface) return surface.error();
        surface->makeDelaunay();
        tell(0.1);
        const SparseMatrix cotangents = surface->cotangentLaplacian();
        const Result<int> outside = triangleForOutside(*surface, cotangents);
        if (!outside) return outside.error();
        tell(0.2);
        Result<PuncturedPlane> plane = mapPunctured(*surface, cotangents, *outside);
        if (!plane) return plane.error();
        Eigen::VectorXd logScale = plane->logScale;
        const Equator equator(plane->z, mass_);
        for (int v = 0; v < logScale.size(); ++v) logScale[v] -= std::log1p(std::norm(equator(plane->z[v])));
        const Inflation inflation = neededInflation(logScale, surface->vertexAreas());
        const SparseMatrix laplacian = inflatedLaplacian(cotangents, logScale, inflation);
        if (inflation.slowed < 1) {
            map_.inflated = static_cast<int>((logScale.array() < inflation.from).count());
            plane = mapPunctured(*surface, laplacian, *outside);
            if (!plane) return plane.error();
        }
        const Equator settled(plane->z, mass_);
        for (const Complex& z : plane->z) map_.position.push_back(ontoSphere(settled(z)));
        if (const Status placed = centre(); !placed) return placed.error();
        tell(0.4);
        const Vec3 pole = map_.position[surface->tail(*outside)];
        for (const Vec3& side : {pole, Vec3(-pole)})
            if (const Status solved = improve(laplacian, side); !solved) return solved.error();
        return Done{};
    }

    // Around the triangle that was outside, and around its antipode, where doubles were spread thin. A
    // surface of few vertices may have a triangle that reaches across the cap, and is left as it is.
    Status improve(const SparseMatrix& laplacian, const Vec3& pole)
    {
        std::vector<Vec3> tried = map_.position;
        if (const Status solved = makeCapHarmonic(laplacian, pole, tried); !solved) return solved.error();
        const int before = flippedOnSphere(mesh_.faces, map_.position),
                  after = flippedOnSphere(mesh_.faces, tried);
        if (after <= before + mesh_.faceCount() / 1000 &&
            conformality(mesh_, tried).medianAngleError <=
                conformality(mesh_, map_.position).medianAngleError)
            map_.position = std::move(tried);
        return Done{};
    }

    Status centre()
    {
        const Result<Moebius> centred = centringMass(map_.position, mass_);
        if (!centred) return centred.error();
        for (Vec3& p : map_.position) p = (*centred)(p);
        return Done{};
    }

    // Centred, and turned to where it is nearest to the surface.
    Status place()
    {
        if (options_.centre)
            if (const Status centred = centre(); !centred) return centred.error();
        Vec3 middle = Vec3::Zero();
        double total = 0;
        for (size_t v = 0; v < mass_.size(); ++v) {
            middle += mass_[v] * mesh_.positions[v];
            total += mass_[v];
        }
        middle /= total;
        std::vector<Vec3> pulls;
        for (size_t v = 0; v < mass_.size(); ++v) pulls.push_back(mass_[v] * (mesh_.positions[v] - middle));
        const Eigen::Matrix3d rotation = bestRotation(map_.position, pulls);
        for (Vec3& p : map_.position) p = (rotation * p).normalized();
        return Done{};
    }

    const Mesh& mesh_;
    const SphereMapOptions& options_;
    const Progress& progress_;
    const std::vector<double> mass_;
    SphereMap map_;
};

} // namespace

std::vector<double> vertexMasses(const Mesh& mesh)
{
    std::vector<double> mass(mesh.positions.size(), 0);
    for (const Triangle& t : mesh.faces) {
        const Vec3& p = mesh.positions[t[0]];
        const double area = 0.5 * (mesh.positions[t[1]] - p).cross(mesh.positions[t[2]] - p).norm();
        for (int v : t) mass[v] += area / 3;
    }
    return mass;
}

Result<SphereMap> sphereMap(const Mesh& mesh, const SphereMapOptions& options, const Progress& progress)
{
    if (const Status sphere = checkSphere(mesh); !sphere) return sphere.error();
    return SphereMapper(mesh, options, progress).run();
}

} // namespace gimg

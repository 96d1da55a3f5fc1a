#include "conformal/sphere_relaxation.h"

#include "gimg/sphere_map.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>

namespace gimg {

// One vertex at p on the sphere among its neighbours.
struct SphereRelaxation::Star
{
    struct Corner // of a face at the vertex: the other two corners, counter-clockwise
    {
        Vec3 right, left;
        double cotRight, cotLeft, constant; // cotangents there; cot at the vertex * |left - right|^2
        double weight;
    };
    std::vector<Corner> corners;
    double tolerance = 0; // as an area

    // Energy, and derivatives by displacements along the axes in units of `scale`.
    double energy(const Vec3& p) const
    {
        double sum = 0;
        for (const Corner& c : corners) {
            const double a = counted(doubleArea(c, p));
            if (!(a > 0)) return std::numeric_limits<double>::infinity();
            sum += c.weight * dirichlet(c, p) / a;
        }
        return sum;
    }
    void derivatives(const Vec3& p, const Eigen::Matrix<double, 3, 2>& axes, double scale, Vec2& gradient,
                     Eigen::Matrix2d& hessian) const
    {
        gradient.setZero();
        hessian.setZero();
        double outward = 0; // derivative along p, for the curvature of the sphere
        for (const Corner& c : corners) {
            const double area = doubleArea(c, p), a = counted(area), d = dirichlet(c, p);
            const double root = std::hypot(area, tolerance);
            const double slope = tolerance > 0 ? a / root : 1;
            const double bend = tolerance > 0 ? 0.5 * tolerance * tolerance / (root * root * root) : 0;
            const Vec3 dGradient = 0.5 * (c.cotLeft * (p - c.right) + c.cotRight * (p - c.left));
            const Vec3 aGradient = c.right.cross(c.left - c.right);
            const Vec2 dd = scale * axes.transpose() * dGradient, da = scale * axes.transpose() * aGradient;
            const double byArea = -d / (a * a); // of the quotient, by the counted area
            gradient += c.weight * (dd / a + byArea * slope * da);
            hessian += c.weight * (0.5 * (c.cotLeft + c.cotRight) * scale * scale / a *
                                       Eigen::Matrix2d::Identity() -
                                   slope / (a * a) * (dd * da.transpose() + da * dd.transpose()) +
                                   (2 * d / (a * a * a) * slope * slope + byArea * bend) * da * da.transpose());
            outward += c.weight * (dGradient.dot(p) / a + byArea * slope * aGradient.dot(p));
        }
        hessian -= scale * scale * outward * Eigen::Matrix2d::Identity();
    }

private:
    static double doubleArea(const Corner& c, const Vec3& p)
    {
        return p.dot((c.right - p).cross(c.left - p));
    }
    double counted(double area) const
    {
        if (tolerance == 0) return area;
        const double root = std::hypot(area, tolerance);
        // The positive root, without cancellation where the area is negative.
        return area > 0 ? 0.5 * (area + root) : 0.5 * tolerance * tolerance / (root - area);
    }
    // Half of what makes its quotient by the double area 1 for similar triangles.
    static double dirichlet(const Corner& c, const Vec3& p)
    {
        return 0.25 * (c.cotLeft * (p - c.right).squaredNorm() + c.cotRight * (p - c.left).squaredNorm() +
                       c.constant);
    }
};

SphereRelaxation::SphereRelaxation(const Mesh& mesh, std::vector<Vec3>& position)
    : mesh_(mesh), he_(mesh.faces, mesh.vertexCount()), position_(position)
{
    for (const Triangle& t : mesh.faces) {
        const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
        const double doubled = (b - a).cross(c - a).norm();
        cotangent_.push_back({(b - a).dot(c - a) / doubled, (c - b).dot(a - b) / doubled,
                              (a - c).dot(b - c) / doubled});
        area_.push_back(0.5 * doubled);
    }
}

bool SphereRelaxation::isFlipped(int f) const
{
    const Triangle& t = mesh_.faces[f];
    return sphereOrientation(position_[t[0]], position_[t[1]], position_[t[2]]) <= 0;
}

bool SphereRelaxation::starIsValid(int v) const
{
    int h = he_.outgoing(v);
    do {
        if (isFlipped(Halfedges::face(h))) return false;
        h = he_.rotateCcw(h);
    } while (h != he_.outgoing(v));
    return true;
}

bool SphereRelaxation::relax(int v, double tolerance)
{
    constexpr int kIterations = 3;
    thread_local Star star;
    star.corners.clear();
    double weights = 0, areas = 0, squares = 0;
    int h = he_.outgoing(v);
    do {
        const int f = Halfedges::face(h), k = h % 3, right = (k + 1) % 3, left = (k + 2) % 3;
        const Triangle& t = mesh_.faces[f];
        const Vec3 &r = position_[t[right]], &l = position_[t[left]];
        star.corners.push_back({r, l, cotangent_[f][right], cotangent_[f][left],
                                cotangent_[f][k] * (l - r).squaredNorm(), area_[f]});
        weights += area_[f];
        areas += std::abs(position_[v].dot((r - position_[v]).cross(l - position_[v])));
        squares += (l - r).squaredNorm();
        h = he_.rotateCcw(h);
    } while (h != he_.outgoing(v));
    const auto count = static_cast<double>(star.corners.size());
    for (Star::Corner& c : star.corners) c.weight /= weights;
    star.tolerance = tolerance * std::max(areas, 0.1 * squares) / count;
    const double scale = std::sqrt(squares / count);

    const Vec3 before = position_[v];
    Vec3 p = before;
    double now = star.energy(p);
    for (int iteration = 0; iteration < kIterations; ++iteration) {
        // Any two axes perpendicular to p.
        Eigen::Matrix<double, 3, 2> axes;
        axes.col(0) = p.unitOrthogonal();
        axes.col(1) = p.cross(axes.col(0));
        Vec2 gradient;
        Eigen::Matrix2d hessian;
        star.derivatives(p, axes, scale, gradient, hessian);
        // Positive definite by the absolute values of its eigenvalues.
        const double half = 0.5 * (hessian(0, 0) + hessian(1, 1));
        const double radius = std::hypot(0.5 * (hessian(0, 0) - hessian(1, 1)), hessian(0, 1));
        if (half - radius < 1e-3 * (half + radius))
            hessian += (std::max(0.0, radius - half) + 0.1 * radius) * Eigen::Matrix2d::Identity();
        const Vec2 step = -hessian.inverse() * gradient;
        if (!step.allFinite()) break;
        bool lowered = false;
        Vec3 tried;
        double after = now;
        for (double part = std::min(1.0, 1 / step.norm()); part > 1e-4 && !lowered; part *= 0.5) {
            tried = (p + axes * (part * scale * step)).normalized();
            after = star.energy(tried);
            lowered = after < now;
        }
        if (!lowered) break;
        const bool settled = after > now * (1 - 1e-4);
        p = tried;
        now = after;
        if (settled) break;
    }
    if (p == before) return false;
    position_[v] = p;
    if (tolerance == 0 && !starIsValid(v)) {
        position_[v] = before;
        return false;
    }
    return true;
}

std::vector<int> SphereRelaxation::flippedFaces() const
{
    std::vector<int> flipped;
    for (int f = 0; f < mesh_.faceCount(); ++f)
        if (isFlipped(f)) flipped.push_back(f);
    return flipped;
}

void SphereRelaxation::smooth(int sweeps)
{
    for (int sweep = 0; sweep < sweeps; ++sweep)
        for (int v = 0; v < mesh_.vertexCount(); ++v)
            if (starIsValid(v)) relax(v, 0);
}

bool SphereRelaxation::untangle()
{
    constexpr int kRounds = 12, kSweeps = 12, kFirstRings = 1;
    std::vector<int> flipped = flippedFaces();
    std::vector<bool> hasMoved(static_cast<size_t>(mesh_.vertexCount()), false);
    for (int round = 0; round < kRounds && !flipped.empty(); ++round) {
        // Those at flipped triangles, and as many rings around them as rounds were in vain.
        std::vector<bool> isFree(static_cast<size_t>(mesh_.vertexCount()), false);
        for (int f : flipped)
            for (int v : mesh_.faces[f]) isFree[v] = true;
        for (int ring = 0; ring < kFirstRings + round / 2; ++ring) {
            const std::vector<bool> inner = isFree;
            for (const Triangle& t : mesh_.faces)
                if (inner[t[0]] || inner[t[1]] || inner[t[2]])
                    for (int v : t) isFree[v] = true;
        }
        double tolerance = 1;
        for (int sweep = 0; sweep < kSweeps; ++sweep, tolerance *= 0.6)
            for (int v = 0; v < mesh_.vertexCount(); ++v)
                if (isFree[v] && relax(v, starIsValid(v) ? 0 : tolerance)) hasMoved[v] = true;
        flipped = flippedFaces();
    }
    moved_ = static_cast<int>(std::count(hasMoved.begin(), hasMoved.end(), true));
    return flipped.empty();
}

} // namespace gimg

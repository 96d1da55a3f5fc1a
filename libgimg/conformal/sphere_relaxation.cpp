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
            hessian +=
                c.weight * (0.5 * (c.cotLeft + c.cotRight) * scale * scale / a * Eigen::Matrix2d::Identity() -
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
    : mesh_(mesh), he_(mesh.faces, mesh.vertexCount()), position_(position),
      hasMoved_(mesh.positions.size(), false)
{
    for (const Triangle& t : mesh.faces) {
        const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
        const double doubled = (b - a).cross(c - a).norm();
        cotangent_.push_back(
            {(b - a).dot(c - a) / doubled, (c - b).dot(a - b) / doubled, (a - c).dot(b - c) / doubled});
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
    Star star;
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

// To the middle of where no triangle around it is flipped: the kernel of its neighbours' polygon, in the
// gnomonic plane, where great circles are straight.
bool SphereRelaxation::moveToKernel(int v)
{
    const Vec3 before = position_[v];
    Eigen::Matrix<double, 3, 2> axes;
    axes.col(0) = before.unitOrthogonal();
    axes.col(1) = before.cross(axes.col(0));
    std::vector<Vec2> ring;
    int h = he_.outgoing(v);
    do {
        const Vec3& q = position_[he_.head(h)];
        if (!(q.dot(before) > 0)) return false;
        ring.push_back(axes.transpose() * (q - before) / q.dot(before));
        h = he_.rotateCcw(h);
    } while (h != he_.outgoing(v));
    Vec2 low = ring[0], high = ring[0];
    for (const Vec2& p : ring) low = low.cwiseMin(p), high = high.cwiseMax(p);
    std::vector<Vec2> kernel{low, {high.x(), low.y()}, high, {low.x(), high.y()}};
    for (size_t i = 0; i < ring.size(); ++i) {
        const Vec2 &from = ring[i], along = ring[(i + 1) % ring.size()] - from;
        const auto leftOf = [&](const Vec2& p) {
            return along.x() * (p.y() - from.y()) - along.y() * (p.x() - from.x());
        };
        std::vector<Vec2> kept;
        for (size_t k = 0; k < kernel.size(); ++k) {
            const Vec2 &p = kernel[k], &q = kernel[(k + 1) % kernel.size()];
            const double atP = leftOf(p), atQ = leftOf(q);
            if (atP >= 0) kept.push_back(p);
            if ((atP > 0 && atQ < 0) || (atP < 0 && atQ > 0)) kept.push_back(p + atP / (atP - atQ) * (q - p));
        }
        if (kept.size() < 3) return false;
        kernel = std::move(kept);
    }
    Vec2 middle = Vec2::Zero();
    for (const Vec2& corner : kernel) middle += corner / static_cast<double>(kernel.size());
    position_[v] = (before + axes * middle).normalized();
    if (starIsValid(v)) return true;
    position_[v] = before;
    return false;
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

// The corners of faces, and so many rings of vertices around them.
std::vector<int> SphereRelaxation::verticesAround(const std::vector<int>& faces, int rings) const
{
    std::vector<bool> isIn(mesh_.positions.size(), false);
    for (int f : faces)
        for (int v : mesh_.faces[f]) isIn[v] = true;
    for (int ring = 0; ring < rings; ++ring) {
        const std::vector<bool> inner = isIn;
        for (const Triangle& t : mesh_.faces)
            if (inner[t[0]] || inner[t[1]] || inner[t[2]])
                for (int v : t) isIn[v] = true;
    }
    std::vector<int> vertices;
    for (int v = 0; v < mesh_.vertexCount(); ++v)
        if (isIn[v]) vertices.push_back(v);
    return vertices;
}

// Energies of flipped triangles can have minima, if shallow ones, where the kernel is not.
bool SphereRelaxation::untangle(int v, double tolerance)
{
    if (starIsValid(v) || moveToKernel(v)) return relax(v, 0);
    return relax(v, tolerance);
}

int SphereRelaxation::movedByUntangling() const
{
    return static_cast<int>(std::count(hasMoved_.begin(), hasMoved_.end(), true));
}

bool SphereRelaxation::untangle()
{
    constexpr int kSweeps = 12, kPatience = 5;
    constexpr double kShrink = 0.6; // of the tolerance, from sweep to sweep
    std::vector<int> flipped = flippedFaces();
    size_t fewest = flipped.size();
    for (int inVain = 0; !flipped.empty() && inVain < kPatience;) {
        const std::vector<int> around = verticesAround(flipped, 1 + inVain / 2);
        double tolerance = 1;
        for (int sweep = 0; sweep < kSweeps; ++sweep, tolerance *= kShrink)
            for (int v : around)
                if (untangle(v, tolerance)) hasMoved_[v] = true;
        flipped = flippedFaces();
        // (What shrinks by less each time would take forever.)
        inVain = 20 * flipped.size() < 19 * fewest ? 0 : inVain + 1;
        fewest = std::min(fewest, flipped.size());
    }
    return flipped.empty();
}

} // namespace gimg

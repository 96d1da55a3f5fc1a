#pragma once

#include "gimg/mesh.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace gimg {

/// Twice the signed area of a planar triangle.
inline double doubleArea(const std::array<Vec2, 3>& p)
{
    const Vec2 a = p[1] - p[0], b = p[2] - p[0];
    return a.x() * b.y() - a.y() * b.x();
}

/// Smallest t > 0 at which the triangle p + t d has no area left; infinite if there is none.
inline double firstCollapse(const std::array<Vec2, 3>& p, const std::array<Vec2, 3>& d)
{
    const Vec2 a = p[1] - p[0], b = p[2] - p[0], u = d[1] - d[0], v = d[2] - d[0];
    const auto cross = [](const Vec2& x, const Vec2& y) { return x.x() * y.y() - x.y() * y.x(); };
    const double c0 = cross(a, b), c1 = cross(a, v) + cross(u, b), c2 = cross(u, v);
    const double none = std::numeric_limits<double>::infinity();
    if (c2 == 0) return c1 < 0 ? -c0 / c1 : none;
    const double discriminant = c1 * c1 - 4 * c0 * c2;
    if (discriminant < 0) return none;
    // Both roots without cancellation.
    const double q = -0.5 * (c1 + std::copysign(std::sqrt(discriminant), c1));
    double first = none;
    for (double root : {q / c2, q != 0 ? c0 / q : none})
        if (root > 0) first = std::min(first, root);
    return first;
}

/// The stretch of one triangle. L2(T)^2 = N / (2 a^2), where a is twice its area in the plane and
/// N = s'Gs + t'Gt with G the Gram matrix of the surface triangle's edges (edge k opposite corner k).
/// Descent lowers A(T) L2(T)^4: linear interpolation errs by the square of the spacing, so its mean square
/// goes with the fourth power of the stretch. Unknowns are ordered s0 s1 s2 t0 t1 t2.
class StretchElement
{
public:
    StretchElement(const Vec3& q0, const Vec3& q1, const Vec3& q2, double importance = 1)
        : area_(0.5 * (q1 - q0).cross(q2 - q0).norm()), weight_(importance * area_)
    {
        const Vec3 edge[3] = {q2 - q1, q0 - q2, q1 - q0};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) gram_(i, j) = edge[i].dot(edge[j]);
    }

    double area() const { return area_; }

    /// L2(T)^2; infinite for a flipped or degenerate triangle.
    double squaredStretch(const std::array<Vec2, 3>& p) const
    {
        const double a = doubleArea(p);
        if (!(a > 0)) return std::numeric_limits<double>::infinity();
        return numerator(p) / (2 * a * a);
    }

    /// A(T) L2(T)^4
    double energy(const std::array<Vec2, 3>& p) const
    {
        const double stretch = squaredStretch(p);
        return weight_ * stretch * stretch;
    }

    struct Derivatives
    {
        Eigen::Matrix<double, 6, 1> gradient;
        Eigen::Matrix<double, 6, 6> hessian; ///< positive semi-definite, close to the Hessian
    };

    Derivatives derivatives(const std::array<Vec2, 3>& p) const
    {
        const auto [s, t] = relative(p);
        const double a = doubleArea(p), n = numerator(p);
        Eigen::Matrix<double, 6, 1> gradN, gradA;
        gradN << 2 * gram_ * s, 2 * gram_ * t;
        gradA << t[1] - t[2], t[2] - t[0], t[0] - t[1], s[2] - s[1], s[0] - s[2], s[1] - s[0];
        const double a2 = a * a, a3 = a2 * a;

        // With f = N / a^2 the exact Hessian is 2(G+G)/a^2 - 2(dN da' + da dN')/a^3 + 6N da da'/a^4 - 2N
        // d2a/a^3. With 8 for 6 the first three terms are a square; of the last only the positive part is
        // kept: d2a has the eigenvalues +-sqrt(3) off the constants.
        const Eigen::Matrix<double, 6, 1> gradF = gradN / a2 - (2 * n / a3) * gradA;
        Eigen::Matrix<double, 6, 6> hessF =
            -2 / a3 * (gradN * gradA.transpose() + gradA * gradN.transpose()) +
            (8 * n / (a2 * a2)) * (gradA * gradA.transpose());
        Eigen::Matrix3d centred = Eigen::Matrix3d::Constant(-1.0 / 3);
        centred.diagonal().array() += 1;
        Eigen::Matrix3d b;
        b << 0, 1, -1, -1, 0, 1, 1, -1, 0;
        const Eigen::Matrix3d diagonal = 2 / a2 * gram_ + (n / a3 * std::sqrt(3.0)) * centred;
        hessF.topLeftCorner<3, 3>() += diagonal;
        hessF.bottomRightCorner<3, 3>() += diagonal;
        hessF.topRightCorner<3, 3>() -= n / a3 * b;
        hessF.bottomLeftCorner<3, 3>() -= n / a3 * b.transpose();

        // E = A/4 f^2
        const double f = n / a2;
        return {0.5 * weight_ * f * gradF, 0.5 * weight_ * (gradF * gradF.transpose() + f * hessF)};
    }

private:
    // Coordinates from corner 0 on: G annihilates constants, and tiny triangles far from the origin keep
    // their digits.
    static std::pair<Eigen::Vector3d, Eigen::Vector3d> relative(const std::array<Vec2, 3>& p)
    {
        return {{0, p[1].x() - p[0].x(), p[2].x() - p[0].x()}, {0, p[1].y() - p[0].y(), p[2].y() - p[0].y()}};
    }

    double numerator(const std::array<Vec2, 3>& p) const
    {
        const auto [s, t] = relative(p);
        return s.dot(gram_ * s) + t.dot(gram_ * t);
    }

    Eigen::Matrix3d gram_;
    double area_;
    double weight_;
};

} // namespace gimg

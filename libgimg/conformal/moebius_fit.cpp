#include "gimg/moebius.h"

#include <Eigen/Dense>

#include <cmath>

namespace gimg {
namespace {

// Of the hyperbolic convex function sum m log(|p - c|^2 / (1 - |c|^2)), whose minimum is the conformal
// barycentre: its value at c less that at 0.
double raise(const std::vector<Vec3>& points, const std::vector<double>& mass, const Vec3& c)
{
    double sum = 0;
    const double inside = 1 - c.squaredNorm();
    for (size_t i = 0; i < points.size(); ++i)
        sum += mass[i] * std::log((points[i] - c).squaredNorm() / inside);
    return sum;
}

} // namespace

Vec3 massCentre(const std::vector<Vec3>& points, const std::vector<double>& mass)
{
    Vec3 sum = Vec3::Zero();
    double total = 0;
    for (size_t i = 0; i < points.size(); ++i) {
        sum += mass[i] * points[i];
        total += mass[i];
    }
    return sum / total;
}

// Centring by a small c moves p by -2 c + 2 (p.c) p: from this comes Newton's step, after which all points
// are moved and the next one begins in the centre again.
Result<Moebius> centringMass(const std::vector<Vec3>& points, const std::vector<double>& mass)
{
    constexpr int kMost = 200;
    constexpr double kCentred = 1e-12, kLongest = 0.9, kSure = 1e-3;
    Moebius total;
    std::vector<Vec3> moved = points;
    const auto fail = Error{ErrorKind::BadArgument,
                            "more than half of the mass lies in one point: no Moebius map centres it"};
    for (int iteration = 0; iteration < kMost; ++iteration) {
        Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
        double sum = 0;
        for (size_t i = 0; i < points.size(); ++i) {
            hessian += mass[i] * (Eigen::Matrix3d::Identity() - moved[i] * moved[i].transpose());
            sum += mass[i];
        }
        const Vec3 centre = massCentre(moved, mass);
        if (!centre.allFinite()) return fail;
        if (centre.norm() < kCentred) return total;
        // Where the mass is nearly in a point the Hessian is flat along it: the way there is the gradient's.
        hessian += 1e-3 * centre.norm() * sum * Eigen::Matrix3d::Identity();
        Vec3 step = 0.5 * sum * hessian.ldlt().solve(centre);
        if (step.norm() > kLongest) step *= kLongest / step.norm();
        // Near the minimum Newton's step is right, and rounding would hide what it gains.
        bool lowers = step.norm() < kSure || raise(moved, mass, step) < 0;
        for (int halving = 0; halving < 60 && !lowers; ++halving) {
            step *= 0.5;
            lowers = raise(moved, mass, step) < 0;
        }
        if (!lowers) return fail;
        total = Moebius::centring(step) * total;
        for (size_t i = 0; i < points.size(); ++i) moved[i] = total(points[i]);
    }
    return fail;
}

Eigen::Matrix3d bestRotation(const std::vector<Vec3>& from, const std::vector<Vec3>& to)
{
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (size_t i = 0; i < from.size(); ++i) covariance += to[i] * from[i].transpose();
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Vec3 sign(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
    return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

// Gauss-Newton in the six directions of the group: rotations by w move p by w x p, boosts by b by b - (p.b)
// p.
Result<Moebius> bestMoebius(const std::vector<Vec3>& from, const std::vector<Vec3>& to)
{
    if (from.size() != to.size() || from.size() < 3)
        return Error{ErrorKind::BadArgument, "as many points as images, and at least 3, are needed"};
    const auto squares = [&](const Moebius& map) {
        double sum = 0;
        for (size_t i = 0; i < from.size(); ++i) sum += (map(from[i]) - to[i]).squaredNorm();
        return sum;
    };
    constexpr int kMost = 100;
    Moebius best = Moebius::rotating(bestRotation(from, to));
    double now = squares(best), damping = 1e-6;
    for (int iteration = 0; iteration < kMost; ++iteration) {
        Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
        Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
        for (size_t i = 0; i < from.size(); ++i) {
            const Vec3 p = best(from[i]);
            Eigen::Matrix<double, 3, 6> moves;
            for (int k = 0; k < 3; ++k) {
                moves.col(k) = Vec3::Unit(k).cross(p);
                moves.col(3 + k) = Vec3::Unit(k) - p[k] * p;
            }
            normal += moves.transpose() * moves;
            right += moves.transpose() * (to[i] - p);
        }
        normal += damping * normal.trace() / 6 * Eigen::Matrix<double, 6, 6>::Identity();
        Eigen::Matrix<double, 6, 1> step = normal.ldlt().solve(right);
        const double length = step.norm();
        if (length < 1e-14) break;
        if (length > 1) step /= length;
        const Vec3 turn = step.head<3>(), boost = step.tail<3>();
        const Eigen::Matrix3d rotation =
            turn.norm() > 0 ? Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix()
                            : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
        const Moebius tried = Moebius::centring(-0.5 * boost) * Moebius::rotating(rotation) * best;
        const double after = squares(tried);
        if (after < now) {
            best = tried;
            now = after;
            damping = std::max(1e-9, damping / 10);
        } else if (damping < 1e6) {
            damping *= 10;
        } else {
            break;
        }
    }
    return best;
}

} // namespace gimg

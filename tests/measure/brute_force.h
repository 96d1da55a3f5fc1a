#pragma once

#include "gimg/mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

/// The nearest point of a mesh by looking at every triangle, in long doubles and by other formulas than the
/// library's.
namespace gimg::test {

using Real = long double;
using RealVec3 = Eigen::Matrix<Real, 3, 1>;

struct BruteForceNearest
{
    Real distance = std::numeric_limits<Real>::infinity();
    int face = -1;
    RealVec3 point = RealVec3::Zero();
    RealVec3 normal = RealVec3::Zero(); ///< zero where there is none
};

/// Weights of the corners of the nearest point: within the triangle if the solution of the normal equations
/// is (Eberly), else the best point of the three sides.
inline RealVec3 bruteForceWeights(const RealVec3& q, const RealVec3 (&corner)[3])
{
    const RealVec3 e0 = corner[1] - corner[0], e1 = corner[2] - corner[0], d = corner[0] - q;
    const Real a00 = e0.dot(e0), a01 = e0.dot(e1), a11 = e1.dot(e1), b0 = e0.dot(d), b1 = e1.dot(d);
    const Real det = a00 * a11 - a01 * a01;
    const Real s = (a01 * b1 - a11 * b0) / det, t = (a01 * b0 - a00 * b1) / det;
    if (det > 1e-16L * a00 * a11 && s >= 0 && t >= 0 && s + t <= 1) return {1 - s - t, s, t};
    RealVec3 best = RealVec3::Zero();
    Real nearest = std::numeric_limits<Real>::infinity();
    for (int k = 0; k < 3; ++k) {
        const RealVec3 &a = corner[k], &b = corner[(k + 1) % 3];
        const Real length2 = (b - a).squaredNorm();
        const Real along = length2 > 0 ? std::clamp((q - a).dot(b - a) / length2, Real(0), Real(1)) : Real(0);
        const Real distance = (q - (1 - along) * a - along * b).norm();
        if (distance >= nearest) continue;
        nearest = distance;
        best.setZero();
        best[k] = 1 - along;
        best[(k + 1) % 3] = along;
    }
    return best;
}

/// @param size  of the mesh: what is nearer than 1e-12 of it is one point
inline BruteForceNearest bruteForceNearest(const Vec3& at, const Mesh& mesh, Real size)
{
    const RealVec3 q = at.cast<Real>();
    struct Candidate
    {
        Real distance = 0;
        RealVec3 point = RealVec3::Zero(), weights = RealVec3::Zero(), corner[3];
    };
    std::vector<Candidate> all;
    BruteForceNearest best;
    for (int f = 0; f < mesh.faceCount(); ++f) {
        Candidate c;
        for (int k = 0; k < 3; ++k) c.corner[k] = mesh.positions[mesh.faces[f][k]].cast<Real>();
        c.weights = bruteForceWeights(q, c.corner);
        for (int k = 0; k < 3; ++k) c.point += c.weights[k] * c.corner[k];
        c.distance = (c.point - q).norm();
        if (c.distance < best.distance) {
            best.distance = c.distance;
            best.face = f;
            best.point = c.point;
        }
        all.push_back(c);
    }
    for (const Candidate& c : all) {
        if (c.distance > best.distance + 1e-12L * size || (c.point - best.point).norm() > 1e-12L * size)
            continue;
        const RealVec3 e0 = c.corner[1] - c.corner[0], e1 = c.corner[2] - c.corner[0];
        const RealVec3 n = e0.cross(e1);
        if (n.norm() <= 1e-8L * e0.norm() * e1.norm()) continue;
        int corners = 0, corner = 0; // whose weight is zero; and of the largest weight
        for (int k = 0; k < 3; ++k) corners += c.weights[k] < 1e-11L;
        c.weights.maxCoeff(&corner);
        Real angle = corners == 0 ? 2 * std::numbers::pi_v<Real> : std::numbers::pi_v<Real>;
        if (corners == 2) {
            const RealVec3 u = (c.corner[(corner + 1) % 3] - c.corner[corner]).normalized();
            const RealVec3 v = (c.corner[(corner + 2) % 3] - c.corner[corner]).normalized();
            angle = std::acos(std::clamp(u.dot(v), Real(-1), Real(1)));
        }
        best.normal += angle * n.normalized();
    }
    if (best.normal.norm() < 1e-8L)
        best.normal.setZero();
    else
        best.normal.normalize();
    return best;
}

} // namespace gimg::test

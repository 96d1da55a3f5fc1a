#pragma once

#include "gimg/mesh.h"
#include "gimg/result.h"

#include <array>
#include <complex>
#include <vector>

namespace gimg {

/// Stereographic projection of the unit sphere from its south pole (0, 0, -1): (x + i y) / (1 + z). Seen from
/// outside, it keeps orientation; the south pole becomes infinite. Source: thesis, equation 64.
std::complex<double> stereographic(const Vec3& onSphere);

/// The point of the unit sphere that stereographic() takes to z.
Vec3 ontoSphere(const std::complex<double>& z);

/// A conformal, orientation-preserving map of the sphere onto itself: z -> (a z + b) / (c z + d) with
/// a d - b c = 1 in the plane of stereographic().
class Moebius
{
public:
    Moebius() = default; ///< the identity

    /// @param a, b, c, d  with a d - b c != 0; scaled so that it becomes 1
    Moebius(std::complex<double> a, std::complex<double> b, std::complex<double> c, std::complex<double> d);

    /// The one that takes three points of the sphere to three others.
    /// Errors: BadArgument if two of the points, or two of their images, coincide.
    static Result<Moebius> byThreePoints(const std::array<Vec3, 3>& from, const std::array<Vec3, 3>& to);

    /// The one without rotation that takes the point `p` of the open unit ball to the ball's centre, as an
    /// isometry of hyperbolic space, of which the ball is Poincare's model. |p| < 1.
    static Moebius centring(const Vec3& p);

    /// @param rotation  orthonormal, determinant 1
    static Moebius rotating(const Eigen::Matrix3d& rotation);

    Vec3 operator()(const Vec3& onSphere) const;
    std::complex<double> operator()(const std::complex<double>& z) const;
    Moebius operator*(const Moebius& first) const; ///< `first`, then this
    Moebius inverse() const;

    std::complex<double> a() const { return a_; }
    std::complex<double> b() const { return b_; }
    std::complex<double> c() const { return c_; }
    std::complex<double> d() const { return d_; }

private:
    std::complex<double> a_ = 1, b_ = 0, c_ = 0, d_ = 1;
};

/// Mean of points of the sphere, each with its mass.
Vec3 massCentre(const std::vector<Vec3>& points, const std::vector<double>& mass);

/// The Moebius map, free of rotation, after which the mass centre is the sphere's: it takes the conformal
/// barycentre of the masses, which is unique, to the ball's centre. Newton's method on the hyperbolic convex
/// function whose gradient is the mass centre.
/// @param points  on the unit sphere
/// @param mass    one per point, >= 0
/// Errors: BadArgument if more than half of the mass lies in one point, for which there is no such map.
/// Source: Douady, Earle 1986, "Conformally natural extension of homeomorphisms of the circle"; Baden, Crane,
/// Kazhdan 2018, "Moebius registration".
Result<Moebius> centringMass(const std::vector<Vec3>& points, const std::vector<double>& mass);

/// The rotation R with the least sum of |R from_i - to_i|^2. Source: Kabsch 1976, "A solution for the best
/// rotation to relate two sets of vectors".
/// @param from, to  equally many points
Eigen::Matrix3d bestRotation(const std::vector<Vec3>& from, const std::vector<Vec3>& to);

/// The Moebius map that brings `from` as near to `to` as it can, in the sense of the least sum of squared
/// distances on the sphere that descent from their best rotation finds.
/// @param from, to  equally many points of the unit sphere, at least 3
/// Errors: BadArgument for other numbers of points.
Result<Moebius> bestMoebius(const std::vector<Vec3>& from, const std::vector<Vec3>& to);

} // namespace gimg

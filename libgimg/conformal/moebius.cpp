#include "gimg/moebius.h"

#include <cmath>

namespace gimg {
namespace {

using Complex = std::complex<double>;

// A point of the sphere as z = first / second, with neither infinite: homogeneous coordinates of the plane.
struct Homogeneous
{
    Complex first, second;
};

Homogeneous homogeneous(const Vec3& p)
{
    if (p.z() >= 0) return {{p.x(), p.y()}, 1 + p.z()};
    return {1 - p.z(), {p.x(), -p.y()}};
}

Vec3 onSphere(const Homogeneous& w)
{
    const double first = std::norm(w.first), second = std::norm(w.second), sum = first + second;
    const Complex product = w.first * std::conj(w.second);
    return {2 * product.real() / sum, 2 * product.imag() / sum, (second - first) / sum};
}

Complex determinant(const Homogeneous& v, const Homogeneous& w)
{
    return v.first * w.second - w.first * v.second;
}

} // namespace

Complex stereographic(const Vec3& p)
{
    const Homogeneous w = homogeneous(p);
    return w.first / w.second;
}

Vec3 ontoSphere(const Complex& z)
{
    // Far out the squares of z would overflow: 1 / z is near.
    return std::abs(z) <= 1 ? onSphere({z, 1}) : onSphere({1, 1.0 / z});
}

Moebius::Moebius(Complex a, Complex b, Complex c, Complex d) : a_(a), b_(b), c_(c), d_(d)
{
    const Complex root = std::sqrt(a * d - b * c);
    for (Complex* entry : {&a_, &b_, &c_, &d_}) *entry /= root;
}

Moebius Moebius::operator*(const Moebius& first) const
{
    return {a_ * first.a_ + b_ * first.c_, a_ * first.b_ + b_ * first.d_, c_ * first.a_ + d_ * first.c_,
            c_ * first.b_ + d_ * first.d_};
}

Moebius Moebius::inverse() const { return {d_, -b_, -c_, a_}; }

Complex Moebius::operator()(const Complex& z) const { return (a_ * z + b_) / (c_ * z + d_); }

Vec3 Moebius::operator()(const Vec3& p) const
{
    const Homogeneous w = homogeneous(p);
    return onSphere({a_ * w.first + b_ * w.second, c_ * w.first + d_ * w.second});
}

// The columns of the matrix that takes 0, infinity and 1 to three points are multiples of the second and the
// first, such that their sum is one of the third.
Result<Moebius> Moebius::byThreePoints(const std::array<Vec3, 3>& from, const std::array<Vec3, 3>& to)
{
    constexpr double kApart = 1e-12;
    const auto standard = [&](const std::array<Vec3, 3>& p) -> Result<Moebius> {
        for (int k = 0; k < 3; ++k)
            if ((p[k] - p[(k + 1) % 3]).norm() < kApart)
                return Error{ErrorKind::BadArgument, "two of the three points coincide"};
        const Homogeneous zero = homogeneous(p[0]), infinite = homogeneous(p[1]), one = homogeneous(p[2]);
        const Complex forInfinite = determinant(one, zero) / determinant(infinite, zero);
        const Complex forZero = determinant(infinite, one) / determinant(infinite, zero);
        return Moebius(forInfinite * infinite.first, forZero * zero.first, forInfinite * infinite.second,
                       forZero * zero.second);
    };
    const Result<Moebius> source = standard(from), target = standard(to);
    if (!source) return source.error();
    if (!target) return target.error();
    return *target * source->inverse();
}

// Along the z axis, z -> k z with k = (1 + |p|) / (1 - |p|) or the inverse; turned there and back, to the
// pole that is nearer.
Moebius Moebius::centring(const Vec3& p)
{
    const double radius = p.norm();
    if (!(radius > 0)) return {};
    const double pole = p.z() < 0 ? -1 : 1, root = std::sqrt((1 + pole * radius) / (1 - pole * radius));
    const Eigen::Matrix3d toAxis =
        Eigen::Quaterniond::FromTwoVectors(p, pole * Vec3::UnitZ()).toRotationMatrix();
    return rotating(toAxis.transpose()) * Moebius(root, 0, 0, 1 / root) * rotating(toAxis);
}

// With the unit quaternion w + x i + y j + z k: a rotation by t about the vertical multiplies by exp(i t),
// one by t about x takes 0 to -i tan(t / 2), one about y takes it to tan(t / 2).
Moebius Moebius::rotating(const Eigen::Matrix3d& rotation)
{
    const Eigen::Quaterniond q(rotation);
    return {{q.w(), q.z()}, {q.y(), -q.x()}, {-q.y(), -q.x()}, {q.w(), -q.z()}};
}

} // namespace gimg

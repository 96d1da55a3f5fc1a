#include "gimg/conformal_image.h"

#include <array>
#include <cmath>
#include <complex>
#include <limits>

namespace gimg {
namespace {

constexpr double kHalfPeriod =
    2.62205755429211981; // of the lemniscate sine: twice the integral of 1 / sqrt(1 - r^4)

struct Lemniscate
{
    double sine, slope; // sl(x) and its derivative
};

// For |x| <= kHalfPeriod / 2, by Jacobi's functions of parameter 1/2: sl(x) = sn(u) / (sqrt(2) dn(u)) and
// cl(x) = cn(u) with u = sqrt(2) x; these by the arithmetic-geometric mean (Abramowitz and Stegun 16.4).
Lemniscate lemniscate(double x)
{
    constexpr int kSteps = 6; // digits double in each
    std::array<double, kSteps + 1> a{1}, c{std::sqrt(0.5)};
    double b = std::sqrt(0.5);
    for (int n = 0; n < kSteps; ++n) {
        a[n + 1] = 0.5 * (a[n] + b);
        c[n + 1] = 0.5 * (a[n] - b);
        b = std::sqrt(a[n] * b);
    }
    double angle = std::ldexp(a[kSteps] * std::sqrt(2.0) * x, kSteps);
    for (int n = kSteps; n > 0; --n) angle = 0.5 * (angle + std::asin(c[n] / a[n] * std::sin(angle)));
    const double sn = std::sin(angle), sine = sn / std::sqrt(2 - sn * sn);
    return {sine, std::cos(angle) * (1 + sine * sine)};
}

// By the addition theorem, for |x| + |y| <= kHalfPeriod / 2, where the denominator stays away from 0.
std::complex<double> lemniscateSine(double x, double y)
{
    const Lemniscate p = lemniscate(x), q = lemniscate(y);
    const double product = p.sine * q.sine;
    return std::complex<double>(p.sine * q.slope, q.sine * p.slope) / (1 - product * product);
}

} // namespace

Vec3 sphereOfSquare(const Vec2& st)
{
    const double x = kHalfPeriod * std::abs(st.x() - 0.5), y = kHalfPeriod * std::abs(st.y() - 0.5),
                 corner = kHalfPeriod / 2;
    Vec3 p;
    if (x + y <= corner) {
        p = ontoSphere(lemniscateSine(x, y));
    } else {
        // sl(z + (1 + i) corner) = -i / sl(z): another point turned.
        const Vec3 q = ontoSphere(lemniscateSine(x - corner, y - corner));
        p = {-q.y(), -q.x(), -q.z()};
    }
    return {st.x() < 0.5 ? -p.x() : p.x(), st.y() < 0.5 ? -p.y() : p.y(), p.z()};
}

// With w = sl(z): dw/dz = sqrt(1 - w^4), and lengths on the sphere are 2 |dw| / (1 + |w|^2).
double squareDensity(const Vec3& onSphere)
{
    const Vec3 p(onSphere.x(), onSphere.y(), std::abs(onSphere.z())); // the halves are alike
    const std::complex<double> w = stereographic(p), square = w * w;
    const double scale = 0.5 * (1 + std::norm(w));
    return scale * scale / (std::abs((1.0 - square) * (1.0 + square)) * kHalfPeriod * kHalfPeriod);
}

GridSeam foldedSquareSeam(int lowest)
{
    GridSeam seam;
    seam.lowest = lowest;
    for (uint32_t side = 0; side < 4; ++side)
        for (const auto kind : {GIM_SIDE_FIRST, GIM_SIDE_MATE}) {
            gim_side half{};
            half.path = side;
            half.length = static_cast<uint32_t>(lowest - 1) / 2;
            half.kind = kind;
            seam.sides.push_back(half);
        }
    return seam;
}

} // namespace gimg

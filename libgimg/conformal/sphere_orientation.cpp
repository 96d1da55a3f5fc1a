#include "gimg/sphere_map.h"

#include <array>
#include <cmath>
#include <limits>

namespace gimg {
namespace {

// A number as the exact sum of doubles that do not overlap, the smallest first. Source: Shewchuk 1997,
// "Adaptive precision floating-point arithmetic and fast robust geometric predicates".
template <int Most> struct Expansion
{
    std::array<double, Most> term;
    int count = 0;

    void add(double b)
    {
        double carried = b;
        for (int i = 0; i < count; ++i) {
            const double sum = carried + term[i], other = sum - carried;
            term[i] = (carried - (sum - other)) + (term[i] - other);
            carried = sum;
        }
        term[count++] = carried;
    }
    int sign() const
    {
        for (int i = count - 1; i >= 0; --i)
            if (term[i] != 0) return term[i] > 0 ? 1 : -1;
        return 0;
    }
};

// a b c, exactly: each product and what rounding took from it.
template <int Most> void addProduct(Expansion<Most>& sum, double a, double b, double c)
{
    const double high = a * b, low = std::fma(a, b, -high);
    for (double part : {high, low}) {
        const double product = part * c;
        sum.add(product);
        sum.add(std::fma(part, c, -product));
    }
}

int exactOrientation(const Vec3& a, const Vec3& b, const Vec3& c)
{
    Expansion<24> sum;
    for (int k = 0; k < 3; ++k) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        addProduct(sum, a[k], b[l], c[m]);
        addProduct(sum, -a[k], b[m], c[l]);
    }
    return sum.sign();
}

} // namespace

int sphereOrientation(const Vec3& a, const Vec3& b, const Vec3& c)
{
    // Six products of three, each with a relative error below three roundings and five in the sum.
    constexpr double kBound = 8 * std::numeric_limits<double>::epsilon();
    double sum = 0, size = 0;
    for (int k = 0; k < 3; ++k) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        const double plus = a[k] * b[l] * c[m], minus = a[k] * b[m] * c[l];
        sum += plus - minus;
        size += std::abs(plus) + std::abs(minus);
    }
    if (std::abs(sum) > kBound * size) return sum > 0 ? 1 : -1;
    return exactOrientation(a, b, c);
}

int flippedOnSphere(const std::vector<Triangle>& faces, const std::vector<Vec3>& position)
{
    int count = 0;
    for (const Triangle& t : faces)
        count += sphereOrientation(position[t[0]], position[t[1]], position[t[2]]) <= 0;
    return count;
}

} // namespace gimg

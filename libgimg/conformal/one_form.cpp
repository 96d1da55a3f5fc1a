#include "gimg/one_form.h"

#include <cmath>

namespace gimg {
namespace {

template <class Form> double largestFaceSum(const Form& form)
{
    double largest = 0;
    for (Eigen::Index h = 0; h + 2 < form.size(); h += 3)
        largest = std::max(largest, std::abs(form[h] + form[h + 1] + form[h + 2]));
    return largest;
}

// Kahan's form of Heron's formula.
double triangleArea(double a, double b, double c)
{
    if (a < b) std::swap(a, b);
    if (b < c) std::swap(b, c);
    if (a < b) std::swap(a, b);
    return 0.25 * std::sqrt((a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c)));
}

} // namespace

OneForm exteriorDerivative(const Halfedges& halfedges, const Eigen::VectorXd& f)
{
    OneForm df(halfedges.count());
    for (int h = 0; h < halfedges.count(); ++h) df[h] = f[halfedges.head(h)] - f[halfedges.tail(h)];
    return df;
}

double closednessError(const OneForm& form) { return largestFaceSum(form); }
double closednessError(const ComplexOneForm& form) { return largestFaceSum(form); }

double integrate(const OneForm& form, std::span<const int> halfedges)
{
    double sum = 0;
    for (int h : halfedges) sum += form[h];
    return sum;
}

std::complex<double> integrate(const ComplexOneForm& form, std::span<const int> halfedges)
{
    std::complex<double> sum = 0;
    for (int h : halfedges) sum += form[h];
    return sum;
}

// For a closed form all three minors of eq. 46 are the same.
double wedge(const OneForm& a, const OneForm& b, int f)
{
    const int h = 3 * f;
    return ((a[h] * b[h + 1] - a[h + 1] * b[h]) + (a[h + 1] * b[h + 2] - a[h + 2] * b[h + 1]) +
            (a[h + 2] * b[h] - a[h] * b[h + 2])) /
           6;
}

double wedge(const OneForm& a, const OneForm& b)
{
    double sum = 0;
    for (int f = 0; f < a.size() / 3; ++f) sum += wedge(a, b, f);
    return sum;
}

double starWedge(const PolyhedralSurface& surface, const OneForm& a, const OneForm& b, int f)
{
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
        const int h = 3 * f + k;
        const double l = surface.lengths[h];
        const double p = surface.lengths[Halfedges::next(h)], q = surface.lengths[Halfedges::prev(h)];
        const double cosine = p * p + (q - l) * (q + l); // of the opposite angle, times 2 p q
        sum += cosine * a[h] * b[h];
    }
    const double* l = &surface.lengths[3 * static_cast<size_t>(f)];
    return sum / (8 * triangleArea(l[0], l[1], l[2]));
}

double starWedge(const PolyhedralSurface& surface, const OneForm& a, const OneForm& b)
{
    double sum = 0;
    for (int f = 0; f < surface.faceCount(); ++f) sum += starWedge(surface, a, b, f);
    return sum;
}

} // namespace gimg

#include "bjontegaard.h"

#include <algorithm>
#include <cmath>

namespace gimg::gimrd {
namespace {

// A piecewise cubic through (x, y) with slopes d at the points; x increases.
struct Cubic
{
    std::vector<double> x, y, d;
};

// The slope at an end, from the two intervals next to it: that of the parabola through three points, unless
// it has the wrong sign or overshoots.
double endSlope(double h0, double h1, double s0, double s1)
{
    const double d = ((2 * h0 + h1) * s0 - h0 * s1) / (h0 + h1);
    if (d * s0 <= 0) return 0;
    if (s0 * s1 <= 0 && std::abs(d) > 3 * std::abs(s0)) return 3 * s0;
    return d;
}

// Fritsch and Carlson: weighted harmonic means of the slopes of both intervals, so that a monotone sequence
// has a monotone interpolant.
Cubic hermite(std::vector<double> x, std::vector<double> y)
{
    const size_t n = x.size();
    std::vector<double> h(n - 1), s(n - 1), d(n);
    for (size_t i = 0; i + 1 < n; ++i) {
        h[i] = x[i + 1] - x[i];
        s[i] = (y[i + 1] - y[i]) / h[i];
    }
    for (size_t i = 1; i + 1 < n; ++i) {
        const double w0 = 2 * h[i] + h[i - 1], w1 = h[i] + 2 * h[i - 1];
        d[i] = s[i - 1] * s[i] <= 0 ? 0 : (w0 + w1) / (w0 / s[i - 1] + w1 / s[i]);
    }
    d[0] = n == 2 ? s[0] : endSlope(h[0], h[1], s[0], s[1]);
    d[n - 1] = n == 2 ? s[0] : endSlope(h[n - 2], h[n - 3], s[n - 2], s[n - 3]);
    return {std::move(x), std::move(y), std::move(d)};
}

// The integral of piece i from its start to `t`, 0 <= t <= length.
double pieceIntegral(const Cubic& f, size_t i, double t)
{
    const double h = f.x[i + 1] - f.x[i], s = (f.y[i + 1] - f.y[i]) / h;
    const double c2 = (3 * s - 2 * f.d[i] - f.d[i + 1]) / h;
    const double c3 = (f.d[i] + f.d[i + 1] - 2 * s) / (h * h);
    return t * (f.y[i] + t * (f.d[i] / 2 + t * (c2 / 3 + t * c3 / 4)));
}

double integral(const Cubic& f, double from, double to)
{
    double sum = 0;
    for (size_t i = 0; i + 1 < f.x.size(); ++i) {
        const double a = std::max(from, f.x[i]), b = std::min(to, f.x[i + 1]);
        if (a < b) sum += pieceIntegral(f, i, b - f.x[i]) - pieceIntegral(f, i, a - f.x[i]);
    }
    return sum;
}

// How much the test lies above the reference in the mean over the range that both cover.
std::optional<double> meanDifference(const Cubic& reference, const Cubic& test)
{
    const double from = std::max(reference.x.front(), test.x.front());
    const double to = std::min(reference.x.back(), test.x.back());
    if (from >= to) return std::nullopt;
    return (integral(test, from, to) - integral(reference, from, to)) / (to - from);
}

} // namespace

std::vector<RatePoint> rateCurve(std::vector<RatePoint> points)
{
    std::erase_if(points, [](const RatePoint& p) { return !std::isfinite(p.psnr) || p.bytes <= 0; });
    std::sort(points.begin(), points.end(), [](const RatePoint& a, const RatePoint& b) {
        return a.bytes != b.bytes ? a.bytes < b.bytes : a.psnr > b.psnr;
    });
    std::vector<RatePoint> curve;
    for (const RatePoint& p : points)
        if (curve.empty() || p.psnr > curve.back().psnr) curve.push_back(p);
    return curve;
}

Bjontegaard bjontegaard(const std::vector<RatePoint>& reference, const std::vector<RatePoint>& test)
{
    std::vector<double> rate[2], psnr[2];
    const std::vector<RatePoint> curves[2] = {rateCurve(reference), rateCurve(test)};
    for (int c = 0; c < 2; ++c) {
        if (curves[c].size() < kBjontegaardPoints) return {};
        for (const RatePoint& p : curves[c]) {
            rate[c].push_back(std::log10(p.bytes));
            psnr[c].push_back(p.psnr);
        }
    }
    Bjontegaard result;
    result.psnr = meanDifference(hermite(rate[0], psnr[0]), hermite(rate[1], psnr[1]));
    const std::optional<double> rateDifference =
        meanDifference(hermite(psnr[0], rate[0]), hermite(psnr[1], rate[1]));
    if (rateDifference) result.ratePercent = 100 * (std::pow(10, *rateDifference) - 1);
    return result;
}

} // namespace gimg::gimrd

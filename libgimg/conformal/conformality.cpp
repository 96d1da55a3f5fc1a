#include "gimg/conformality.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gimg {
namespace {

// A triangle by its sides from corner 0: all that conformality asks for.
struct Shape
{
    double squares[3]; // of the sides opposite to the corners
    double doubleArea;

    Shape(const Vec3& a, const Vec3& b, const Vec3& c)
        : squares{(c - b).squaredNorm(), (a - c).squaredNorm(), (b - a).squaredNorm()},
          doubleArea((b - a).cross(c - a).norm())
    {
    }
    double cotangent(int k) const
    {
        return (squares[(k + 1) % 3] + squares[(k + 2) % 3] - squares[k]) / (2 * doubleArea);
    }
    double angle(int k) const { return std::atan2(1.0, cotangent(k)); }
};

// For the linear map between two triangles, with singular values s >= t, the sum over the corners of cot *
// side^2 / (2 doubleArea), angles of one and sides of the other, is (s/t + t/s) / 2.
double quasiConformalRatio(const Shape& from, const Shape& to)
{
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += from.cotangent(k) * to.squares[k] / (2 * to.doubleArea);
    const double half = std::max(1.0, sum);
    return half + std::sqrt((half - 1) * (half + 1));
}

double fraction(std::vector<double>& values, double part)
{
    if (values.empty()) return 0;
    const auto at = static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return values[static_cast<size_t>(at)];
}

template <class Corner> Conformality measure(const Mesh& surface, const Corner& corner)
{
    Conformality out;
    std::vector<double> errors;
    double area = 0, ratios = 0, logs = 0, squares = 0;
    for (size_t f = 0; f < surface.faces.size(); ++f) {
        const Triangle& t = surface.faces[f];
        const Shape from(surface.positions[t[0]], surface.positions[t[1]], surface.positions[t[2]]);
        const Shape to(corner(f, 0), corner(f, 1), corner(f, 2));
        if (!(from.doubleArea > 0) || !(to.doubleArea > 0)) {
            ++out.degenerate;
            continue;
        }
        for (int k = 0; k < 3; ++k)
            errors.push_back(std::abs(to.angle(k) - from.angle(k)) * 180 / std::numbers::pi);
        const double scaling = std::log(to.doubleArea / from.doubleArea);
        area += from.doubleArea;
        ratios += from.doubleArea * quasiConformalRatio(from, to);
        logs += from.doubleArea * scaling;
        squares += from.doubleArea * scaling * scaling;
    }
    if (errors.empty()) return out;
    out.medianAngleError = fraction(errors, 0.5);
    out.angleError95 = fraction(errors, 0.95);
    out.largestAngleError = *std::max_element(errors.begin(), errors.end());
    out.quasiConformalRatio = ratios / area;
    out.areaDistortion = std::sqrt(std::max(0.0, squares / area - logs / area * logs / area));
    return out;
}

Vec3 inSpace(const Vec2& p) { return {p.x(), p.y(), 0}; }

} // namespace

Conformality conformality(const Mesh& surface, const std::vector<Vec3>& image)
{
    return measure(surface, [&](size_t f, int k) { return image[surface.faces[f][k]]; });
}

Conformality conformality(const Mesh& surface, const std::vector<Vec2>& image)
{
    return measure(surface, [&](size_t f, int k) { return inSpace(image[surface.faces[f][k]]); });
}

Conformality conformality(const Mesh& surface, const std::vector<std::array<Vec2, 3>>& image)
{
    return measure(surface, [&](size_t f, int k) { return inSpace(image[f][k]); });
}

} // namespace gimg

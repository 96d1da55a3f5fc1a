#pragma once

#include <optional>
#include <vector>

namespace gimg::gimrd {

/// One file of a coder: its size and how well it shows the surface.
struct RatePoint
{
    double bytes = 0;
    double psnr = 0; ///< dB
};

/// Fewer points of a coder than this define no curve to compare.
inline constexpr int kBjontegaardPoints = 4;

/// The points that make a curve: finite, by size, each better than every smaller one. A larger file that is
/// no better says nothing, for the smaller one can be sent in its place.
std::vector<RatePoint> rateCurve(std::vector<RatePoint> points);

/// How a coder stands against a reference coder, over the range that both curves cover.
struct Bjontegaard
{
    std::optional<double> ratePercent; ///< bytes more (or, negative, fewer) at equal PSNR
    std::optional<double> psnr;        ///< dB more at equal bytes
};

/// Bjontegaard's deltas with piecewise cubic Hermite interpolation (Fritsch and Carlson's monotone slopes) of
/// PSNR over log10 bytes, and of log10 bytes over PSNR. Nothing where the ranges do not overlap, or where
/// either curve has fewer than kBjontegaardPoints points after rateCurve().
/// Source: G. Bjontegaard, ITU-T SG16 VCEG-M33 (2001); the interpolation as C. Herglotz et al., "The
/// Bjontegaard Bible", IEEE Transactions on Image Processing 33 (2024), describe and test it.
Bjontegaard bjontegaard(const std::vector<RatePoint>& reference, const std::vector<RatePoint>& test);

} // namespace gimg::gimrd

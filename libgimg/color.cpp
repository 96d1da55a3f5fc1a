#include "gimg/color.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gimg {

namespace {

double labInverse(double t) { return t > 6.0 / 29 ? t * t * t : 3 * 36.0 / 841 * (t - 4.0 / 29); }

uint8_t encoded(double linear)
{
    const double x = std::clamp(linear, 0.0, 1.0);
    const double screen = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
    return static_cast<uint8_t>(std::lround(255 * screen));
}

/// CIE L*a*b* under D65 to sRGB (IEC 61966-2-1).
Color fromLab(double lightness, double a, double b)
{
    const double y = (lightness + 16) / 116;
    const double X = 0.95047 * labInverse(y + a / 500), Y = labInverse(y),
                 Z = 1.08883 * labInverse(y - b / 200);
    return {encoded(3.2404542 * X - 1.5371385 * Y - 0.4985314 * Z),
            encoded(-0.9692660 * X + 1.8760108 * Y + 0.0415560 * Z),
            encoded(0.0556434 * X - 0.2040259 * Y + 1.0572252 * Z)};
}

} // namespace

Color heatColor(double value)
{
    const double x = value > 0 ? std::min(value, 1.0) : 0.0;
    const double hue = (310 - 205 * x) * std::numbers::pi / 180;
    const double chroma = 27 + 115 * (x - 0.375) * (x - 0.375); // a little less than a screen can show
    return fromLab(15 + 77 * x, chroma * std::cos(hue), chroma * std::sin(hue));
}

} // namespace gimg

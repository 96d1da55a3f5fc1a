#pragma once

#include <array>
#include <cstdint>

namespace gimg {

using Color = std::array<uint8_t, 3>; ///< red, green, blue as a screen shows them (sRGB)

/// A colour for a value from 0, dark violet, over blue and green to 1, yellow; what lies outside takes the
/// colour of the nearer end, NaN that of 0. Lightness (CIE L*) rises evenly from 15 to 92 while the hue
/// turns, so equal steps look equal, and in grey too.
Color heatColor(double value);

} // namespace gimg

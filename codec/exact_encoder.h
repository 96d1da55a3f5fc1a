#pragma once

#include "exact_code.h"

#include <span>
#include <vector>

namespace gimg::codec {

/// Codes an image without loss.
/// @param samples  grid^2 samples of `channels` floats, finite or, held in floats, integers below 2^bits
/// @param classes  borderClasses() of the grid, or empty if nothing is glued. The samples of a class are
/// coded
///                 as the one at its smallest position.
std::vector<std::uint8_t> encodeExact(std::span<const float> samples, const ExactFormat& format,
                                      std::span<const std::uint32_t> classes);

} // namespace gimg::codec

#pragma once

#include "gimg/result.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace gimg::adapter {

/// A coder with one positive parameter, and what is known of it before a search.
struct OneParameter
{
    std::function<Result<std::vector<std::uint8_t>>(double parameter)> encode;
    double least = 0, most = 0; ///< values that it takes
    double start = 0;           ///< where the search begins
    double exponent = 1;        ///< size goes about as the parameter to the power of this
    int attempts = 8;           ///< files that are made
};

/// The largest file of at most `room` bytes that was found; nothing if none was so small. An error of the
/// coder ends the search.
Result<std::optional<std::vector<std::uint8_t>>> largestThatFits(const OneParameter& coder, std::size_t room);

} // namespace gimg::adapter

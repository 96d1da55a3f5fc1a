#pragma once

#include "exact_code.h"
#include "format/bytes.h"

namespace gimg::codec {

/// Bytes that decodeExact() takes from its arena.
std::uint64_t exactWorkspace(const ExactFormat& format);

/// Decodes what encodeExact() made: grid^2 samples of `channels` floats. Integers come as floats that hold
/// them.
/// @param classes  borderClasses() of the grid, if the image is glued along a seam, else nullptr
format::ReadStatus decodeExact(format::ByteSpan bytes, const ExactFormat& format,
                               const std::uint32_t* classes, Arena& arena, float* out);

} // namespace gimg::codec

#pragma once

#include "gimg/encode.h"

namespace gimg::gimenc {

/// Encodes a surface that stands in for another one: PSNR and errors are against `reference`. Errors: as
/// encodeMesh; TargetUnreachable also where `surface` itself is farther from the reference.
Result<EncodedMesh> encodeAgainst(const Mesh& reference, const Mesh& surface, EncodeOptions options);

} // namespace gimg::gimenc

#pragma once

#include "gimg/encode.h"

namespace gimg::gimenc {

/// Encodes a surface that stands in for another one: the PSNR that is reported, and that of
/// EncodeTarget::Psnr, is against `reference`. Errors: as encodeMesh; TargetUnreachable also where `surface`
/// itself is farther from the reference.
Result<EncodedMesh> encodeAgainst(const Mesh& reference, const Mesh& surface, const EncodeOptions& options);

} // namespace gimg::gimenc

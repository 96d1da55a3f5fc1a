#pragma once

#include "best_for_size.h"

namespace gimg::adapter {

/// meshoptimizer's vertex and index codecs on positions of up to 16 bits, packed by zstd at level 19.
MeshCodec meshoptCodec();

/// All triangles at 12 bits: decompression and both decoders.
Result<Times> timeMeshopt(const Mesh& mesh, int runs);

} // namespace gimg::adapter

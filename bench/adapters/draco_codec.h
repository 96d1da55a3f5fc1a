#pragma once

#include "best_for_size.h"

namespace gimg::adapter {

/// Draco with the settings of `draco_encoder -cl 10 -qp BITS`: positions only.
MeshCodec dracoCodec();

/// All triangles at 12 bits.
Result<Times> timeDraco(const Mesh& mesh, int runs);

} // namespace gimg::adapter

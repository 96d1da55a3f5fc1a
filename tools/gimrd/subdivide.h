#pragma once

#include "gimg/mesh.h"

namespace gimg::gimrd {

/// Splits each triangle into four at the middles of its edges: the same surface with four times the faces.
/// @param mesh  edge-manifold and consistently oriented
Mesh subdivide(const Mesh& mesh);

} // namespace gimg::gimrd

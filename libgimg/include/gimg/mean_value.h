#pragma once

#include "gimg/mesh.h"
#include "gimg/result.h"

#include <vector>

namespace gimg {

/// Harmonic-like map of a disk with its border fixed on a convex polygon, by mean-value coordinates. All
/// weights are positive, so without interior edges along one side of the polygon it is an embedding.
/// @param fixed     per vertex: position given
/// @param position  per vertex: positions of the fixed vertices on entry, of all on return
/// Errors: FlippedTriangle if the linear system could not be solved.
/// Source: Floater 2003, "Mean value coordinates"; thesis §3.1.2 uses Floater's earlier weights.
Status meanValueMap(const Mesh& mesh, const std::vector<bool>& fixed, std::vector<Vec2>& position);

} // namespace gimg

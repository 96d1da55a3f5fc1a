#pragma once

#include "gimg/homology.h"
#include "gimg/mesh.h"
#include "gimg/result.h"

#include <vector>

namespace gimg {

/// A neighbourhood of two loops that cross once: a torus with one hole.
struct HandleTorus
{
    Loop a, b;
    std::vector<int> faces;
};

/// One for each handle of a closed surface, no two with a face in common.
/// @param mesh     closed, connected, manifold, oriented, of this genus
/// @param lengths  per halfedge, the same on twins: by which loops are short
/// Errors: TargetUnreachable where a neighbourhood is no torus with one hole, or no loop is left that stays
/// away from those found before.
Result<std::vector<HandleTorus>> handleTori(const Mesh& mesh, const Halfedges& halfedges,
                                            const Eigen::VectorXd& lengths, int genus);

} // namespace gimg

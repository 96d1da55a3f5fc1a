#pragma once

#include "gimg/mesh.h"

#include <vector>

namespace gimg {

/// How much the stretch around each vertex counts when samples are to be spread for a small error rather than
/// evenly: the square root of (squared curvature, in units of its mean over the surface, + 0.1), with mean 1.
/// The squared curvature k1^2 + k2^2 is that of the normals, averaged over about a cell of the grid and
/// bounded. Linear interpolation errs by curvature times spacing squared, so weighting the quartic stretch by
/// the squared curvature itself would be best for a raw grid; under wavelet coding its root is (see
/// docs/flatten.md).
/// @param grid  samples a side
std::vector<double> curvatureImportance(const Mesh& mesh, int grid);

} // namespace gimg

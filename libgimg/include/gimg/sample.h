#pragma once

#include "gimg/border.h"
#include "gimg/flatten.h"
#include "gimg/image_io.h"
#include "gimg/result.h"

namespace gimg {

/// Evaluates the parameterized surface on an n x n grid, n = 2^j + 1 >= the layout's lowest level: column i,
/// row j of the image belongs to (s,t) = (i, j) / (n - 1). Border samples are taken along the cut-paths, so
/// that mates agree to the last bit and cut-nodes are hit exactly. Errors: BadArgument for a size that the
/// border was not laid out for; FlippedTriangle if a grid point lies in no triangle. Source: thesis §3.1.
Result<FloatImage> sampleGeometry(const SquareDisk& square, const Parameterization& parameterization, int n);

/// The same for object-space unit normals (area-weighted at the vertices, interpolated, normalised).
Result<FloatImage> sampleNormals(const SquareDisk& square, const Parameterization& parameterization, int n);

} // namespace gimg

#pragma once

#include "gimg/border.h"
#include "gimg/fit.h"
#include "gimg/flatten.h"
#include "gimg/image_io.h"
#include "gimg/result.h"

namespace gimg {

/// Evaluates the parameterized surface on an n x n grid, n = 2^j + 1 >= the layout's lowest level: column i,
/// row j of the image belongs to (s,t) = (i, j) / (n - 1). Mates on the
/// border agree to the last bit. Where the seam has slid off the cut-paths, faces are sampled where they lie
/// over the square. Errors: BadArgument for a size that the border was not laid out for; FlippedTriangle if a
/// grid point lies in no triangle. Source: thesis §3.1.
Result<FloatImage> sampleGeometry(const SquareDisk& square, const Parameterization& parameterization, int n);

/// The same for object-space unit normals (area-weighted at the vertices, interpolated, normalised).
Result<FloatImage> sampleNormals(const SquareDisk& square, const Parameterization& parameterization, int n);

/// Length on the surface of what lies on the border of a geometry image: seam (counted once) and boundary.
double seamLength(const GridSeam& seam, const FloatImage& geometry);

} // namespace gimg

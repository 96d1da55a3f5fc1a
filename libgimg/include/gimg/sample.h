#pragma once

#include "gimg/border.h"
#include "gimg/flatten.h"
#include "gimg/result.h"

#include <vector>

namespace gimg {

/// An n x n array of 3-vectors over the unit square: sample (i,j) at index 3 (j n + i) belongs to
/// (s,t) = (i, j) / (n - 1).
struct VectorImage
{
    int size = 0;
    std::vector<float> samples;
};

/// Evaluates the parameterized surface on an n x n grid, n = 2^j + 1 >= the layout's lowest level. Border
/// samples are taken along the cut-paths, so that mates agree to the last bit and cut-nodes are hit exactly.
/// Errors: BadArgument for a size that the border was not laid out for; FlippedTriangle if a grid point lies
/// in no triangle.
/// Source: thesis §3.1.
Result<VectorImage> sampleGeometry(const SquareDisk& square, const Parameterization& parameterization, int n);

/// The same for object-space unit normals (area-weighted at the vertices, interpolated, normalised).
Result<VectorImage> sampleNormals(const SquareDisk& square, const Parameterization& parameterization, int n);

} // namespace gimg

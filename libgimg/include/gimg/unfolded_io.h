#pragma once

#include "gimg/border.h"
#include "gimg/flatten.h"
#include "gimg/result.h"

#include <string>

namespace gimg {

/// Writes a surface with its map to the square, for viewers and other programs. The extension of `path` says
/// how:
/// - .obj: the surface in one piece, (s,t) as texture coordinates (`vt`), and each cut-path as a line (`l`);
/// - .ply: the surface opened along the cut, so that the cut is its border: a vertex on it once for each
/// copy. Binary,
///   little-endian; every vertex has `s` and `t`, every face its local stretch (see faceStretch) as
///   `quality`.
/// Numbers are float64. Where the surface has slid across the seam (see flattenToSquare), (s,t) lie outside
/// of the square. Errors: FormatUnknown for other extensions, FileNotWritable.
Status writeUnfolded(const SquareDisk& square, const Parameterization& map, const std::string& path);

} // namespace gimg

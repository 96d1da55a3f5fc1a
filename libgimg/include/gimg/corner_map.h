#pragma once

#include "gimg/color.h"
#include "gimg/mesh.h"
#include "gimg/result.h"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace gimg {

/// A map of a surface to the plane that may jump across edges: a point of the plane for every copy that the
/// map makes of a vertex, and for every corner of every face the copy it has.
struct CornerMap
{
    std::vector<Vec2> uv;
    std::vector<Triangle> corners; ///< per face of the surface, in its order: indices into `uv`

    const Vec2& at(int face, int corner) const { return uv[corners[face][corner]]; }
};

/// Writes a surface in one piece with its map. The extension of `path` says how:
/// - .obj: `uv` as texture coordinates (`vt`), faces as v/vt;
/// - .ply: binary, little-endian; every face has its six coordinates as the list `texcoord`, u and v of its
///   corners in turn, which viewers read as texture coordinates, and `quality` if that is given.
/// Numbers are float64 and written exactly; PLY's `texcoord` is float32, as viewers demand.
/// @param quality  none, or a number for each face; .obj does not hold it
/// Errors: FormatUnknown for other extensions, BadArgument where sizes or indices do not fit,
/// FileNotWritable.
Status writeCornerMap(const Mesh& mesh, const CornerMap& map, const std::string& path,
                      std::span<const double> quality = {});

/// Writes lines on a surface, and only them. The extension of `path` says how:
/// - .obj: their vertices, each line as an `l`;
/// - .ply: ascii; their vertices, and edges (`vertex1`, `vertex2`) with the number of the line as `line`.
/// A vertex that several lines pass is written once.
/// @param lines  mesh vertices in order; a closed one repeats its first vertex at the end
/// Errors: FormatUnknown for other extensions, BadArgument for indices out of range, FileNotWritable.
Status writeLines(const Mesh& mesh, std::span<const std::vector<int>> lines, const std::string& path);

/// Writes a surface with complex 1-forms to .ply: binary, little-endian, float64. Form i is the face property
/// `form_i`, a list of six numbers: real and imaginary part of the integral along the face's first edge, from
/// its first to its second vertex, then along the second and third.
/// @param forms  a number for each halfedge 3 f + k (see Halfedges)
/// Errors: FormatUnknown for other extensions, BadArgument for forms of another size, FileNotWritable.
Status writeForms(const Mesh& mesh, std::span<const Eigen::VectorXcd> forms, const std::string& path);

/// What a checkerboard looks like on a surface.
struct Checkerboard
{
    double side = 1; ///< of a field, in the units of the map
    /// Colours of the two kinds of field, a pair for each part of the surface, in turn from the first if
    /// there are more parts; no pair: sand and white.
    std::vector<std::array<Color, 2>> colors = {};
    std::vector<int> part = {};   ///< per face; empty: all in part 0
    std::vector<Vec3> marks = {}; ///< points of space to mark with red dots
    double markRadius = 0;        ///< of a dot, as a ball in space
};

/// The colour of a point of the surface, as RenderOptions::color takes it.
/// @param map  kept as a copy, as is `board`
std::function<Color(int face, const Vec3& barycentric, const Vec3& point)>
checkerboardColor(CornerMap map, Checkerboard board);

} // namespace gimg

#pragma once

#include "gimg/mesh.h"
#include "gimg/result.h"

#include <limits>
#include <vector>

namespace gimg {

/// A handle that was cut: the loop it was cut along.
struct RemovedHandle
{
    double length = 0;      ///< of the loop, in the mesh's unit
    double fraction = 0;    ///< length over the diagonal of the input's bounding box
    int edges = 0;          ///< of the loop
    Vec3 at = Vec3::Zero(); ///< mean of the loop's vertices
};

struct HandleOptions
{
    int maxGenus = 0; ///< handles go until no more than this many are left
    double maxLength = std::numeric_limits<double>::infinity(); ///< longer loops stay, in the mesh's unit
};

struct HandleRemoval
{
    Mesh mesh;                          ///< the input's faces in their order, then those that close the cuts
    std::vector<RemovedHandle> handles; ///< in the order in which they went
};

/// A handle whose loop is at most this long, over the diagonal of the bounding box, counts as noise: 257
/// samples a side are too few to show it.
inline constexpr double kNoiseHandle = 0.025;

/// Removes handles, each time the one with the shortest loop: of all closed chains of edges that do not
/// separate the surface the shortest is cut open, and both sides of the cut are closed by a fan of triangles
/// around the loop's centre (a loop of three edges by one triangle). The genus falls by one each time; area
/// grows by the two caps, which lie on each other, so the enclosed volume stays. Boundary loops stay; they
/// count as closed when it comes to what separates. Old vertices keep their order and places.
/// @param mesh  connected, manifold, oriented
/// Errors: BadArgument (a negative or undefined limit).
/// Source: Guskov and Wood 2001, "Topological noise removal"; the search is our own, see docs/topology.md.
Result<HandleRemoval> removeHandles(const Mesh& mesh, const HandleOptions& options);

/// A boundary loop that was closed.
struct ClosedHole
{
    double length = 0;      ///< of the loop, in the mesh's unit
    double fraction = 0;    ///< length over the diagonal of the input's bounding box
    int edges = 0;          ///< of the loop
    int zipped = 0;         ///< pairs of these edges that lay on each other and became one
    Vec3 at = Vec3::Zero(); ///< mean of the loop's vertices
};

struct HoleClosing
{
    Mesh mesh; ///< the input's faces in their order, then those that fill holes; all vertices in a face
    std::vector<ClosedHole> holes; ///< shortest first
};

/// Closes every boundary loop that is at most `maxLength` long. Where the loop folds back onto itself (a
/// crack without width, its two sides indexed apart) the sides become one, as far as the surface stays
/// manifold; what is left of the loop is triangulated with its own vertices, or where each way of doing that
/// would repeat an edge by a fan around its centre. The genus stays.
/// @param mesh       connected, manifold, oriented
/// @param maxLength  in the mesh's unit, >= 0
/// Errors: BadArgument (a negative or undefined length).
Result<HoleClosing> closeHoles(const Mesh& mesh, double maxLength);

} // namespace gimg

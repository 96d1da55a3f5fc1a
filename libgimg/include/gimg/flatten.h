#pragma once

#include "gimg/border.h"
#include "gimg/progress.h"
#include "gimg/result.h"

#include <vector>

namespace gimg {

/// One (s,t) for every vertex of a disk.
struct Parameterization
{
    std::vector<Vec2> st;
    double efficiency = 0; ///< stretch efficiency, see stretchEfficiency()
};

/// How samples are to be spread over the surface.
enum class Density
{
    Curvature, ///< closer where it bends: the stretch counts by the root of the squared curvature
    Even,      ///< the same everywhere: the stretch alone counts
};

/// How far the stretch is brought down.
enum class FlattenEffort
{
    Full,      ///< as far as files get smaller by it
    Trial,     ///< less far: the energy ends up a few per cent higher, which tells cuts apart
    Converged, ///< near a minimum on the finest level, where derivatives tell what moves of the border do
};

/// Maps the disk onto the unit square. The interior is coarsened, the coarse mesh gets mean-value coordinates
/// with the border where the layout put it, and vertices come back a level at a time, each placed inside its
/// ring, with the stretch of the whole level lowered before the next. From a few hundred vertices on the seam
/// slides too: with its mates glued the square is a flat surface with cone points, the surface moves freely
/// across the glued sides, and only the vertices at cone points stay. So the result maps the disk to the
/// plane, and where the seam has moved off the square's border, onto the square only after moving pieces to
/// the mates. Boundary vertices of the surface slide along their side of the square. Errors: FlippedTriangle
/// if no embedding was found. Source: Sander et al. 2002 (hierarchical stretch); Floater 2003; thesis §3.1.1;
/// the seam that slides after Aigerman & Lipman 2015 (orbifold embeddings).
Result<Parameterization> flattenToSquare(const SquareDisk& square, const Progress& progress = {},
                                         Density density = Density::Curvature);

/// The same for any density.
/// @param importance  per vertex of `square.surface`: how much the stretch of the triangles around it counts;
/// empty for 1 everywhere
Result<Parameterization> flattenToSquare(const SquareDisk& square, const std::vector<double>& importance,
                                         const Progress& progress,
                                         FlattenEffort effort = FlattenEffort::Full);

} // namespace gimg

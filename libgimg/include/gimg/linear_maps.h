#pragma once

#include "gimg/border.h"
#include "gimg/flatten.h"
#include "gimg/result.h"

#include <array>
#include <vector>

namespace gimg {

/// Maps of a disk onto the unit square with a given border. All but Stretch place each inner vertex at a
/// weighted mean of its neighbours, which one sparse linear system says for all.
enum class MapKind
{
    Stretch,   ///< flattenToSquare
    MeanValue, ///< mean-value coordinates; Floater 2003
    Tutte,     ///< equal weights; Tutte 1963, "How to draw a graph"
    Harmonic,  ///< the discrete harmonic map of the border: least Dirichlet energy, hence as conformal as a
               ///< map with this border is, by cotangent weights (Eck et al. 1995) on the intrinsic Delaunay
               ///< triangulation, where none is negative
    Conformal, ///< of a closed surface of genus 0 by way of the sphere, see ConformalSquare, and of genus 1
               ///< by way of a parallelogram, see torusToSquare; what maps disks does not know it
};

/// Those of disks.
inline constexpr std::array kMapKinds = {MapKind::Stretch, MapKind::MeanValue, MapKind::Tutte,
                                         MapKind::Harmonic};

/// "stretch", "mvc", "tutte", "harmonic" or "conformal".
const char* mapName(MapKind kind);

/// Maps the disk onto the unit square with the border where the layout put it. Linear maps shrink what sticks
/// out exponentially with its length, down to what doubles cannot tell apart; Stretch does not.
/// Errors: FlippedTriangle with the number of triangles that are flipped or have no area; BadArgument for
/// MapKind::Conformal.
/// @param density  for Stretch only
Result<Parameterization> mapToSquare(const SquareDisk& square, MapKind kind, const Progress& progress = {},
                                     Density density = Density::Curvature);

/// The same for linear maps with whatever triangles come out flipped: one (s,t) per vertex.
/// Errors: BadArgument for MapKind::Stretch and Conformal; FlippedTriangle if the system could not be solved.
Result<std::vector<Vec2>> linearMap(const SquareDisk& square, MapKind kind);

} // namespace gimg

#pragma once

#include "gimg/border.h"
#include "gimg/flatten.h"
#include "gimg/mesh.h"
#include "gimg/result.h"

#include <complex>

namespace gimg {

/// A torus on the unit square.
struct TorusMap
{
    SquareDisk square;        ///< two cut-paths, each a loop; the word of its sides is a b a' b'
    Parameterization map;     ///< off the square's border where a side of the parallelogram is no mesh edge
    std::complex<double> tau; ///< of the parallelogram, with the bottom side 1
};

/// Maps a closed surface of genus 1 to a parallelogram by its holomorphic 1-form, and that to the unit
/// square. So the map is conformal but for one linear map, the same everywhere, from the parallelogram with
/// sides 1 and tau; where tau is i it is conformal. The sides are taken as short as the surface's loops
/// allow.
/// @param options  its layout does not matter
/// Errors: those of surfaceForms and layOutBorder; WrongGenus, NotClosed; TargetUnreachable where the mesh is
/// so coarse that no two loops cross in one vertex only; FlippedTriangle where the map has flipped triangles,
/// as on limbs too long for doubles.
/// Source: thesis §7.2 and §8.2.1.
Result<TorusMap> torusToSquare(const Mesh& mesh, const BorderOptions& options);

} // namespace gimg

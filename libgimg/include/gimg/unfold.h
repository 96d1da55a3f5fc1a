#pragma once

#include "gimg/border.h"
#include "gimg/flatten.h"
#include "gimg/mesh.h"
#include "gimg/result.h"

namespace gimg {

/// A surface cut open and flattened.
struct Unfolded
{
    CutGraph cut;    ///< on the surface as given
    int extrema = 0; ///< how many findExtrema vertices the cut reaches
    SquareDisk square;
    Parameterization map;
};

/// Called with the stage, "cut" or "parameterize", and the fraction of it that is done.
using UnfoldProgress = std::function<void(const char* stage, double fraction)>;

/// Cut, layout and flattening. The cut is extended to the extrema if that is sure to help; where findExtrema
/// expects less than half the energy to go, or the extended cut does not fit the border, the surface is
/// flattened both ways and the one whose grid comes nearer to the surface is taken.
/// @param mesh  connected, manifold, oriented
/// Errors: those of layOutBorder and flattenToSquare for the initial cut.
Result<Unfolded> unfold(const Mesh& mesh, const BorderOptions& options, const UnfoldProgress& progress = {});

} // namespace gimg

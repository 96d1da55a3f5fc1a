#pragma once

#include "gimg/border.h"
#include "gimg/linear_maps.h"
#include "gimg/mesh.h"
#include "gimg/result.h"

#include <optional>

namespace gimg {

/// A surface cut open and flattened.
struct Unfolded
{
    CutGraph cut;                            ///< on the surface as given
    SquareLayout layout = SquareLayout::Cut; ///< Cut or Octahedral
    int extrema = 0; ///< how many findExtrema vertices, or tips of the star, the cut reaches
    SquareDisk square;
    Parameterization map;
};

struct UnfoldOptions : BorderOptions
{
    MapKind param = MapKind::Stretch; ///< layouts and extrema are judged by Stretch whatever it is
    Density density = Density::Curvature;
    /// How many of findExtrema's vertices the cut is extended to, the first ones, whether or not that helps
    /// (fewer if fewer are found): the iterations of the cut one by one. Implies SquareLayout::Cut. None: as
    /// many as help.
    std::optional<int> extrema = std::nullopt;
};

/// Called with the stage, "cut" or "parameterize", and the fraction of it that is done.
using UnfoldProgress = std::function<void(const char* stage, double fraction)>;

/// How good an unfolding is; more is better. One without functions goes by quarticStretchEnergy. They may be
/// called from two threads at a time.
struct UnfoldJudge
{
    std::function<double(const Unfolded&)> coded; ///< dB of a small file
    std::function<double(const Unfolded&)> bare;  ///< dB of the grid itself
};

/// Cut, layout and flattening. MapKind::Conformal is for tori, see torusToSquare. Closed surfaces of genus 0
/// get the octahedral layout, unless a simplified mesh shows that samples spread far more evenly along an
/// extended cut. The others are cut to a disk, and the cut is extended to the extrema if that is sure to
/// help; where findExtrema expects less than half the energy to go, the surface is flattened both ways and
/// the one that `judge` finds better is taken. An extended cut that does not fit the border, or whose map
/// fails, is not taken. Then a better layout of the border is looked for (see docs/border.md); below 20,000
/// faces the mesh is flattened in it too, and it is taken if `judge` finds the small file better and the bare
/// grid no worse than by 0.2 dB.
/// @param mesh   connected, manifold, oriented
/// @param judge  if there is none, less of quarticStretchEnergy is better
/// Errors: those of layOutBorder, mapToSquare and torusToSquare; BadArgument where the octahedral layout is
/// asked for and the surface is not closed or has handles, or a number of extrema is; TargetUnreachable where
/// no star was found.
Result<Unfolded> unfold(const Mesh& mesh, const UnfoldOptions& options, const UnfoldJudge& judge = {},
                        const UnfoldProgress& progress = {});

} // namespace gimg

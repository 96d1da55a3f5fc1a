#pragma once

#include "gimg/border.h"

namespace gimg {

struct ImprovedLayout
{
    BorderLayout layout;
    double energy = 1; ///< expected, as a fraction of the first layout's
};

/// A better layout for the same cut and lowest level: where the square's corners fall and how long each path
/// is. Layouts are judged by the stretch of the surface simplified around the cut, which counts by squared
/// curvature, as the error of a grid does. First the start is turned, and a torus also laid out without any
/// cone point; then start and lengths are moved as long as that lowers the energy (LayoutModel tells which
/// moves are worth trying); last, multiples of 2 and of 4 are taken where they cost less than 1 % each. Some
/// thirty flattenings in all.
/// @param first  sound, to begin with; it comes back where nothing else is better by 5 %
ImprovedLayout improveLayout(const Mesh& mesh, const CutGraph& cut, const BorderLayout& first);

} // namespace gimg

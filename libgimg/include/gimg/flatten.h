#pragma once

#include "gimg/border.h"
#include "gimg/result.h"

#include <functional>
#include <vector>

namespace gimg {

/// One (s,t) in the unit square for every vertex of a disk.
struct Parameterization
{
    std::vector<Vec2> st;
    double efficiency = 0; ///< stretch efficiency, see stretchEfficiency()
};

/// Called now and then with the fraction done, in [0,1].
using Progress = std::function<void(double)>;

/// Maps the disk onto the unit square with the border where the layout put it. The interior is coarsened, the
/// coarse mesh gets mean-value coordinates, and vertices come back a level at a time, each placed inside its
/// ring, with the stretch of the whole level lowered before the next.
/// Errors: FlippedTriangle if no embedding was found.
/// Source: Sander et al. 2002 (hierarchical stretch); Floater 2003; thesis §3.1.1.
Result<Parameterization> flattenToSquare(const SquareDisk& square, const Progress& progress = {});

} // namespace gimg

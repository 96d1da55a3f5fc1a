#pragma once

#include "conformal/closed_surface.h"
#include "gimg/homology.h"

namespace gimg {

/// See canonicalBasis() of a PolyhedralSurface. @param surface  of genus >= 1
Result<CanonicalBasis> canonicalBasis(const ClosedSurface& surface);

} // namespace gimg

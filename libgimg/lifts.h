#pragma once

#include "border_ties.h"
#include "gimg/border.h"
#include "gimg/result.h"

#include <vector>

namespace gimg {

/// A face of the disk where it lies over the square: its corners' (s,t), moved.
struct Lift
{
    int face = 0;
    GridMotion motion;
};

/// Every way in which a face lies over the unit square once the seam has slid off the square's border: found
/// by walking inside the square from face to face. Each face comes at least once; the parts of it inside the
/// square add up to the whole. Errors: FlippedTriangle where they do not.
Result<std::vector<Lift>> liftsOverSquare(const SquareDisk& square, const BorderTies& ties,
                                          const std::vector<Vec2>& st);

} // namespace gimg

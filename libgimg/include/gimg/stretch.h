#pragma once

#include "gimg/mesh.h"

#include <vector>

namespace gimg {

/// L2 geometric stretch of a parameterization: the sum over faces of A(T) L2(T)^2, with A(T) the area on the
/// surface, L2(T)^2 = (|Ss|^2 + |St|^2) / 2 and S the map from the parameter square to the surface.
/// Infinite if a triangle is flipped or degenerate in the plane.
/// @param st  one position in the unit square per vertex
/// Source: Sander et al. 2001.
double stretchEnergy(const Mesh& mesh, const std::vector<Vec2>& st);

/// The sum over faces of A(T) L2(T)^4, which minimizeStretch lowers. Infinite as above.
double quarticStretchEnergy(const Mesh& mesh, const std::vector<Vec2>& st);

/// A^2 / stretchEnergy with A the surface area: 1 for an isometry, less the more unevenly samples spread.
double stretchEfficiency(const Mesh& mesh, const std::vector<Vec2>& st);

/// Local stretch of every face, L2(T) / sqrt(A) with A the surface area: 1 everywhere for an isometry of a
/// square, up to scale; the greater, the farther apart samples land. Its mean square over the surface is 1 /
/// stretchEfficiency. Infinite for a triangle that is flipped or degenerate in the plane.
std::vector<double> faceStretch(const Mesh& mesh, const std::vector<Vec2>& st);

/// Number of triangles whose signed area in the plane is not positive.
int flippedTriangles(const std::vector<Triangle>& faces, const std::vector<Vec2>& st);

struct DescentOptions
{
    int maxIterations = 50;
    double tolerance = 1e-4; ///< stop when an iteration lowers the energy by less than this fraction
};

/// Lowers sum A(T) L2(T)^4 by Newton steps with a convexified Hessian; a line search keeps every triangle
/// positively oriented. (The fourth power rather than Sander's second, because that is how the error of
/// linear interpolation grows: on the bunny it is worth 1.2 dB at 257 x 257.) `st` must start without flipped
/// triangles. Returns the final sum.
double minimizeStretch(const Mesh& mesh, const std::vector<bool>& fixed, std::vector<Vec2>& st,
                       const DescentOptions& options);

} // namespace gimg

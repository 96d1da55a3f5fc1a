#pragma once

#include "gimg/mesh.h"
#include "gimg/result.h"
#include "gimg/sphere_map.h"

#include <vector>

namespace gimg {

/// The Gauss map: every vertex to its unit normal. On a surface that is not convex it folds. Where a vertex
/// has no normal, the direction from the surface's middle stands in. Source: thesis section 5.2.
std::vector<Vec3> gaussMap(const Mesh& mesh);

/// Sums over edges of weight |h(u) - h(v)|^2 / 2.
enum class SphereEnergy
{
    Barycentric, ///< of weight 1 (thesis, equation 63)
    Harmonic,    ///< of cotangent weights on the intrinsic Delaunay triangulation (equations 34 and 57): the
                 ///< Dirichlet energy, near 4 pi for a conformal map
};

struct SphereDescentOptions
{
    int mostSteps = 2000;
    double tolerance = 1e-10; ///< done when a step lowers the energy by less, as a fraction of it
};

/// What the descent reached.
struct SphereDescent
{
    SphereMap map;
    double energyBefore = 0; ///< of the start, centred
    double energy = 0;
    double residual = 0; ///< length of the energy's gradient along the sphere, in the norm dual to the
                         ///< preconditioner's, over the root of the energy: 0 for a harmonic map
    int steps = 0;
};

/// The thesis's way to the sphere, kept as a reference for sphereMap(): a barycentric or harmonic map by
/// descent from any start, triangles folded or not. The gradient's part along the sphere is divided by the
/// energy's own Laplacian, so that the number of steps does not grow with the mesh, and after each step a
/// Moebius map brings the mass centre back. (Without that both energies fall to 0, all vertices in one
/// point.) Nothing keeps triangles from flipping, and map.flipped says how many have.
/// @param mesh   as for sphereMap()
/// @param start  one unit vector per vertex
/// Errors: those of sphereMap() for the mesh; BadArgument for the start, or if half of the mass comes to lie
/// in one point. Source: thesis section 5.2, Algorithms 1 and 2; the Moebius map as centringMass().
Result<SphereDescent> descendOnSphere(const Mesh& mesh, const std::vector<Vec3>& start, SphereEnergy energy,
                                      const SphereDescentOptions& options = {});

} // namespace gimg

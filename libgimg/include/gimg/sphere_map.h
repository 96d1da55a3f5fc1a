#pragma once

#include "gimg/conformality.h"
#include "gimg/flatten.h"
#include "gimg/mesh.h"
#include "gimg/moebius.h"
#include "gimg/result.h"

#include <vector>

namespace gimg {

struct SphereMapOptions
{
    bool centre = true; ///< bring the mass centre to the sphere's by a Moebius map
    int smoothing =
        10; ///< times that vertices are moved one by one for the shapes of the triangles around them
};

/// A surface on the unit sphere.
struct SphereMap
{
    std::vector<Vec3> position;     ///< of every vertex, of length 1
    Conformality quality;           ///< the triangles of the sphere taken as flat ones
    Vec3 massCentre = Vec3::Zero(); ///< mean of the map over the surface's area
    int flipped = 0;       ///< triangles of which the sphere is on the wrong side; 0 from sphereMap()
    int flippedBefore = 0; ///< triangles that were flipped before untangling
    int untangled = 0;     ///< vertices that untangling has moved
    int inflated = 0;      ///< vertices of limbs too long for doubles, which are wider than conformal
};

/// Maps a closed surface of genus 0 conformally onto the unit sphere, as far as triangles can be: none is
/// flipped, the mass centre is the sphere's, and of the rotations that this leaves open the one is taken that
/// keeps the surface nearest to itself. A surface without one triangle is mapped to the plane by a linear
/// system that cannot fold it, and lifted; two more linear systems mend what that triangle spoilt; then
/// single vertices are moved where triangles are flipped, and for the shapes of triangles. Same input, same
/// output, bit for bit.
/// @param mesh  one closed, oriented, manifold surface of genus 0, every vertex in a face
/// Errors: NotClosed, WrongGenus, SeveralComponents, NonManifoldEdge, NonManifoldVertex, ZeroAreaFace (names
/// the first one), NotFinite, EmptyMesh, BadArgument (a vertex in no face); FlippedTriangle with the number
/// of triangles that could not be untangled; TargetUnreachable if untangling and centring undo each other;
/// SolverFailure.
/// Source: thesis chapter 5; Haker et al. 2000, "Conformal surface parameterization for texture mapping";
/// Choi, Lam, Lui 2015, "FLASH" (one pole at a time); see docs/sphere.md.
Result<SphereMap> sphereMap(const Mesh& mesh, const SphereMapOptions& options = {},
                            const Progress& progress = {});

/// A third of the areas of the faces around each vertex: what masses are for the centre of a map.
std::vector<double> vertexMasses(const Mesh& mesh);

/// The sign of det(a, b, c): 1 if the triangle runs counter-clockwise seen from outside the sphere, 0 if its
/// corners lie on a great circle. Exact (unless products of three coordinates underflow).
int sphereOrientation(const Vec3& a, const Vec3& b, const Vec3& c);

/// How many triangles have an orientation on the sphere other than 1.
int flippedOnSphere(const std::vector<Triangle>& faces, const std::vector<Vec3>& position);

} // namespace gimg

#pragma once

#include "gimg/mesh.h"
#include "gimg/moebius.h"
#include "gimg/result.h"
#include "gimg/sphere_map.h"

#include <array>
#include <utility>
#include <vector>

namespace gimg {

/// A point of a mesh.
struct SurfacePoint
{
    int face = -1;
    Vec3 barycentric = Vec3::Zero(); ///< weights of the face's corners, 0 to 1, with sum 1
};

Vec3 pointAt(const Mesh& mesh, const SurfacePoint& point);

/// Finds the triangle of a map to the sphere that a direction from its centre pierces.
class SphereLocator
{
public:
    /// Errors: FlippedTriangle if some triangle is flipped or flat: such a map covers points more than once.
    /// EmptyMesh, BadArgument if faces are none, or no closed surface over the positions.
    static Result<SphereLocator> of(const std::vector<Triangle>& faces, const std::vector<Vec3>& position);

    /// Walks there across edges; the side tests are exact, so a triangle is found that holds the direction.
    /// @param direction  not zero
    /// @param near       a face; one close by saves time
    SurfacePoint locate(const Vec3& direction, int near = 0) const;

private:
    SphereLocator(std::vector<Triangle> faces, std::vector<Vec3> position);

    std::vector<Triangle> faces_;
    std::vector<Vec3> position_;
    Halfedges he_;
};

/// Where each of some points of the sphere lies on a surface, after a Moebius map: with the vertices of one
/// sphere map and the surface of another, the conformal map between the two surfaces. Source: thesis
/// chapter 5.
/// @param to       a closed surface
/// @param between  from the sphere of the points to the sphere of `toSphere`
/// Errors: those of SphereLocator::of.
Result<std::vector<SurfacePoint>> mapThroughSphere(const std::vector<Vec3>& points, const Moebius& between,
                                                   const Mesh& to, const SphereMap& toSphere);

/// The Moebius map that brings landmarks together: three pairs exactly, more of them in the sense of
/// bestMoebius().
/// @param pairs  vertices of the first and of the second surface
/// Errors: BadArgument for fewer than three pairs, vertices that do not exist, or three landmarks of which
/// two coincide.
Result<Moebius> alignLandmarks(const SphereMap& from, const SphereMap& to,
                               const std::vector<std::pair<int, int>>& pairs);

/// The rotation for which two maps with their mass centres in the sphere's agree best on how much they
/// enlarge the surface: the largest correlation of the logarithms of area on the sphere over area on the
/// surface, from a grid of rotations on, refined. Two maps of one shape, however meshed, differ by it; shapes
/// with a symmetry have several as good. Source: Baden, Crane, Kazhdan 2018, "Moebius registration", with
/// sampling in place of their transforms.
/// @param correlation  if not null: what was reached, 1 for the same shape
/// Errors: those of SphereLocator::of.
Result<Eigen::Matrix3d> alignRotation(const Mesh& from, const SphereMap& fromSphere, const Mesh& to,
                                      const SphereMap& toSphere, double* correlation = nullptr);

/// A part of a surface in the plane.
struct PlanarChart
{
    std::vector<int> faces;
    std::vector<std::array<Vec2, 3>> corners; ///< per face of the chart: counter-clockwise
};

/// The two stereographic projections of a sphere map: faces whose middle lies in the upper half from the
/// south pole, the others from the north pole, turned so that orientation stays. Both charts reach a little
/// beyond the unit disk. Source: thesis section 5.3.
std::array<PlanarChart, 2> stereographicCharts(const std::vector<Triangle>& faces,
                                               const std::vector<Vec3>& position);

} // namespace gimg

#pragma once

#include "gimg/fit.h"
#include "gimg/image_io.h"
#include "gimg/mesh.h"
#include "gimg/result.h"
#include "gimg/sphere_correspondence.h"
#include "gimg/sphere_map.h"

#include <memory>

namespace gimg {

/// The point of the unit sphere for a point of the unit square: with the lemniscate sine sl, whose period is
/// 2 w, the stereographic projection of it is sl(w (s - 1/2) + i w (t - 1/2)). Conformal but in the middles
/// of the four sides, which become (0, -1, 0), (1, 0, 0), (0, 1, 0) and (-1, 0, 0): around each, half a turn
/// becomes a full one. Points of a side as far from its middle become the same; the corners the south pole,
/// the square's centre the north pole. Source: Peirce 1879, "A quincuncial projection of the sphere"; the
/// seam is that of SquareLayout::Octahedral.
Vec3 sphereOfSquare(const Vec2& st);

/// Area of the square over area of the sphere for sphereOfSquare(), at a point of the sphere: how densely a
/// grid samples there. Infinite at the four middles, where it grows with the inverse of the distance.
double squareDensity(const Vec3& onSphere);

/// The seam of a square each side of which is folded in its middle.
/// @param lowest  samples a side of the lowest level, 2^l + 1, at least 5
GridSeam foldedSquareSeam(int lowest);

/// The Moebius map after which sphereOfSquare() spreads its samples best over the surface: the least mean,
/// over the surface's area, of the distance between samples, found by descent from many rotations. Where
/// limbs come to lie in the middles of sides, which are sampled most densely, that helps them most.
/// @param position  of each vertex on the sphere
Moebius placementOnSquare(const Mesh& mesh, const std::vector<Vec3>& position);

/// A closed surface of genus 0 on the unit square by a conformal map, but for four points: a conformal
/// geometry image. Source: thesis section 8.2.1; sphereMap(), sphereOfSquare().
class ConformalSquare
{
public:
    /// Errors: those of sphereMap().
    static Result<ConformalSquare> of(const Mesh& mesh, const Progress& progress = {});

    /// Column i, row j of the image belongs to (s,t) = (i, j) / (n - 1). Samples that the seam glues agree to
    /// the last bit. Errors: BadArgument unless n is 2^j + 1, 5 to 4097.
    Result<FloatImage> geometry(int n) const;
    /// Object-space unit normals.
    Result<FloatImage> normals(int n) const;

    const Mesh& surface() const { return *surface_; }
    const SphereMap& sphere() const { return sphere_; }
    /// From the sphere of sphereOfSquare() to that of sphere(): the inverse of placementOnSquare().
    const Moebius& toSphere() const { return toSphere_; }

private:
    ConformalSquare(const Mesh& mesh, SphereMap sphere, const Moebius& toSphere, SphereLocator locator);
    Result<std::vector<Vec3>> sample(const std::vector<Vec3>& value, int n) const;

    std::shared_ptr<const Mesh> surface_;
    SphereMap sphere_;
    Moebius toSphere_;
    SphereLocator locator_;
};

} // namespace gimg

#pragma once

#include "gimg/mesh.h"
#include "gimg/result.h"

#include <memory>
#include <span>
#include <vector>

namespace gimg {

/// The point of a surface nearest to another point.
struct NearestPoint
{
    Vec3 point = Vec3::Zero();
    int face = -1;
    Vec3 barycentric = Vec3::Zero(); ///< weights of the face's corners, 0 to 1
    double distance = 0;             ///< 0 where it is not above rounding
};

/// Finds nearest points of one mesh. The mesh is copied; topology does not matter, and triangles without area
/// count as segments or points. All calls are thread-safe.
class NearestSurface
{
public:
    /// Errors: EmptyMesh (no faces), NotFinite, BadArgument (an index out of range, or above the range
    /// of numbers).
    static Result<NearestSurface> of(const Mesh& mesh);

    ~NearestSurface();
    NearestSurface(NearestSurface&&) noexcept;
    NearestSurface& operator=(NearestSurface&&) noexcept;

    /// Of faces at the same distance the first is given.
    /// @param q     finite, at most 1e9 times the mesh's size away
    /// @param near  a guess: the face that a query close by gave saves time; no guess changes the answer
    NearestPoint to(const Vec3& q, int near = 0) const;

    /// The unit normal at the point nearest to q, as DistanceOptions::normals compares it; zero where there
    /// is none.
    Vec3 normalNearest(const Vec3& q, int near = 0) const;

    /// Distances of many points, in parallel; quickest where neighbours in the list are close to each other.
    /// @param threads  at most one a core; 0: as many. The distances do not depend on it.
    std::vector<double> distances(std::span<const Vec3> points, int threads = 0) const;

private:
    struct Parts;
    explicit NearestSurface(std::unique_ptr<const Parts> parts);

    std::unique_ptr<const Parts> parts_;
};

} // namespace gimg

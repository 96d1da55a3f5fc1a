#pragma once

#include "gimg/mesh.h"
#include "gimg/result.h"

#include <cstdint>
#include <memory>

namespace gimg {

struct DistanceOptions
{
    int samples = 200000; ///< on each surface, spread evenly over its area
    uint64_t seed = 1;    ///< same seed, same samples
    int threads = 0;      ///< at most one a core; 0: as many. The numbers do not depend on it.
};

/// How far two surfaces are apart, in the unit of the coordinates. Distances are from points of one surface
/// to the nearest point of the other: the root mean square over the samples, and the maximum over samples and
/// vertices.
struct SurfaceDistance
{
    double diagonal = 0; ///< of the reference's bounding box
    double rmsRefToTest = 0;
    double rmsTestToRef = 0;
    double maxRefToTest = 0;
    double maxTestToRef = 0;
    Vec3 maxRefToTestAt = Vec3::Zero(); ///< the point of the reference farthest from the test surface
    Vec3 maxTestToRefAt = Vec3::Zero(); ///< the point of the test surface farthest from the reference

    /// The larger of the two one-sided values.
    double rms() const;
    double hausdorff() const;
    /// 20 log10(diagonal / rms) in dB; +infinity where the surfaces agree in every sample.
    double psnr() const;
};

/// Compares surfaces with one reference. What belongs to the reference (samples, tree) is made once, so that
/// a search over many candidates pays only for the candidate.
class SurfaceMeasure
{
public:
    explicit SurfaceMeasure(const Mesh& reference, const DistanceOptions& options = {});
    ~SurfaceMeasure();
    SurfaceMeasure(SurfaceMeasure&&) noexcept;
    SurfaceMeasure& operator=(SurfaceMeasure&&) noexcept;

    /// Thread-safe. Neither mesh need be manifold; triangles without area take part as segments or points.
    /// Errors: EmptyMesh (a mesh without area), NotFinite, BadArgument (no samples, an index out of range, or
    /// meshes that differ in size or place by a factor above 1e9); those of the reference are reported here
    /// too.
    Result<SurfaceDistance> against(const Mesh& test) const;

private:
    struct Reference;
    std::unique_ptr<const Reference> reference_;
};

/// One shot of SurfaceMeasure.
Result<SurfaceDistance> compareSurfaces(const Mesh& reference, const Mesh& test,
                                        const DistanceOptions& options = {});

} // namespace gimg

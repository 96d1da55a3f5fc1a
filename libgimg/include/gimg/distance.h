#pragma once

#include "gimg/mesh.h"
#include "gimg/result.h"

#include <cstdint>
#include <memory>
#include <optional>

namespace gimg {

struct DistanceOptions
{
    int samples = 200000; ///< on each surface, spread evenly over its area
    uint64_t seed = 1;    ///< same seed, same samples
    int threads = 0;      ///< at most one a core; 0: as many. The numbers do not depend on it.
    bool normals = false; ///< compare normals too
    double quantile = 0;  ///< in (0, 1]: find this quantile of the samples' distances too
};

/// Angles between the normals of two surfaces, in degrees: 0 to 180, which is the same surface turned inside
/// out.
struct NormalError
{
    double rms = 0;
    double mean = 0;
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
    double quantileRefToTest = 0;       ///< no more than this is the distance of DistanceOptions::quantile
    double quantileTestToRef = 0;       ///< of all samples; 0 where it is not asked for

    /// At every sample the angle between the normal of its face and that of the other surface at the nearest
    /// point: of the face there, or on an edge or in a vertex the angle-weighted mean of the faces that meet.
    /// Samples for which one of the two does not exist (faces without area, faces back to back) take no part.
    /// None: not asked for, or no sample was left.
    std::optional<NormalError> normalsRefToTest;
    std::optional<NormalError> normalsTestToRef;

    /// The larger of the two one-sided values, in degrees; none where one is missing.
    std::optional<double> normalRms() const;

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

#pragma once

#include "glued_grid.h"

#include "gimg/nearest.h"

#include <memory>
#include <span>
#include <vector>

namespace gimg {

/// A mesh to slide along: nearest points and the normals of faces.
struct SlideSurface
{
    static Result<SlideSurface> of(const Mesh& mesh);

    NearestSurface nearest;
    std::vector<Vec3> faceNormals; ///< unit vectors, zero for faces without area
};

/// Lets the samples of a geometry image slide while they are coded. Where along the surface a sample lies
/// hardly matters for the surface, but costs bytes: so it is coded, and the point of the mesh nearest to
/// where the decoder puts it becomes its new target.
///
/// Fitted samples lie a little off the mesh, on the outer side where it bulges; they keep that distance.
/// Samples on the surface's own boundary stay where they are, and a sample that would jump, come to face the
/// other way or fold a cell over keeps its target.
class SampleSlide
{
public:
    /// @param image  the samples as fitted; glued ones equal
    /// Errors: as GluedGrid::of.
    static Result<SampleSlide> of(std::shared_ptr<const SlideSurface> surface, const GridSeam& seam,
                                  const FloatImage& image);

    /// Moves the targets, 3 numbers for each sample; see codec::Retarget.
    void operator()(std::span<const float> decoded, std::span<float> targets);

private:
    SampleSlide(std::shared_ptr<const SlideSurface> surface, GluedGrid grid, const FloatImage& image);

    void keepCellsUnfolded(const std::vector<Vec3>& before, std::vector<Vec3>& after,
                           const std::vector<Triangle>& faces) const;

    std::shared_ptr<const SlideSurface> surface_;
    GluedGrid grid_;
    std::vector<double> height_; ///< of vertices above the mesh, along its normal
    std::vector<int> hint_;      ///< the face a vertex was nearest to before
};

} // namespace gimg

#pragma once

#include "codec/encode.h"
#include "gimg/encode.h"
#include "gimg/nearest.h"
#include "gimg/vertex_attribute.h"

namespace gimg {

/// An attribute on the grid of a geometry image.
struct SampledAttribute
{
    codec::AttributeSource source; ///< its samples are those here
    std::vector<float> samples;
};

/// The attributes that were asked for, wherever the samples of an image lie.
///
/// A sample has the attributes of the point of the surface that is nearest to it, on the side that it faces,
/// interpolated in the triangle there.
class AttributeSampler
{
public:
    /// Errors: BadArgument (no such attribute: says which there are; a grid size), NotFinite.
    static Result<AttributeSampler> of(const AttributedSurface& surface,
                                       const std::vector<AttributeRequest>& requests);

    /// @param geometry  as decoded
    /// Errors: BadArgument for a grid that the seam does not fit.
    Result<std::vector<SampledAttribute>> at(const FloatImage& geometry, const GridSeam& seam) const;

private:
    struct Asked
    {
        VertexAttribute attribute;
        int grid; ///< 0: the geometry's
        bool lossless, glued;
    };
    AttributeSampler(NearestSurface nearest, const Mesh& mesh, std::vector<Asked> asked);

    NearestPoint nearestFacing(const Vec3& point, const Vec3& normal, int near) const;

    NearestSurface nearest_;
    std::vector<Triangle> faces_;
    std::vector<Vec3> normals_; ///< of faces
    double diagonal_;
    std::vector<Asked> asked_;
};

} // namespace gimg

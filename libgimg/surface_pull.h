#pragma once

#include "area_sampler.h"
#include "block_system.h"
#include "nearest_tree.h"

#include <vector>

namespace gimg {

/// Draws a triangulated surface to a mesh: places on one are paired with the nearest ones on the other, both
/// ways, and every pair asks the triangle to close the gap. Across the mesh it insists, along it hardly: that
/// models the squared distance between surfaces, not that between the two points.
class SurfacePull
{
public:
    /// @param mesh     with normals
    /// @param samples  drawn on the mesh, evenly over its area
    SurfacePull(NearestTree mesh, int samples);

    const NearestTree& mesh() const { return mesh_; } ///< with normals

    /// The normal equations for steps of the surface's vertices, one entry a triangle. A pair counts by area.
    /// Pairs of places that face away from each other do not count.
    std::vector<TriangleEquations> equations(const std::vector<Vec3>& positions,
                                             const std::vector<Triangle>& faces);

private:
    struct Surface;
    struct Pair;

    void findHits(const Surface& surface);
    TriangleEquations onFace(const Surface& surface, int face, const std::vector<Vec3>& places,
                             int& near) const;

    /// The place on the surface nearest to a sample of the mesh.
    struct Hit
    {
        int face = 0;
        Vec3 weights;
    };

    NearestTree mesh_;
    std::vector<AreaSampler::Sample> samples_;
    double sampleArea_ = 0;
    std::vector<Hit> hits_;             ///< one a sample
    std::vector<int> firstOf_, byFace_; ///< samples that hit a face: byFace_[firstOf_[face] ...]
};

} // namespace gimg

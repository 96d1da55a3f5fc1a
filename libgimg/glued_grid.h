#pragma once

#include "gimg/fit.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace gimg {

/// Half the cross product of two sides: as long as the triangle is large, and along its normal.
inline Vec3 areaVector(const std::vector<Vec3>& positions, const Triangle& t)
{
    return (positions[t[1]] - positions[t[0]]).cross(positions[t[2]] - positions[t[0]]) / 2;
}

/// What keeps an image from being square samples that are finite (BadArgument, NotFinite).
std::optional<Error> objectionToImage(const FloatImage& image);

/// The surface that the decoder makes of a geometry image: glued samples are one vertex.
class GluedGrid
{
public:
    static constexpr int kNone = -1;

    /// Errors: BadArgument for a faulty seam, or a size that is no refinement of its lowest level.
    static Result<GluedGrid> of(const GridSeam& seam, int n);

    int side() const { return n_; }
    int vertexCount() const { return static_cast<int>(sampleOf_.size()); }
    int vertexOf(int sample) const { return vertexOf_[sample]; }           ///< sample j * side + i
    int sampleOf(int vertex) const { return sampleOf_[vertex]; }           ///< the first of its samples
    bool onBoundary(int vertex) const { return onBoundary_[vertex] != 0; } ///< of the surface

    /// The vertices one step to either side of a vertex, in both directions of the grid and across the seam;
    /// kNone throughout where grid lines do not run on: on the surface's boundary, at cut-nodes and at the
    /// square's corners.
    const std::array<int, 4>& around(int vertex) const { return around_[vertex]; }

    /// Where the vertices are, by 3 numbers for each sample.
    std::vector<Vec3> positions(std::span<const float> samples) const;

    /// The decoder's triangles: two a cell, cell by cell in rows.
    std::vector<Triangle> faces(const FloatImage& image) const;

private:
    void findBoundary(const GridSeam& seam);
    void findNeighbours(const std::vector<uint32_t>& classes);

    int n_ = 0;
    std::vector<uint32_t> vertexOf_, sampleOf_;
    std::vector<uint8_t> onBoundary_;
    std::vector<std::array<int, 4>> around_;
};

} // namespace gimg

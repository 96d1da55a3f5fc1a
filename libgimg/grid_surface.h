#pragma once

#include "block_system.h"
#include "glued_grid.h"
#include "nearest_tree.h"
#include "surface_pull.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace gimg {

/// The surface between the samples of an image, glued samples as one vertex, in the frame of the mesh: what
/// fits move.
class GridSurface
{
public:
    /// How a vertex may move.
    enum class Freedom : uint8_t
    {
        Any,
        Along, ///< a line
        None
    };
    struct Rail
    {
        Freedom freedom = Freedom::Any;
        Vec3 direction = Vec3::Zero(); ///< of the line, of unit length
    };

    /// All must outlive it. Vertices on the surface's boundary may not move.
    GridSurface(const GluedGrid& grid, const UnitFrame& frame, const FloatImage& image);

    const FloatImage& image() const { return image_; }
    const std::vector<Vec3>& positions() const { return positions_; }
    const std::vector<Triangle>& faces() const { return faces_; }
    bool isFixed(int vertex) const { return fixed_[vertex]; }

    /// One round of the fit.
    /// @param rails  one a vertex, or none
    void fit(SurfacePull& pull, double smoothing, const std::vector<Rail>& rails = {});

    /// Needed for what follows; made when it is needed.
    void findCells();

    /// Moves one vertex, rounded as the image rounds it; its cells' diagonals follow.
    void place(int vertex, const Vec3& to);

    /// The cells at a vertex; the triangles of cell k are faces()[2 k] and faces()[2 k + 1].
    std::span<const int> cellsAt(int vertex) const
    {
        return {cells_.data() + firstCell_[vertex], cells_.data() + firstCell_[vertex + 1]};
    }

private:
    BlockSystem equations(SurfacePull& pull, double smoothing, const std::vector<Rail>& rails) const;
    void hold(double smoothing, const std::vector<Rail>& rails, std::vector<SymmetricBlock>& own,
              std::vector<Vec3>& right) const;
    Vec3 offMiddle(int v) const;
    void shortenWhereCellsFold(std::vector<Vec3>& step) const;
    std::vector<bool> cornersOfFolds(const std::vector<Vec3>& moved) const;
    FloatImage imageOf(const std::vector<Vec3>& positions) const;
    void take(const std::vector<Vec3>& positions);
    void splitAgain(int cell);

    const GluedGrid& grid_;
    const UnitFrame& frame_;
    FloatImage image_;
    std::vector<Triangle> faces_;
    std::vector<Vec3> positions_;
    std::vector<bool> fixed_;
    std::vector<int> firstSample_, samples_, firstCell_, cells_; ///< by vertex
};

/// Samples drawn on the mesh for SurfacePull: as many as the image has, more if they are few.
int pullSamplesFor(int pixels);

/// Glued samples that differ (BadArgument).
std::optional<Error> objectionToMates(const FloatImage& image, const GluedGrid& grid);

/// Errors: BadArgument (an image that is not square, a seam that does not fit it, glued samples that differ),
/// NotFinite.
Result<GluedGrid> gridOf(const FloatImage& image, const GridSeam& seam);

/// What is out of range among the options of a fit (BadArgument).
std::optional<Error> objectionToRounds(int rounds, double smoothing, int threads);

/// The decoder's triangles.
Mesh meshOf(const GluedGrid& grid, const FloatImage& image);

} // namespace gimg

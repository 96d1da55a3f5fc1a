#pragma once

#include "grid_surface.h"
#include "nearest_tree.h"

#include <vector>

namespace gimg {

/// Moves single vertices of a grid where the cells around them come closer to the mesh by it.
class CellMover
{
public:
    /// Both must outlive it.
    /// @param mesh  with normals
    CellMover(GridSurface& surface, const NearestTree& mesh);

    /// Moves a vertex unless its cells are worse then, or fold over.
    /// @param wanted  a point of the mesh: that its cells miss it counts too
    bool tryMove(int vertex, const Vec3& to, const Vec3& wanted);

    /// A measure of the distance between the cells at a vertex and the mesh, and a point of the mesh and
    /// them.
    double errorAt(int vertex, const Vec3& wanted) const { return qualityAt(vertex, wanted).error; }

    /// A triangle of the grid and a point of the mesh that should be close to it.
    struct Apart
    {
        double distance2 = -1;
        int face = 0;
        Vec3 point = Vec3::Zero();
    };

    /// Where grid and mesh are farther apart than `negligible` and at least half as far as where they are
    /// farthest; worst first, no more than 500.
    std::vector<Apart> farthestApart(double negligible) const;

private:
    struct Quality
    {
        double error = 0;
        double facing = 1; ///< the least cosine between a triangle's normal and the mesh's
    };

    Quality qualityAt(int vertex, const Vec3& wanted) const;
    Apart apartFromMesh(int face, int& near) const;
    Apart apartFromGrid(const NearestTree& grid, int meshFace, int& near) const;

    GridSurface& surface_;
    const NearestTree& mesh_;
};

} // namespace gimg

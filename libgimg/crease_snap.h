#pragma once

#include "cell_mover.h"
#include "crease_net.h"
#include "grid_surface.h"

#include <optional>
#include <vector>

namespace gimg {

/// Moves vertices of the grid onto creases of the mesh, where grid edges cross them, and remembers which.
class CreaseSnap
{
public:
    /// All must outlive it.
    /// @param net   with a segment at least
    /// @param mesh  with normals
    CreaseSnap(GridSurface& surface, const CreaseNet& net, const NearestTree& mesh);

    /// Gives every corner a vertex, then every crossing one, each only if the cells there are closer to the
    /// mesh by it.
    void snap();

    /// How vertices on creases may move: along them; those on corners not at all.
    std::vector<GridSurface::Rail> rails() const;

    /// Brings vertices back that steps along straight lines took off a crease that bends.
    void bringBack();

    /// Moves vertices a little where the grid and the mesh are farthest apart: any along the mesh, those on
    /// creases along them.
    /// @param negligible  distance from which on it is worth it
    void easeWorst(double negligible);

    int onCreases() const; ///< vertices
    int onCorners() const; ///< vertices
    int crossings() const; ///< grid edges that still cross a crease

private:
    /// Where a vertex is held: by a segment, by a corner, or (-1) not.
    struct Hold
    {
        int segment = -1, corner = -1;
        bool free() const { return segment < 0 && corner < 0; }
    };

    /// A grid edge with its ends on different sides of a crease.
    struct Crossing
    {
        int vertex, other; ///< the nearer end, the farther one
        CreaseNet::Place place;
        double reach, otherReach; ///< how far they are, in lengths of the edge
    };

    /// A corner and a vertex that could lie there.
    struct Want
    {
        double distance;
        int corner, vertex;
    };

    void snapCorners();
    std::vector<Want> wantsOfCorners() const;
    double longestEdgeAt(int vertex) const;
    int snapCrossings();
    std::vector<Crossing> findCrossings() const;
    std::optional<Crossing> crossing(const std::vector<Vec3>& normals, int a, int b) const;
    bool lies(int vertex, int chain) const;
    bool isFree(int vertex) const { return hold_[vertex].free() && !surface_.isFixed(vertex); }
    bool ease(const CellMover::Apart& apart);
    std::vector<Vec3> placesNear(int vertex, const Vec3& wanted) const;

    GridSurface& surface_;
    const CreaseNet& net_;
    const NearestTree& mesh_;
    CellMover mover_;
    std::vector<Hold> hold_;    ///< per vertex
    std::vector<int> vertexAt_; ///< per corner, or -1
};

} // namespace gimg

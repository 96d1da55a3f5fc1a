#pragma once

#include "gimg/mesh.h"

#include <array>
#include <vector>

namespace gimg {

/// Moves the vertices of a map to the sphere one by one, each to where the triangles around it are nearest to
/// those of the surface in shape: to the least sum of  area on the surface * (s/t + t/s) / 2  with the
/// singular values s, t of the map on each triangle, which is infinite for triangles without area. (As
/// Hormann and Greiner 2000, "MIPS: An efficient global parametrization method", but for area on the surface
/// and the sphere: triangles are taken as flat, their area as det(a, b, c) / 2.)
class SphereRelaxation
{
public:
    /// @param mesh      closed; without faces of no area
    /// @param position  on the unit sphere; changed by what is called
    SphereRelaxation(const Mesh& mesh, std::vector<Vec3>& position);

    /// Moves vertices at flipped triangles and around them until no triangle is flipped, or nothing helps any
    /// more. Returns whether none is. While some are flipped around a vertex, areas count as the positive
    /// root of x^2 - area x - tolerance^2 / 4, with a tolerance that shrinks, so that energies are finite.
    /// Source: Garanzha, Kaporin, Kudryavtseva, Protais, Ray, Sokolov 2021, "Foldover-free maps in 50 lines
    /// of code".
    bool untangle();

    /// Moves every vertex as often as told; no triangle that is not flipped becomes so.
    void smooth(int sweeps);

    int movedByUntangling() const; ///< vertices, of all calls

private:
    struct Star;
    bool isFlipped(int f) const;
    bool starIsValid(int v) const;
    bool relax(int v, double tolerance);
    bool moveToKernel(int v);
    bool untangle(int v, double tolerance);
    std::vector<int> flippedFaces() const;
    std::vector<int> verticesAround(const std::vector<int>& faces, int rings) const;

    const Mesh& mesh_;
    const Halfedges he_;
    std::vector<Vec3>& position_;
    std::vector<std::array<double, 3>> cotangent_; // per face and corner
    std::vector<double> area_;                     // per face
    std::vector<bool> hasMoved_;                   // per vertex: by untangle()
};

} // namespace gimg

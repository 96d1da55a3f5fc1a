#pragma once

#include "gimg/mesh.h"
#include "gimg/result.h"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace gimg {

/// The symmetric double covering of a surface with boundary: two copies of it, the second one turned inside
/// out, glued along all boundary loops. It is closed; of a surface of genus g with b loops it has genus
/// 2 g + b - 1.
///
/// An edge inside the surface that joins two boundary vertices would be one edge of the covering in both
/// copies; it is halved, and the triangles beside it are split. The surface stays what it is.
struct DoubleCover
{
    Mesh mesh; ///< the first copy keeps the numbers of its vertices; positions of the copies coincide

    std::vector<int> mirror;     ///< per vertex of the covering: its mirror image; itself on the seam
    std::vector<int> mirrorFace; ///< per face; faces of the first copy come first
    /// Per halfedge h: the halfedge with the direction of the mirror image of h. It lies in the face next to
    /// the mirror face of h's, since that one is turned around.
    std::vector<int> mirrorHalfedge;
    std::vector<int> faceOrigin; ///< per face: the face of the surface it is (a part of)
    /// Per halfedge of the surface: the halfedges of the covering that run along it in the first copy, in
    /// order; the second is -1 where the edge was not split.
    std::vector<std::array<int, 2>> halfedges;

    int sheetFaces() const { return mesh.faceCount() / 2; } ///< faces of the first copy
    bool onSeam(int vertex) const { return mirror[vertex] == vertex; }
};

/// @param mesh  connected, manifold, oriented, with at least one boundary loop
/// Errors: BadArgument where there is no boundary; EmptyMesh where a triangle has three boundary edges.
/// Source: thesis §7.5.
Result<DoubleCover> doubleCover(const Mesh& mesh);

/// A 1-form of the covering on the surface's own halfedges.
Eigen::VectorXcd restrictToSurface(const DoubleCover& cover, const Eigen::VectorXcd& form);

/// The symmetric part (w + conj(r*w)) / 2, where r swaps the two copies: again holomorphic if w is, and real
/// along the seam, which it therefore maps to horizontal lines.
Eigen::VectorXcd symmetricPart(const DoubleCover& cover, const Eigen::VectorXcd& form);

/// A surface with holes made by leaving out vertices with the faces around them.
struct PuncturedSurface
{
    Mesh mesh;
    std::vector<int> vertexOf; ///< the surface's vertex of each vertex of `mesh`
    std::vector<int> faceOf;   ///< the surface's face of each face of `mesh`
};

/// Opens a hole at each of the given vertices. Conformal maps shrink limbs beyond measure; a hole at a tip
/// gives a limb a handle of the double covering, and its share of the plane.
/// @param mesh      connected, manifold, oriented
/// @param vertices  each inside, with no boundary vertex next to it, and no two next to each other or with a
///                  common neighbour
/// Errors: BadArgument (names the vertex) where that is not so; EmptyMesh where nothing is left.
/// Source: thesis §7.5, the holes made in David.
Result<PuncturedSurface> puncture(const Mesh& mesh, std::span<const int> vertices);

} // namespace gimg

#pragma once

#include "gimg/mesh.h"
#include "gimg/polyhedral_surface.h"
#include "gimg/result.h"

#include <Eigen/SparseCore>

#include <vector>

namespace gimg {

/// What IntrinsicTriangulation::makeDelaunay did.
struct DelaunayReport
{
    int negativeBefore = 0; ///< interior edges with a negative weight
    int negativeAfter = 0;  ///< 0, but for meshes so degenerate that rounding stopped the flips
    int flips = 0;
};

/// A triangulation of a surface by geodesic edges, known by their lengths. It begins as the mesh's own; a
/// flip replaces an edge by the other diagonal of the two triangles beside it, unfolded to the plane, and a
/// split adds a vertex in the middle of an edge. The surface and its vertices stay what they are, so
/// functions on vertices mean the same before and after.
///
/// Halfedges keep the mesh's numbers (3 f + k, see Halfedges) for good, flipped ones included, but belong to
/// faces as next() says. Those that splits add have numbers after them. An edge may come to join a vertex
/// with itself, two edges the same two vertices, and a face may meet itself. Source: Fisher, Springborn,
/// Bobenko, Schroeder 2007, "An algorithm for the construction of intrinsic Delaunay triangulations with
/// applications to digital geometry processing".
class IntrinsicTriangulation
{
public:
    /// @param mesh  manifold and oriented, with or without boundary; triangles may be degenerate
    /// Where some triangle has a + b - c < 1e-6 of the mean edge length, all lengths grow by the least number
    /// that makes it as much. Source: Sharp, Crane 2020, "A Laplacian for nonmanifold triangle meshes".
    /// Errors: EmptyMesh if no edge is longer than 1e-70; NotFinite if one is longer than 1e70 or no number.
    static Result<IntrinsicTriangulation> of(const Mesh& mesh);
    static Result<IntrinsicTriangulation> of(const PolyhedralSurface& surface);

    /// Flips interior edges with a negative weight until there is none. The result does not depend on the
    /// order of flips, but for edges of weight 0; the order is the same in every run.
    /// Source: Bobenko, Springborn 2007, "A discrete Laplace-Beltrami operator for simplicial surfaces":
    /// flips end, and the result is the surface's own Delaunay triangulation.
    DelaunayReport makeDelaunay();

    /// Splits an edge at its middle, and with it the triangles beside it. From then on h and its twin run
    /// from where they began to the new vertex.
    /// @return the new vertex, vertexCount() - 1 from now on; -1 if both sides of the edge are one face,
    /// which
    ///         is left as it is
    int split(int h);

    int vertexCount() const { return vertexCount_; }
    int faceCount() const { return halfedgeCount() / 3; }
    int halfedgeCount() const { return static_cast<int>(tail_.size()); }

    int tail(int h) const { return tail_[h]; }
    int head(int h) const { return tail_[next_[h]]; }
    int next(int h) const { return next_[h]; }
    int prev(int h) const { return next_[next_[h]]; }
    int face(int h) const { return face_[h]; } ///< 0 .. faceCount() - 1
    int twin(int h) const { return twin_[h]; } ///< -1 on the boundary
    bool onBoundary(int h) const { return twin_[h] < 0; }

    double length(int h) const { return length_[h]; }
    double angle(int h) const;                          ///< at the tail of h in the face of h, in radians
    double cotangent(int h) const;                      ///< of the angle opposite to h in the face of h
    double area(int h) const;                           ///< of the face of h
    double addedLength() const { return addedLength_; } ///< to every edge, see of()

    /// (cot a + cot b) / 2 with the angles a and b opposite to the edge, of which a boundary edge has one. 0
    /// where the sum is negative by no more than rounding.
    double weight(int h) const;

    /// Vertices of every face, beginning with the tail of its least halfedge.
    std::vector<Triangle> faces() const;

    /// A third of the areas of the faces around each vertex: the lumped mass matrix.
    Eigen::VectorXd vertexAreas() const;

    /// The positive semi-definite Laplacian: u'Lu = sum over edges of weight (u_head - u_tail)^2, the
    /// Dirichlet energy of u, linear on each face. Rows and columns of vertices that no face has are zero.
    Eigen::SparseMatrix<double> cotangentLaplacian() const;

    /// A closed 1-form on the mesh's halfedges (opposite on twins, with sum 0 around each face), integrated
    /// along the halfedges of this triangulation, half of it on each half of a split edge.
    std::vector<double> carried(std::vector<double> closedForm) const;

private:
    /// A flip: the halfedge from now on parallel to the chain first, second. Or a split (added >= 0):
    /// halfedge and twin run to the middle from now on, and close a triangle with the first new halfedge of
    /// their side and with first, second.
    struct Step
    {
        int halfedge, twin, first, second, added;
    };

    explicit IntrinsicTriangulation(const PolyhedralSurface& surface);
    void lengthen();
    double weightSum(int h, double& rounding) const;
    bool isNegative(int h) const { return !onBoundary(h) && weight(h) < 0; }
    int negativeEdges() const;
    void flip(int h);
    double otherDiagonal(int h) const;
    int halve(int h, int middle);

    int vertexCount_;
    std::vector<int> tail_, next_, twin_, face_;
    std::vector<double> length_;
    double addedLength_ = 0;
    std::vector<Step> steps_;
    size_t flips_ = 0;
};

} // namespace gimg

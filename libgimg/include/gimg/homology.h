#pragma once

#include "gimg/mesh.h"
#include "gimg/one_form.h"
#include "gimg/polyhedral_surface.h"
#include "gimg/result.h"

#include <Eigen/Core>

#include <array>
#include <span>
#include <vector>

namespace gimg {

/// A closed walk along edges: the head of each halfedge (see Halfedges) is the tail of the next, and that of
/// the last the tail of the first. It may pass a vertex or an edge more than once.
struct Loop
{
    std::vector<int> halfedges;
};

/// Length of the walk on the surface.
double loopLength(const PolyhedralSurface& surface, const Loop& loop);

/// 2g short loops that form a basis of the first homology group with integer coefficients. Of a closed
/// surface of genus 0 there are none. From the loops of tree-cotree decompositions with shortest paths from a
/// few roots, the shortest are chosen that form an integer basis, and each is pulled tight within its class.
/// The shortest comes first. Near-linear time for bounded genus. Errors: those of closedTopology. Source:
/// Eppstein 2003, "Dynamic generators of topologically embedded graphs" (tree-cotree); Erickson, Whittlesey
/// 2005, "Greedy optimal homotopy and homology generators" (shortest loops through a root). In place of the
/// reduction of matrices of a simplified mesh in thesis §6.2.
Result<std::vector<Loop>> homologyBasis(const PolyhedralSurface& surface);
Result<std::vector<Loop>> homologyBasis(const Mesh& mesh);

/// How often loop a crosses loop b from its left to its right, less how often from right to left. Each
/// common vertex counts by its index: a loop that leaves the other, or joins it, has half a crossing there.
/// +1 for the axes x and y of an oriented plane. Bilinear, antisymmetric, the same for homologous loops.
/// @param halfedges  of a closed surface
/// Source: thesis §6.2, Algorithm 4 and Fig. 21.
int intersectionNumber(const Halfedges& halfedges, const Loop& a, const Loop& b);

/// Intersection numbers of every two loops: antisymmetric, and of determinant 1 for a basis.
Eigen::MatrixXi intersectionMatrix(const Halfedges& halfedges, std::span<const Loop> loops);

/// An integer matrix A of determinant +-1 with A' Q A = [0 I; -I 0] for the intersection matrix Q of a basis.
/// Errors: BadArgument if Q is not square, antisymmetric, of even size and determinant 1, or if the numbers
/// grow beyond 32 bits.
/// Source: thesis eq. 74.
Result<Eigen::MatrixXi> symplecticCongruence(const Eigen::MatrixXi& intersections);

/// 2g loops with a_i . b_i = 1 and all other intersection numbers 0.
struct CanonicalBasis
{
    std::vector<Loop> a, b;
};

/// A canonical basis made of homologyBasis(): where a class is a combination of several loops, they are
/// joined to one closed walk and pulled tight within its class.
/// Errors: those of closedTopology; WrongGenus for genus 0.
Result<CanonicalBasis> canonicalBasis(const PolyhedralSurface& surface);
Result<CanonicalBasis> canonicalBasis(const Mesh& mesh);

/// The closed form that counts how often a walk crosses the loop from right to left, the loop taken a little
/// to its left: the difference of a function that jumps by one across the loop. For every loop c its integral
/// is the intersection number of `loop` and c, and the integral of form(a) ^ form(b) that of a and b.
/// Source: Poincare duality; it takes the place of thesis Algorithms 5 and 6, which slice the mesh along the
/// loop and map it to a square to get some form of this class.
OneForm poincareDual(const Halfedges& halfedges, const Loop& loop);

/// First homology group of any triangle complex over the integers: Z^rank and cyclic groups of the orders in
/// `torsion`.
struct SimplicialHomology
{
    int rank = 0;
    std::vector<int> torsion;              ///< each > 1 and a divisor of the next
    std::vector<std::array<int, 2>> edges; ///< tail < head
    std::vector<Eigen::VectorXi> cycles;   ///< `rank` of them, one number per edge; with torsion they
                                           ///< generate the free part
};

/// By the Smith normal forms of the boundary matrices, for any complex, orientable or not, closed or not.
/// Slow: cubic time and dense matrices, meant for up to some thousand faces, and as an oracle in tests.
/// Errors: EmptyMesh, BadArgument for bad indices or numbers that grow beyond 64 bits.
/// Source: thesis §6.2, eq. 71-73.
Result<SimplicialHomology> homologyBySmithForm(const std::vector<Triangle>& faces, int vertexCount);

} // namespace gimg

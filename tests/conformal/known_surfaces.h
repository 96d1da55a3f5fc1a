#pragma once

#include "gimg/mesh.h"
#include "gimg/polyhedral_surface.h"

#include <cstdint>
#include <vector>

/// Surfaces whose period matrix is known, and meshes of one surface that are as different as one likes.
namespace gimg::known {

/// The unit sphere as a bipyramid over a polygon with `sides` corners on the equator, each of its faces split
/// into n x n. The first `sides` vertices are the corners, then come the poles; the edges of the bipyramid
/// run along mesh edges.
/// @param off  how far vertices that are on no such edge are moved at random, < 0.25 of 1 / n each way; 0
///             keeps all symmetries
Mesh bipyramidSphere(int sides, int n, double off = 0);

/// The double cover of a sphere with branch points at the corners of bipyramidSphere(sides, n, off), `sides`
/// even: two copies, slit along every other side of the equator and glued crosswise. Genus sides / 2 - 1; the
/// hyperelliptic curve y^2 = x^sides - 1.
/// @param dilation  vertices are first moved on the sphere by a Moebius map, a dilation by this factor along
///                  an axis askew to all symmetries. Neither the curve nor its periods change by that.
PolyhedralSurface coverOverEquator(int sides, int n, double off = 0, double dilation = 1);

/// The double cover of a sphere with branch points at the 6 corners of an octahedron: y^2 = x^5 - x.
PolyhedralSurface coverOverOctahedron(int n, double off = 0, double dilation = 1);

/// Unit squares 0, 1, ... glued: the right side of square s to the left of right[s], the top of s to the
/// bottom of up[s]. Each is split into n x n cells of two triangles, n >= 3.
/// @param off   how far vertices inside the squares are moved at random, < 0.25 of a cell each way
/// @param skew  cells from left to right end at the powers (i / n)^skew, so that corners are not all alike
PolyhedralSurface squareTiled(const std::vector<int>& right, const std::vector<int>& up, int n,
                              double off = 0, double skew = 1);

/// Torus of revolution with vertices moved off the grid at random inside the surface.
/// @param off        by how much of a cell at most, < 0.5
/// @param irregular  edges are then flipped where the angles opposite to them add up to more than 180 degrees
Mesh roughTorus(double major, double minor, int nu, int nv, double off, bool irregular, uint32_t seed);

/// Each triangle split into four, corners where they were and new vertices at the middles of edges.
Mesh splitInFour(const Mesh& mesh);
PolyhedralSurface splitInFour(const PolyhedralSurface& surface);

/// A flat Klein bottle of n x n cells in 4-space, seen from 3-space; n >= 4.
Mesh kleinBottle(int n);

} // namespace gimg::known

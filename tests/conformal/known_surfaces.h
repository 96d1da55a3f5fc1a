#pragma once

#include "gimg/mesh.h"
#include "gimg/polyhedral_surface.h"

#include <cstdint>
#include <vector>

/// Surfaces whose period matrix is known, and meshes of one surface that are as different as one likes.
namespace gimg::known {

/// The unit sphere as a bipyramid over a polygon with `sides` corners on the equator, each of its faces split
/// into n x n. The first `sides` vertices are the corners, the equator runs along mesh edges.
Mesh bipyramidSphere(int sides, int n);

/// The double cover of a sphere with branch points at the corners of bipyramidSphere(sides, n), `sides` even:
/// two copies, slit along every other side of the equator and glued crosswise. Genus sides / 2 - 1; the
/// hyperelliptic curve y^2 = x^sides - 1.
PolyhedralSurface coverOverEquator(int sides, int n);

/// The double cover of a sphere with branch points at the 6 corners of an octahedron: y^2 = x^5 - x.
PolyhedralSurface coverOverOctahedron(int n);

/// Unit squares 0, 1, ... glued: the right side of square s to the left of right[s], the top of s to the
/// bottom of up[s]. Each is split into n x n cells of two triangles, n >= 3.
PolyhedralSurface squareTiled(const std::vector<int>& right, const std::vector<int>& up, int n);

/// Torus of revolution with vertices moved off the grid at random inside the surface, by at most `off` (<
/// 0.5) of a cell.
/// @param irregular  edges are then flipped where the angles opposite to them add up to more than 180 degrees
Mesh roughTorus(double major, double minor, int nu, int nv, double off, bool irregular, uint32_t seed);

/// Each triangle split into four, corners where they were and new vertices at the middles of edges.
Mesh splitInFour(const Mesh& mesh);
PolyhedralSurface splitInFour(const PolyhedralSurface& surface);

/// A flat Klein bottle of n x n cells in 4-space, seen from 3-space; n >= 4.
Mesh kleinBottle(int n);

} // namespace gimg::known

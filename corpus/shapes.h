#pragma once

#include "gimg/mesh.h"

/// Surfaces of known topology, area and volume, meshed at any resolution. Used by tests, benchmarks and
/// gimshape. All are manifold, connected and oriented outward (closed ones have a positive volume; flat ones
/// face +z).
namespace gimg::shapes {

/// Geodesic sphere around the origin: the faces of an icosahedron split into n x n triangles. 20 n^2 faces, n
/// >= 1.
Mesh sphere(double radius, int n);

/// The star-shaped surface r(p) = radius (1 + amplitude Re (x + i y)^waves) for unit p, meshed as sphere().
/// @param amplitude  in (-1, 1)
/// @param waves      >= 0
Mesh wavySphere(double radius, double amplitude, int waves, int n);

/// Torus of revolution about z: axis circle of radius `major`, tube of radius `minor` < `major`.
/// @param nu, nv  samples along the axis circle and around the tube, >= 3 each; 2 nu nv faces
Mesh torus(double major, double minor, int nu, int nv);

/// Tube of radius `tube` around the trefoil knot that winds twice about z on the torus of radii 2 and 1:
/// genus 1, knotted. Embedded for tube <= 0.5.
/// @param nu, nv  samples along the knot (>= 24) and around the tube (>= 3); 2 nu nv faces
Mesh trefoil(double tube, int nu, int nv);

/// The length of the knot that trefoil() follows.
double trefoilLength();

/// Open cylinder about z from z = 0 to `height`: 2 boundary loops.
/// @param nu, nv  samples around (>= 3) and segments along (>= 1); 2 nu nv faces
Mesh cylinder(double radius, double height, int nu, int nv);

/// Flat disk in z = 0, n rings of triangles around the centre: 1 loop, 6 n^2 faces, n >= 1.
Mesh disk(double radius, int n);

/// Flat plate in z = 0 made of `holes` squares of side 2 in a row along x, each with a round hole of radius
/// 0.6 in its middle: holes + 1 loops. With holes = 0, one square without a hole.
/// @param n  segments along the side of a square, >= 1
Mesh plate(int holes, int n);

/// Box around the origin with sides of these lengths, n x n quads of two faces each: sharp edges that end in
/// corners. 12 n^2 faces, n >= 1.
Mesh box(const Vec3& sides, int n);

/// Smooth surface of any genus with openings where wanted. It follows a flat ladder with `genus` gaps between
/// its rungs: a level set of a Gaussian convolved with the ladder's bars. Lies within |z| < 1.
/// @param genus  >= 0
/// @param loops  openings, at most 4 (genus + 1); the same openings at every n
/// @param n      segments along the side of a ladder cell, >= 1; 2 n^2 faces a cell side
Mesh surfaceOfGenus(int genus, int loops, int n);

/// How far a point is from the surface that surfaceOfGenus() samples, to first order.
double surfaceOfGenusResidual(int genus, const Vec3& p);

/// The volume enclosed by a closed mesh, positive when oriented outward.
double volume(const Mesh& mesh);

/// The smallest angle of any triangle, in degrees.
double smallestAngle(const Mesh& mesh);

} // namespace gimg::shapes

#pragma once

#include "gimg/intrinsic.h"
#include "gimg/result.h"

#include <Eigen/SparseCore>

#include <complex>
#include <vector>

namespace gimg {

/// The logarithm u of the factor by which lengths change when the surface's curvature is spread evenly over
/// its area, without bending angles: L u = 4 pi M_i / sum M - (2 pi - angles at i). Its mean is 0. Along limbs
/// it falls by about their length over their radius.
/// Errors: FlippedTriangle if the linear system cannot be solved.
Result<Eigen::VectorXd> logScales(const IntrinsicTriangulation& surface,
                                  const Eigen::SparseMatrix<double>& laplacian);

/// A closed surface of genus 0 in the plane, but for one triangle, which is the outside.
struct PuncturedPlane
{
    std::vector<std::complex<double>> z; ///< of every vertex
    int outside = 0;                     ///< a vertex of that triangle
};

/// The discrete conformal map of the surface without a triangle to the plane, where that triangle lies around
/// it: vertices are at the means of their neighbours, and of the affine images of that the most conformal one
/// is taken. With positive weights it cannot fold (Tutte 1963). The triangle is one with a large scale.
/// Errors: FlippedTriangle if the linear system cannot be solved.
/// Source: Haker, Angenent, Tannenbaum, Kikinis, Sapiro, Halle 2000, "Conformal surface parameterization for
/// texture mapping"; the affine map is our own, see docs/sphere.md.
Result<PuncturedPlane> mapPunctured(const IntrinsicTriangulation& surface,
                                    const Eigen::SparseMatrix<double>& laplacian,
                                    const Eigen::VectorXd& logScale);

} // namespace gimg

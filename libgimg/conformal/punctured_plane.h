#pragma once

#include "gimg/intrinsic.h"
#include "gimg/result.h"

#include <Eigen/SparseCore>

#include <complex>
#include <vector>

namespace gimg {

/// A closed surface of genus 0 in the plane, but for one triangle, which is the outside.
struct PuncturedPlane
{
    std::vector<std::complex<double>> z; ///< of every vertex
    int outside = 0;                     ///< a halfedge of that triangle
    Eigen::VectorXd logScale; ///< per vertex: of plane over surface, as a conformal map would have it;
                              ///< all up to one constant. No less exact where limbs shrink to nothing.
};

/// A halfedge of a triangle of the surface that is large on the sphere: where the logarithm of the scale is
/// largest for the metric without bent angles whose curvature is spread evenly over the surface's area.
/// Errors: SolverFailure if the linear system cannot be solved.
Result<int> triangleForOutside(const IntrinsicTriangulation& surface,
                               const Eigen::SparseMatrix<double>& laplacian);

/// The discrete conformal map of the surface without a triangle to the plane, where that triangle lies around
/// it: vertices are at the means of their neighbours, and of the affine images of that the most conformal one
/// is taken. With positive weights it cannot fold (Tutte 1963).
/// @param laplacian  its weights are those of the means
/// @param outside    a halfedge of a triangle with three different corners
/// Errors: SolverFailure if the linear system cannot be solved.
/// Source: Haker, Angenent, Tannenbaum, Kikinis, Sapiro, Halle 2000, "Conformal surface parameterization for
/// texture mapping"; the affine map is our own, see docs/sphere.md.
Result<PuncturedPlane> mapPunctured(const IntrinsicTriangulation& surface,
                                    const Eigen::SparseMatrix<double>& laplacian, int outside);

} // namespace gimg

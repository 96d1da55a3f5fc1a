#pragma once

#include "gimg/homology.h"
#include "gimg/intrinsic.h"
#include "gimg/one_form.h"
#include "gimg/result.h"

#include <memory>
#include <span>
#include <vector>

namespace gimg {

/// Harmonic forms, integrated along the halfedges of the surface and along those of the triangulation that
/// the solver works on.
struct HarmonicForms
{
    std::vector<OneForm> onSurface;
    std::vector<OneForm> onTriangulation;
};

/// Finds the harmonic form in the cohomology class of a closed form: the one of least Dirichlet energy. The
/// energy is that of the intrinsic Delaunay triangulation, where no weight is negative; forms are given and
/// handed out on the surface's own halfedges. One sparse factorization serves any number of forms.
/// Source: thesis §4.9 (Theorem 4.5) and §6.4, eq. 76-82.
class HarmonicSolver
{
public:
    /// @param surface  closed
    /// Errors: those of closedTopology; SolverFailure.
    static Result<HarmonicSolver> of(const PolyhedralSurface& surface);

    /// The harmonic forms of the classes of `forms`, closed forms on the surface's halfedges.
    /// Errors: SolverFailure.
    Result<HarmonicForms> harmonic(std::span<const OneForm> forms) const;

    /// The integrals of a ^ *b for every two closed forms on the triangulation.
    Eigen::MatrixXd energies(std::span<const OneForm> onTriangulation) const;

    /// Per face of the triangulation: the integral of |*a - b|^2, for closed forms on it. Their sum is 0 for
    /// a harmonic form and its star. Otherwise it bounds how far a is from harmonic and b from its star, both
    /// squared and added. Source: Prager, Synge 1947, "Approximations in elasticity based on the concept of
    /// function space".
    Eigen::VectorXd conjugateErrors(const OneForm& a, const OneForm& b) const;

    /// Splits each face of the triangulation into about as many as `pieces` says, at most 16 at once, makes
    /// it Delaunay again and factors anew.
    /// Errors: BadArgument if there is not one finite number per face; SolverFailure.
    /// @param pieces  per face of the triangulation; those below 2 are split only where a neighbour is
    Status refine(const Eigen::VectorXd& pieces);

    /// The largest |sum over edges at a vertex of weight times form|, relative to the root of the form's
    /// energy, for a closed form on the triangulation.
    double divergence(const OneForm& onTriangulation) const;

    const IntrinsicTriangulation& triangulation() const;
    const Topology& topology() const;

    HarmonicSolver(HarmonicSolver&&) noexcept;
    HarmonicSolver& operator=(HarmonicSolver&&) noexcept;
    ~HarmonicSolver();

private:
    struct Parts;
    explicit HarmonicSolver(std::unique_ptr<Parts> parts);
    std::unique_ptr<Parts> parts_;
};

/// 2g closed forms dual to a canonical basis: form j integrates to 1 along a[j], form g + j along b[j], and
/// each to 0 along the other loops. Integers throughout. Source: thesis eq. 75.
std::vector<OneForm> dualBasis(const Halfedges& halfedges, const CanonicalBasis& basis);

/// The thesis's iteration towards the harmonic form, for reference: `steps` times every vertex moves the form
/// by its own Laplacian over the sum of its weights, half way. Slow: the error falls by a factor of about 1 -
/// (h / diameter)^2 a step.
/// Source: thesis §6.4, Algorithm 7.
OneForm diffused(const IntrinsicTriangulation& triangulation, const Halfedges& halfedges, OneForm form,
                 int steps);

} // namespace gimg

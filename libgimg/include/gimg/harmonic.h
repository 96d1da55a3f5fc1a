#pragma once

#include "gimg/homology.h"
#include "gimg/intrinsic.h"
#include "gimg/one_form.h"
#include "gimg/result.h"

#include <memory>
#include <span>
#include <vector>

namespace gimg {

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

    /// The harmonic forms of the classes of `forms`. Errors: SolverFailure.
    Result<std::vector<OneForm>> harmonic(std::span<const OneForm> forms) const;

    /// The integral of a ^ *b on the triangulation, for closed forms on the surface's halfedges.
    Eigen::MatrixXd energies(std::span<const OneForm> forms) const;

    /// The largest |sum over edges at a vertex of weight times form|, relative to the root of the form's
    /// energy.
    double divergence(const OneForm& form) const;

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

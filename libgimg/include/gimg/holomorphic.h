#pragma once

#include "gimg/homology.h"
#include "gimg/one_form.h"
#include "gimg/progress.h"
#include "gimg/result.h"

#include <Eigen/Core>

#include <vector>

namespace gimg {

/// The complex structure of a closed surface of genus g >= 1, as its forms and their periods.
struct ConformalStructure
{
    int genus = 0;
    CanonicalBasis loops; ///< a_1 .. a_g, b_1 .. b_g with a_j . b_j = 1

    /// 2g real harmonic forms on the surface's halfedges: form j integrates to 1 along a_j, form g + j along
    /// b_j, and each to 0 along the other loops.
    std::vector<OneForm> harmonic;

    /// Form i integrates to 1 along a_i and to 0 along the other a; its integral along b_j is periodMatrix(j,
    /// i). Its real and imaginary parts are harmonic, and the imaginary part is the star of the real part as
    /// far as a discrete form allows.
    std::vector<ComplexOneForm> holomorphic;

    /// g x g, symmetric, with a positive definite imaginary part.
    Eigen::MatrixXcd periodMatrix;

    /// 2g x 2g: *harmonic_j = sum over i of star(i, j) harmonic_i, with star^2 = -I. See docs/holomorphic.md
    /// for how it follows from the energies.
    Eigen::MatrixXd star;

    /// 2g x 2g: the integrals of harmonic_i ^ *harmonic_j, as measured on the triangles.
    Eigen::MatrixXd energy;

    /// How far thesis Algorithm 8 alone, whose star comes from the energies as measured, is from Riemann's
    /// relations. Both are 0 for a smooth surface.
    double asymmetry = 0;    ///< |P - P'| / |P| (Frobenius) of its period matrix P
    double starResidual = 0; ///< largest |R^2 w + w| / |w| over harmonic forms w, in the norm of the energy.
                             ///< For a surface of flat triangles a bound, too: the energy of every form's
                             ///< class is between 1 / (1 + starResidual) times and once the measured one

    int triangles = 0; ///< on which forms were computed
};

struct ConformalOptions
{
    /// Triangles are split, where it helps most, until `starResidual` is at most this. Infinity to compute on
    /// the surface's own vertices only.
    double starResidual = 0.01;
    int mostTriangles = 2'000'000; ///< which splits do not go beyond, whatever the residual is then
    Progress progress;
};

/// All of it, with one factorization for all forms (and one more for each round of splits). Near-linear in
/// the number of faces, linear in the genus.
/// Errors: those of closedTopology; WrongGenus for genus 0; SolverFailure; BadArgument unless starResidual >
/// 0. Source: thesis §6, Algorithms 3 to 8; period matrix §4.13 and §8.2.3, in today's normalisation.
Result<ConformalStructure> conformalStructure(const PolyhedralSurface& surface,
                                              const ConformalOptions& options = {});
Result<ConformalStructure> conformalStructure(const Mesh& mesh, const ConformalOptions& options = {});

/// The same in given loops. Errors: as above; BadArgument if `loops` is not a canonical basis.
Result<ConformalStructure> conformalStructure(const PolyhedralSurface& surface, const CanonicalBasis& loops,
                                              const ConformalOptions& options = {});

} // namespace gimg

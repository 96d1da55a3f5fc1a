#pragma once

#include "gimg/homology.h"
#include "gimg/one_form.h"
#include "gimg/progress.h"
#include "gimg/result.h"

#include <Eigen/Core>

#include <vector>

namespace gimg {

/// The complex structure of a closed surface of genus g >= 1, as its forms and their periods. With a form's
/// integral along a and b as the letters of its periods:
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
    double starResidual = 0; ///< largest |R^2 w + w| / |w| over harmonic forms w, in the norm of the energy
};

/// All of it, with one factorization for all forms. Near-linear in the number of faces, linear in the genus.
/// Errors: those of closedTopology; WrongGenus for genus 0; SolverFailure.
/// Source: thesis §6, Algorithms 3 to 8; period matrix §4.13 and §8.2.3, in today's normalisation.
Result<ConformalStructure> conformalStructure(const PolyhedralSurface& surface,
                                              const Progress& progress = {});
Result<ConformalStructure> conformalStructure(const Mesh& mesh, const Progress& progress = {});

/// The same in given loops. Errors: as above; BadArgument if `loops` is not a canonical basis.
Result<ConformalStructure> conformalStructure(const PolyhedralSurface& surface, const CanonicalBasis& loops,
                                              const Progress& progress = {});

} // namespace gimg

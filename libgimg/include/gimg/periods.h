#pragma once

#include "gimg/result.h"

#include <Eigen/Core>

#include <complex>
#include <optional>

namespace gimg {

/// tau of a torus, moved to |tau| >= 1, -1/2 < Re tau <= 1/2 (and Re tau >= 0 where |tau| = 1): one number
/// for all bases.
/// Errors: BadArgument unless Im tau > 1e-100 and |tau| < 1e100.
Result<std::complex<double>> reducedModulus(std::complex<double> tau);

/// The parallelogram that a torus is conformal to, with the shortest sides there are.
struct ShapeFactors
{
    double angleDegrees = 0; ///< between the sides, in [60, 90]
    double lengthRatio = 0;  ///< longer to shorter side, >= 1
};

/// Errors: as reducedModulus.
/// Source: thesis §8.2.3; it takes the sides from the loops it has, these are the same for all bases.
Result<ShapeFactors> shapeFactors(std::complex<double> tau);

/// A period matrix in another canonical basis: with integer blocks N = [A B; C D], (A Z + B)(C Z + D)^-1.
struct ReducedPeriods
{
    Eigen::MatrixXcd periodMatrix;
    Eigen::MatrixXi transformation; ///< 2g x 2g, symplectic
};

/// Moves a period matrix towards Siegel's fundamental domain: Im Z is LLL-reduced, |Re Z_jk| <= 1/2 and
/// |Z_11| >= 1. For genus 1 it is reducedModulus. For genus > 1 a surface can have a few such matrices.
/// Errors: BadArgument unless Z is symmetric to 1e-6 with a positive definite imaginary part.
/// Source: C. L. Siegel, "Topics in complex function theory" III; Deconinck et al. 2004, "Computing Riemann
/// theta functions".
Result<ReducedPeriods> siegelReduced(const Eigen::MatrixXcd& periodMatrix);

/// (A Z + B)(C Z + D)^-1 for N = [A B; C D].
Eigen::MatrixXcd transformedPeriods(const Eigen::MatrixXcd& periodMatrix,
                                    const Eigen::MatrixXi& transformation);

/// How far apart two complex structures on the same marked surface are: log of the largest ratio of the
/// Dirichlet energies of one harmonic form's class under both. A metric. 2 x the Teichmueller distance for
/// genus 1, and at most that for any genus.
double periodDistance(const Eigen::MatrixXcd& z, const Eigen::MatrixXcd& w);

struct EquivalenceOptions
{
    double tolerance = 0.02;      ///< largest periodDistance that counts as equal
    bool allowReflection = false; ///< maps that reverse the orientation count, too
    long mostNodes = 1'000'000;   ///< of the search tree that are visited
};

/// The outcome of a search for a change of basis that makes two period matrices equal.
struct Equivalence
{
    bool equivalent = false;
    double distance = 0; ///< the least found; infinite if there is none within the tolerance
    /// 2g x 2g: transformedPeriods(first, transformation) is next to the second.
    Eigen::MatrixXi transformation;
    bool reflected = false; ///< it is next to minus the conjugate of the second
    bool exhaustive = true; ///< false if the search was stopped by mostNodes: then a smaller distance,
                            ///< or any, may have been missed
};

/// Whether two closed surfaces are conformally equivalent, by their period matrices. For genus 1 that is
/// whether the modular group takes one to the other. For any genus it is whether the lattices of periods with
/// their energies and intersection numbers are isometric (Torelli's theorem), and vectors of the same length
/// are all that the search has to look at: it misses no change of basis within the tolerance.
/// Errors: BadArgument unless both are period matrices of the same size and the tolerance is in (0, 1].
/// Source: thesis §8.2.3 and eq. 56; search after Fincke, Pohst 1985 and Plesken, Souvignier 1997, "Computing
/// isometries of lattices".
Result<Equivalence> conformallyEquivalent(const Eigen::MatrixXcd& first, const Eigen::MatrixXcd& second,
                                          const EquivalenceOptions& options = {});

} // namespace gimg

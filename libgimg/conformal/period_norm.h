#pragma once

#include <Eigen/Core>

#include <optional>

#include "gimg/result.h"

namespace gimg {

/// The norm of homology classes for the period matrix Z = X + iY: energy of the harmonic form that counts how
/// often one crosses the class. For the class sum of m_j b_j + n_j a_j it is |Y^-1/2 (X m + n)|^2 + |Y^1/2
/// m|^2; here as a matrix on (m, n). It becomes N G N' in the basis with rows N.
Eigen::MatrixXd periodNorm(const Eigen::MatrixXcd& periodMatrix);

/// Intersection numbers in the basis (b, a): [0 -I; I 0].
Eigen::MatrixXi periodPairing(Eigen::Index genus);

/// Why this is no period matrix: BadArgument unless it is square, finite and symmetric to 1e-6 with a
/// positive definite imaginary part.
std::optional<Error> objectionToPeriods(const Eigen::MatrixXcd& periodMatrix);

} // namespace gimg

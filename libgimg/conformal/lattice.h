#pragma once

#include <Eigen/Core>

#include <functional>

namespace gimg {

/// A basis of all integer vectors, one a row, that is short in the norm v' G v.
/// @param gram  G, symmetric and positive definite
/// Source: Lenstra, Lenstra, Lovasz 1982, with the factor 0.99.
Eigen::MatrixXi reducedLattice(const Eigen::MatrixXd& gram);

/// Calls `visit` for every integer vector v with (v - center)' G (v - center) <= squaredRadius until it
/// returns false or `nodesLeft`, which every value tried for a coordinate lessens by one, is negative. Quick
/// if the units are reduced in G. Source: Fincke, Pohst 1985, "Improved methods for calculating vectors of
/// short length in a lattice".
void forEachLatticePoint(const Eigen::MatrixXd& gram, const Eigen::VectorXd& center, double squaredRadius,
                         long& nodesLeft, const std::function<bool(const Eigen::VectorXi&)>& visit);

} // namespace gimg

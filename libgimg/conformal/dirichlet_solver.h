#pragma once

#include <Eigen/CholmodSupport>
#include <Eigen/SparseCore>

#include <vector>

namespace gimg {

/// Harmonic functions on the vertices of a surface with given values on some of them, for any number of
/// functions with one factorisation.
class DirichletSolver
{
public:
    /// @param laplacian  positive semi-definite, symmetric
    /// @param fixed      per vertex: its value is given
    DirichletSolver(const Eigen::SparseMatrix<double>& laplacian, const std::vector<bool>& fixed);

    /// Whether there is a solution; nothing else may be asked for if not.
    bool isSolvable() const { return solvable_; }

    /// Sets the rows of free vertices so that the Laplacian is `source` there; the rows of the fixed ones are
    /// given. One column a function.
    void solve(Eigen::MatrixXd& values, const Eigen::MatrixXd& source) const;
    void solve(Eigen::MatrixXd& values) const;

private:
    std::vector<int> free_, row_; // vertex of each unknown, and the other way; -1 for fixed ones
    Eigen::SparseMatrix<double> toFixed_;
    Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower> factor_;
    bool solvable_ = false;
};

} // namespace gimg

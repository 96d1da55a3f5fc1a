#include "conformal/dirichlet_solver.h"

#include "one_solver_thread.h"

namespace gimg {

DirichletSolver::DirichletSolver(const Eigen::SparseMatrix<double>& laplacian, const std::vector<bool>& fixed)
    : row_(fixed.size(), -1)
{
    for (size_t v = 0; v < fixed.size(); ++v)
        if (!fixed[v]) {
            row_[v] = static_cast<int>(free_.size());
            free_.push_back(static_cast<int>(v));
        }
    const auto unknowns = static_cast<Eigen::Index>(free_.size());
    std::vector<Eigen::Triplet<double>> inner, outer;
    for (int column = 0; column < laplacian.outerSize(); ++column)
        for (Eigen::SparseMatrix<double>::InnerIterator entry(laplacian, column); entry; ++entry) {
            const int row = row_[static_cast<size_t>(entry.row())], other = row_[static_cast<size_t>(column)];
            if (row < 0) continue;
            if (other < 0)
                outer.emplace_back(row, column, entry.value());
            else if (row >= other)
                inner.emplace_back(row, other, entry.value());
        }
    Eigen::SparseMatrix<double> matrix(unknowns, unknowns);
    matrix.setFromTriplets(inner.begin(), inner.end());
    toFixed_.resize(unknowns, laplacian.cols());
    toFixed_.setFromTriplets(outer.begin(), outer.end());
    const OneSolverThread oneThread;
    factor_.cholmod().print = 0; // a failed factorization is handled, not reported
    factor_.compute(matrix);
    solvable_ = factor_.info() == Eigen::Success;
}

void DirichletSolver::solve(Eigen::MatrixXd& values, const Eigen::MatrixXd& source) const
{
    Eigen::MatrixXd fixed = values, right(free_.size(), values.cols());
    for (size_t i = 0; i < free_.size(); ++i) {
        fixed.row(free_[i]).setZero();
        right.row(static_cast<Eigen::Index>(i)) = source.row(free_[i]);
    }
    right -= toFixed_ * fixed;
    const OneSolverThread oneThread;
    const Eigen::MatrixXd solution = factor_.solve(right);
    for (size_t i = 0; i < free_.size(); ++i)
        values.row(free_[i]) = solution.row(static_cast<Eigen::Index>(i));
}

void DirichletSolver::solve(Eigen::MatrixXd& values) const
{
    solve(values, Eigen::MatrixXd::Zero(values.rows(), values.cols()));
}

} // namespace gimg

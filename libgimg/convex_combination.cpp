#include "convex_combination.h"

#include "one_solver_thread.h"

#include <Eigen/CholmodSupport>
#include <Eigen/UmfPackSupport>

#include <algorithm>

namespace gimg {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;
using Positions = Eigen::MatrixX2d;

struct MeanSystem
{
    std::vector<int> unknown; // per vertex: its row, or -1
    SparseMatrix matrix;
    Positions right;
};

// Rows of (sum of weights) x - sum of weight x_neighbour = 0, with what is known on the right; those of
// General are divided by the sum.
MeanSystem assemble(const std::vector<MeanWeight>& weights, Weights kind, const std::vector<bool>& fixed,
                    const std::vector<Vec2>& position)
{
    MeanSystem system;
    system.unknown.assign(position.size(), -1);
    std::vector<double> sum;
    for (const MeanWeight& w : weights) {
        int& row = system.unknown[w.vertex];
        if (fixed[w.vertex]) continue;
        if (row < 0) row = static_cast<int>(sum.size()), sum.push_back(0);
        sum[row] += w.weight;
    }
    const int unknowns = static_cast<int>(sum.size());
    system.right = Positions::Zero(unknowns, 2);
    std::vector<Eigen::Triplet<double>> entries;
    for (int row = 0; row < unknowns; ++row)
        entries.emplace_back(row, row, kind == Weights::Symmetric ? sum[row] : 1);
    for (const MeanWeight& w : weights) {
        const int row = system.unknown[w.vertex], column = system.unknown[w.neighbour];
        if (row < 0) continue;
        const double weight = kind == Weights::Symmetric ? w.weight : w.weight / sum[row];
        if (column >= 0)
            entries.emplace_back(row, column, -weight);
        else
            system.right.row(row) += weight * position[w.neighbour].transpose();
    }
    system.matrix.resize(unknowns, unknowns);
    system.matrix.setFromTriplets(entries.begin(), entries.end());
    return system;
}

bool solveSymmetric(const MeanSystem& system, Positions& solution)
{
    Eigen::CholmodSupernodalLLT<SparseMatrix, Eigen::Lower> solver;
    solver.cholmod().print = 0; // a failed factorization is handled, not reported
    solver.compute(system.matrix);
    if (solver.info() != Eigen::Success) return false;
    solution = solver.solve(system.right);
    return true;
}

bool solveGeneral(const MeanSystem& system, Positions& solution)
{
    Eigen::UmfPackLU<SparseMatrix> solver(system.matrix);
    if (solver.info() != Eigen::Success) return false;
    solution = solver.solve(system.right);
    return true;
}

} // namespace

Status placeAtMeans(const std::vector<MeanWeight>& weights, Weights kind, const std::vector<bool>& fixed,
                    std::vector<Vec2>& position)
{
    const MeanSystem system = assemble(weights, kind, fixed, position);
    if (system.right.rows() == 0) return Done{};
    const OneSolverThread oneThread;
    Positions solution;
    const bool solved =
        kind == Weights::Symmetric ? solveSymmetric(system, solution) : solveGeneral(system, solution);
    if (!solved || !solution.allFinite())
        return Error{ErrorKind::FlippedTriangle, "the linear system of the map could not be solved"};
    for (size_t v = 0; v < position.size(); ++v)
        if (system.unknown[v] >= 0) position[v] = solution.row(system.unknown[v]).transpose();
    return Done{};
}

} // namespace gimg

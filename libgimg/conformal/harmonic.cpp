#include "gimg/harmonic.h"

#include "conformal/closed_surface.h"
#include "one_solver_thread.h"

#include <Eigen/CholmodSupport>

#include <algorithm>
#include <cmath>

namespace gimg {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

// The Laplacian without the row and column of the first vertex that has a face, which is held at 0, and
// without those that have none.
struct Unknowns
{
    std::vector<int> row; // per vertex; -1
    int count = 0;
};

Unknowns unknownsOf(const Halfedges& he, int vertices)
{
    Unknowns unknowns;
    unknowns.row.assign(static_cast<size_t>(vertices), -1);
    bool held = false;
    for (int v = 0; v < vertices; ++v) {
        if (he.outgoing(v) < 0) continue;
        if (held) unknowns.row[v] = unknowns.count++;
        held = true;
    }
    return unknowns;
}

SparseMatrix lowerTriangle(const IntrinsicTriangulation& triangulation, const Eigen::VectorXd& weights,
                           const Unknowns& unknowns)
{
    std::vector<Eigen::Triplet<double>> entries;
    for (int h = 0; h < triangulation.halfedgeCount(); ++h) {
        const int i = unknowns.row[triangulation.tail(h)], j = unknowns.row[triangulation.head(h)];
        if (i < 0 || i == j) continue;
        entries.emplace_back(i, i, weights[h]);
        if (j < i && j >= 0) entries.emplace_back(i, j, -weights[h]);
    }
    SparseMatrix matrix(unknowns.count, unknowns.count);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

Eigen::VectorXd weightsOf(const IntrinsicTriangulation& triangulation)
{
    Eigen::VectorXd weights(triangulation.halfedgeCount());
    for (int h = 0; h < weights.size(); ++h)
        if (h < triangulation.twin(h)) weights[h] = weights[triangulation.twin(h)] = triangulation.weight(h);
    return weights;
}

OneForm carried(const IntrinsicTriangulation& triangulation, const OneForm& form)
{
    const std::vector<double> there = triangulation.carried({form.data(), form.data() + form.size()});
    return Eigen::Map<const Eigen::VectorXd>(there.data(), static_cast<Eigen::Index>(there.size()));
}

// Per vertex: the sum of weight times form over the halfedges that leave it.
Eigen::VectorXd outflow(const IntrinsicTriangulation& triangulation, const Eigen::VectorXd& weights,
                        const OneForm& carriedForm)
{
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(triangulation.vertexCount());
    for (int h = 0; h < weights.size(); ++h) sum[triangulation.tail(h)] += weights[h] * carriedForm[h];
    return sum;
}

} // namespace

struct HarmonicSolver::Parts
{
    Topology topology;
    Halfedges halfedges;
    IntrinsicTriangulation triangulation;
    Eigen::VectorXd weights; // per halfedge
    Unknowns unknowns;
    mutable Eigen::CholmodSupernodalLLT<SparseMatrix, Eigen::Lower> factorization;

    Eigen::MatrixXd flows(std::span<const OneForm> forms) const;
    bool solve(const Eigen::MatrixXd& right, Eigen::MatrixXd& solution) const;
};

HarmonicSolver::HarmonicSolver(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
HarmonicSolver::HarmonicSolver(HarmonicSolver&&) noexcept = default;
HarmonicSolver& HarmonicSolver::operator=(HarmonicSolver&&) noexcept = default;
HarmonicSolver::~HarmonicSolver() = default;

const IntrinsicTriangulation& HarmonicSolver::triangulation() const { return parts_->triangulation; }
const Topology& HarmonicSolver::topology() const { return parts_->topology; }

Result<HarmonicSolver> HarmonicSolver::of(const PolyhedralSurface& surface)
{
    Result<ClosedSurface> closed = closedSurface(surface, 0);
    if (!closed) return closed.error();
    Result<IntrinsicTriangulation> triangulation = IntrinsicTriangulation::of(surface);
    if (!triangulation) return triangulation.error();
    if (triangulation->makeDelaunay().negativeAfter > 0)
        return Error{ErrorKind::SolverFailure, "no Delaunay triangulation was found: triangles too degenerate"};
    Eigen::VectorXd weights = weightsOf(*triangulation);
    Unknowns unknowns = unknownsOf(closed->halfedges, surface.vertexCount);
    std::unique_ptr<Parts> parts(new Parts{closed->topology, std::move(closed->halfedges),
                                           std::move(*triangulation), std::move(weights),
                                           std::move(unknowns), {}});
    const OneSolverThread oneThread;
    parts->factorization.cholmod().print = 0; // a failed factorization is handled, not reported
    parts->factorization.compute(lowerTriangle(parts->triangulation, parts->weights, parts->unknowns));
    if (parts->factorization.info() != Eigen::Success)
        return Error{ErrorKind::SolverFailure, "the Laplacian could not be factored"};
    return HarmonicSolver(std::move(parts));
}

Eigen::MatrixXd HarmonicSolver::Parts::flows(std::span<const OneForm> forms) const
{
    Eigen::MatrixXd right(unknowns.count, static_cast<Eigen::Index>(forms.size()));
    for (Eigen::Index j = 0; j < right.cols(); ++j) {
        const Eigen::VectorXd flow = outflow(triangulation, weights, carried(triangulation, forms[j]));
        for (int v = 0; v < flow.size(); ++v)
            if (unknowns.row[v] >= 0) right(unknowns.row[v], j) = flow[v];
    }
    return right;
}

bool HarmonicSolver::Parts::solve(const Eigen::MatrixXd& right, Eigen::MatrixXd& solution) const
{
    const OneSolverThread oneThread;
    solution = factorization.solve(right);
    return factorization.info() == Eigen::Success && solution.allFinite();
}

// The flow out of each vertex goes back by df. The second round takes away what rounding left of the first.
Result<std::vector<OneForm>> HarmonicSolver::harmonic(std::span<const OneForm> forms) const
{
    const Parts& parts = *parts_;
    std::vector<OneForm> result(forms.begin(), forms.end());
    for (int round = 0; round < 2; ++round) {
        Eigen::MatrixXd solution;
        if (!parts.solve(parts.flows(result), solution))
            return Error{ErrorKind::SolverFailure, "a harmonic form has no finite solution"};
        Eigen::VectorXd f = Eigen::VectorXd::Zero(parts.triangulation.vertexCount());
        for (Eigen::Index j = 0; j < solution.cols(); ++j) {
            for (int v = 0; v < f.size(); ++v)
                if (parts.unknowns.row[v] >= 0) f[v] = solution(parts.unknowns.row[v], j);
            result[j] += exteriorDerivative(parts.halfedges, f);
        }
    }
    return result;
}

Eigen::MatrixXd HarmonicSolver::energies(std::span<const OneForm> forms) const
{
    const Eigen::Index n = static_cast<Eigen::Index>(forms.size());
    std::vector<OneForm> there;
    for (const OneForm& form : forms) there.push_back(carried(parts_->triangulation, form));
    Eigen::MatrixXd energies = Eigen::MatrixXd::Zero(n, n);
    // A slice of edges at a time, so that products are those of small matrices.
    constexpr int kSlice = 512;
    Eigen::MatrixXd slice(kSlice, n);
    const Eigen::VectorXd& weights = parts_->weights;
    for (int begin = 0, rows = 0; begin < weights.size(); rows = 0) {
        for (; begin < weights.size() && rows < kSlice; ++begin) {
            if (begin > parts_->triangulation.twin(begin)) continue;
            const double root = std::sqrt(std::max(weights[begin], 0.0));
            for (Eigen::Index j = 0; j < n; ++j) slice(rows, j) = root * there[j][begin];
            ++rows;
        }
        energies.selfadjointView<Eigen::Lower>().rankUpdate(slice.topRows(rows).transpose());
    }
    return energies.selfadjointView<Eigen::Lower>();
}

double HarmonicSolver::divergence(const OneForm& form) const
{
    const OneForm there = carried(parts_->triangulation, form);
    const double energy = 0.5 * (parts_->weights.array() * there.array().square()).sum();
    return outflow(parts_->triangulation, parts_->weights, there).cwiseAbs().maxCoeff() / std::sqrt(energy);
}

std::vector<OneForm> dualBasis(const Halfedges& halfedges, const CanonicalBasis& basis)
{
    std::vector<OneForm> forms;
    for (const Loop& b : basis.b) forms.push_back(-poincareDual(halfedges, b));
    for (const Loop& a : basis.a) forms.push_back(poincareDual(halfedges, a));
    return forms;
}

OneForm diffused(const IntrinsicTriangulation& triangulation, const Halfedges& halfedges, OneForm form, int steps)
{
    const Eigen::VectorXd weights = weightsOf(triangulation);
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(triangulation.vertexCount());
    for (int h = 0; h < weights.size(); ++h) sums[triangulation.tail(h)] += weights[h];
    Eigen::VectorXd f = Eigen::VectorXd::Zero(sums.size());
    const OneForm there = carried(triangulation, form);
    OneForm moved = there;
    for (int step = 0; step < steps; ++step) {
        const Eigen::VectorXd flow = outflow(triangulation, weights, moved);
        for (int v = 0; v < f.size(); ++v)
            if (sums[v] > 0) f[v] += 0.5 * flow[v] / sums[v];
        for (int h = 0; h < moved.size(); ++h)
            moved[h] = there[h] + f[triangulation.head(h)] - f[triangulation.tail(h)];
    }
    return form + exteriorDerivative(halfedges, f);
}

} // namespace gimg

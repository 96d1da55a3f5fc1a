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

Unknowns unknownsOf(const IntrinsicTriangulation& triangulation)
{
    Unknowns unknowns;
    unknowns.row.assign(static_cast<size_t>(triangulation.vertexCount()), -1);
    std::vector<bool> hasFace(unknowns.row.size(), false);
    for (int h = 0; h < triangulation.halfedgeCount(); ++h) hasFace[triangulation.tail(h)] = true;
    bool held = false;
    for (size_t v = 0; v < hasFace.size(); ++v) {
        if (!hasFace[v]) continue;
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
    Halfedges halfedges; ///< of the surface
    IntrinsicTriangulation triangulation;
    Eigen::VectorXd weights{}; ///< per halfedge of the triangulation
    Unknowns unknowns{};
    mutable Eigen::CholmodSupernodalLLT<SparseMatrix, Eigen::Lower> factorization{};

    Status factor();
    Result<Eigen::MatrixXd> potentials(std::span<const OneForm> onTriangulation) const;
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
    std::unique_ptr<Parts> parts(
        new Parts{closed->topology, std::move(closed->halfedges), std::move(*triangulation)});
    const Status factored = parts->factor();
    if (!factored) return factored.error();
    return HarmonicSolver(std::move(parts));
}

Status HarmonicSolver::Parts::factor()
{
    if (triangulation.makeDelaunay().negativeAfter > 0)
        return Error{ErrorKind::SolverFailure,
                     "no Delaunay triangulation was found: triangles too degenerate"};
    weights = weightsOf(triangulation);
    unknowns = unknownsOf(triangulation);
    const OneSolverThread oneThread;
    factorization.cholmod().print = 0; // a failed factorization is handled, not reported
    factorization.compute(lowerTriangle(triangulation, weights, unknowns));
    if (factorization.info() != Eigen::Success)
        return Error{ErrorKind::SolverFailure, "the Laplacian could not be factored"};
    return Done{};
}

// Per vertex and form: the function whose difference takes the flow out of each vertex back.
Result<Eigen::MatrixXd> HarmonicSolver::Parts::potentials(std::span<const OneForm> onTriangulation) const
{
    const Eigen::Index forms = static_cast<Eigen::Index>(onTriangulation.size());
    const int vertices = triangulation.vertexCount();
    Eigen::MatrixXd right(unknowns.count, forms);
    for (Eigen::Index j = 0; j < forms; ++j) {
        const Eigen::VectorXd flow = outflow(triangulation, weights, onTriangulation[j]);
        for (int v = 0; v < vertices; ++v)
            if (unknowns.row[v] >= 0) right(unknowns.row[v], j) = flow[v];
    }
    const OneSolverThread oneThread;
    const Eigen::MatrixXd solution = factorization.solve(right);
    if (factorization.info() != Eigen::Success || !solution.allFinite())
        return Error{ErrorKind::SolverFailure, "a harmonic form has no finite solution"};
    Eigen::MatrixXd f = Eigen::MatrixXd::Zero(vertices, forms);
    for (int v = 0; v < vertices; ++v)
        if (unknowns.row[v] >= 0) f.row(v) = solution.row(unknowns.row[v]);
    return f;
}

// The second round takes away what rounding left of the first.
Result<HarmonicForms> HarmonicSolver::harmonic(std::span<const OneForm> forms) const
{
    const Parts& parts = *parts_;
    HarmonicForms result;
    result.onSurface.assign(forms.begin(), forms.end());
    for (const OneForm& form : forms) result.onTriangulation.push_back(carried(parts.triangulation, form));
    for (int round = 0; round < 2; ++round) {
        const Result<Eigen::MatrixXd> f = parts.potentials(result.onTriangulation);
        if (!f) return f.error();
        for (size_t j = 0; j < forms.size(); ++j) {
            const Eigen::VectorXd own = f->col(static_cast<Eigen::Index>(j));
            result.onSurface[j] += exteriorDerivative(parts.halfedges, own);
            OneForm& there = result.onTriangulation[j];
            for (int h = 0; h < there.size(); ++h)
                there[h] += own[parts.triangulation.head(h)] - own[parts.triangulation.tail(h)];
        }
    }
    return result;
}

Eigen::MatrixXd HarmonicSolver::energies(std::span<const OneForm> onTriangulation) const
{
    const Eigen::Index n = static_cast<Eigen::Index>(onTriangulation.size());
    Eigen::MatrixXd energies = Eigen::MatrixXd::Zero(n, n);
    // A slice of edges at a time, so that products are those of small matrices.
    constexpr int kSlice = 512;
    Eigen::MatrixXd slice(kSlice, n);
    const Eigen::VectorXd& weights = parts_->weights;
    for (int h = 0, rows = 0; h < weights.size(); rows = 0) {
        for (; h < weights.size() && rows < kSlice; ++h) {
            if (h > parts_->triangulation.twin(h)) continue;
            const double root = std::sqrt(std::max(weights[h], 0.0));
            for (Eigen::Index j = 0; j < n; ++j) slice(rows, j) = root * onTriangulation[j][h];
            ++rows;
        }
        energies.selfadjointView<Eigen::Lower>().rankUpdate(slice.topRows(rows).transpose());
    }
    return energies.selfadjointView<Eigen::Lower>();
}

// |*a - b|^2 = |a|^2 + |b|^2 - 2 <*a, b>, and <*a, b> dA = a ^ b.
Eigen::VectorXd HarmonicSolver::conjugateErrors(const OneForm& a, const OneForm& b) const
{
    const IntrinsicTriangulation& triangulation = parts_->triangulation;
    Eigen::VectorXd errors = Eigen::VectorXd::Zero(triangulation.faceCount());
    for (int h = 0; h < triangulation.halfedgeCount(); ++h) {
        const int next = triangulation.next(h);
        const double wedge = (a[h] * b[next] - a[next] * b[h]) / 6;
        errors[triangulation.face(h)] +=
            0.5 * triangulation.cotangent(h) * (a[h] * a[h] + b[h] * b[h]) - 2 * wedge;
    }
    return errors.cwiseMax(0);
}

Status HarmonicSolver::refine(const Eigen::VectorXd& pieces)
{
    IntrinsicTriangulation& triangulation = parts_->triangulation;
    if (pieces.size() != triangulation.faceCount() || !pieces.allFinite())
        return Error{ErrorKind::BadArgument, "refining needs one finite number of pieces per face"};
    std::vector<double> wanted(pieces.data(), pieces.data() + pieces.size());
    for (double& count : wanted) count = std::min(count, 16.0);
    for (int halving = 0; halving < 4; ++halving) {
        const int before = triangulation.halfedgeCount();
        std::vector<int> longest(wanted.size(), -1); // halfedge of each face
        for (int h = 0; h < before; ++h) {
            int& own = longest[triangulation.face(h)];
            if (own < 0 || triangulation.length(h) > triangulation.length(own)) own = h;
        }
        std::vector<bool> isSplit(static_cast<size_t>(before), false);
        for (const int h : longest) {
            const int twin = triangulation.twin(h), face = triangulation.face(h),
                      other = triangulation.face(twin);
            if (isSplit[h] || wanted[face] < 2 || triangulation.split(h) < 0) continue;
            isSplit[h] = isSplit[twin] = true;
            for (const int halved : {face, other}) { // the new faces come in this order
                wanted[halved] *= 0.5;
                wanted.push_back(double(wanted[halved]));
            }
        }
    }
    return parts_->factor();
}

double HarmonicSolver::divergence(const OneForm& onTriangulation) const
{
    const double energy = 0.5 * (parts_->weights.array() * onTriangulation.array().square()).sum();
    return outflow(parts_->triangulation, parts_->weights, onTriangulation).cwiseAbs().maxCoeff() /
           std::sqrt(energy);
}

std::vector<OneForm> dualBasis(const Halfedges& halfedges, const CanonicalBasis& basis)
{
    std::vector<OneForm> forms;
    for (const Loop& b : basis.b) forms.push_back(-poincareDual(halfedges, b));
    for (const Loop& a : basis.a) forms.push_back(poincareDual(halfedges, a));
    return forms;
}

OneForm diffused(const IntrinsicTriangulation& triangulation, const Halfedges& halfedges, OneForm form,
                 int steps)
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

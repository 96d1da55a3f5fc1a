#include "gimg/stretch.h"

#include "one_solver_thread.h"
#include "stretch_descent.h"
#include "stretch_element.h"

#include <Eigen/CholmodSupport>
#include <Eigen/Sparse>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace gimg {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

// Sums in index order, so that the result does not depend on the number of threads.
template <class Term> double orderedSum(int count, std::vector<double>& scratch, Term term)
{
    scratch.resize(static_cast<size_t>(count));
    tbb::parallel_for(0, count, [&](int i) { scratch[i] = term(i); });
    double sum = 0;
    for (double x : scratch) sum += x;
    return sum;
}

class StretchDescent
{
public:
    StretchDescent(const Mesh& mesh, const std::vector<double>& importance,
                   const std::vector<Freedom>& freedom, int unknowns, std::vector<Vec2>& st)
        : mesh_(mesh), freedom_(freedom), unknowns_(unknowns), st_(st)
    {
        elements_.reserve(mesh.faces.size());
        for (const Triangle& f : mesh.faces)
            elements_.emplace_back(mesh.positions[f[0]], mesh.positions[f[1]], mesh.positions[f[2]],
                                   meanImportance(importance, f));
        if (unknowns_ > 0) buildPattern();
    }

    double run(const DescentOptions& options)
    {
        double energy = energyAt(st_);
        if (unknowns_ == 0) return energy;
        solver_.cholmod().final_ll = 1; // a negative pivot is a failure
        solver_.cholmod().print = 0;    // a failed factorization is handled, not reported
        solver_.analyzePattern(hessian_);
        for (int iteration = 0; iteration < options.maxIterations; ++iteration) {
            assemble();
            if (!factorize()) break;
            const Eigen::VectorXd step = solver_.solve(-gradient_);
            const double slope = gradient_.dot(step);
            if (!(slope < 0)) break;
            const double lowered = lineSearch(step, slope, energy);
            const double gain = energy - lowered;
            energy = lowered;
            if (gain < options.tolerance * energy) break;
        }
        return energy;
    }

private:
    std::array<Vec2, 3> corners(int f, const std::vector<Vec2>& st) const
    {
        const Triangle& t = mesh_.faces[f];
        return {st[t[0]], st[t[1]], st[t[2]]};
    }

    double energyAt(const std::vector<Vec2>& st)
    {
        return orderedSum(mesh_.faceCount(), scratch_,
                          [&](int f) { return elements_[f].energy(corners(f, st)); });
    }

    // Row and sign of the local unknown k (0..2: s of corner k, 3..5: t); the row is -1 where it is fixed.
    int row(int f, int k) const { return freedom_[mesh_.faces[f][k % 3]].row[k / 3]; }
    double sign(int f, int k) const { return freedom_[mesh_.faces[f][k % 3]].sign[k / 3]; }

    // Unknowns of a face meet where corners coincide or an edge joins them: once a vertex, once an edge.
    void buildPattern()
    {
        std::vector<uint64_t> entries; // column, row of the lower triangle
        const auto meet = [&](int v, int w) {
            for (int a : freedom_[v].row)
                for (int b : freedom_[w].row)
                    if (a >= 0 && b >= 0)
                        entries.push_back(static_cast<uint64_t>(std::min(a, b)) << 32 | std::max(a, b));
        };
        entries.reserve(6 * mesh_.positions.size() + 6 * mesh_.faces.size());
        for (int v = 0; v < mesh_.vertexCount(); ++v) meet(v, v);
        const Halfedges he(mesh_.faces, mesh_.vertexCount());
        for (int h = 0; h < he.count(); ++h)
            if (he.onBoundary(h) || h < he.twin(h)) meet(he.tail(h), he.head(h));
        std::sort(entries.begin(), entries.end());
        entries.erase(std::unique(entries.begin(), entries.end()), entries.end());

        hessian_.resize(unknowns_, unknowns_);
        hessian_.resizeNonZeros(static_cast<Eigen::Index>(entries.size()));
        std::fill(hessian_.outerIndexPtr(), hessian_.outerIndexPtr() + unknowns_ + 1, 0);
        for (size_t k = 0; k < entries.size(); ++k) {
            hessian_.innerIndexPtr()[k] = static_cast<int>(entries[k] & 0xffffffff);
            ++hessian_.outerIndexPtr()[(entries[k] >> 32) + 1];
        }
        std::partial_sum(hessian_.outerIndexPtr(), hessian_.outerIndexPtr() + unknowns_ + 1,
                         hessian_.outerIndexPtr());

        slots_.resize(elements_.size());
        tbb::parallel_for(0, mesh_.faceCount(), [&](int f) {
            auto slot = slots_[f].begin();
            for (int i = 0; i < 6; ++i)
                for (int j = 0; j <= i; ++j) *slot++ = slotOf(row(f, i), row(f, j));
        });
    }

    // Where the entry of two rows lies among the matrix values; -1 if one of them is fixed.
    int slotOf(int a, int b) const
    {
        if (a < 0 || b < 0) return -1;
        const int* begin = hessian_.innerIndexPtr() + hessian_.outerIndexPtr()[std::min(a, b)];
        const int* end = hessian_.innerIndexPtr() + hessian_.outerIndexPtr()[std::min(a, b) + 1];
        return static_cast<int>(std::lower_bound(begin, end, std::max(a, b)) - hessian_.innerIndexPtr());
    }

    // Derivatives in parallel, sums in the order of the faces; block by block, for memory.
    void assemble()
    {
        constexpr int kBlock = 1 << 14;
        gradient_.setZero(unknowns_);
        double* values = hessian_.valuePtr();
        std::fill(values, values + hessian_.nonZeros(), 0.0);
        derivatives_.resize(std::min<size_t>(kBlock, elements_.size()));
        for (int first = 0; first < mesh_.faceCount(); first += kBlock) {
            const int last = std::min(mesh_.faceCount(), first + kBlock);
            tbb::parallel_for(first, last, [&](int f) {
                derivatives_[f - first] = elements_[f].derivatives(corners(f, st_));
            });
            for (int f = first; f < last; ++f) {
                const StretchElement::Derivatives& d = derivatives_[f - first];
                auto slot = slots_[f].begin();
                for (int i = 0; i < 6; ++i) {
                    if (row(f, i) >= 0) gradient_[row(f, i)] += sign(f, i) * d.gradient[i];
                    for (int j = 0; j <= i; ++j, ++slot) {
                        if (*slot < 0) continue;
                        const double entry = sign(f, i) * sign(f, j) * d.hessian(i, j);
                        values[*slot] += j < i && row(f, i) == row(f, j) ? 2 * entry : entry;
                    }
                }
            }
        }
    }

    // The matrix is positive semi-definite but for rounding; where that shows, the diagonal grows.
    bool factorize()
    {
        for (double shift = 1e-10; shift < 1; shift *= 100) {
            for (int k = 0; k < unknowns_; ++k) hessian_.valuePtr()[hessian_.outerIndexPtr()[k]] *= 1 + shift;
            solver_.factorize(hessian_);
            if (solver_.info() == Eigen::Success) return true;
        }
        return false;
    }

    Vec2 movement(int v, const Eigen::VectorXd& step) const
    {
        Vec2 by = Vec2::Zero();
        for (int c = 0; c < 2; ++c)
            if (freedom_[v].row[c] >= 0) by[c] = freedom_[v].sign[c] * step[freedom_[v].row[c]];
        return by;
    }

    void moved(const Eigen::VectorXd& step, double t, std::vector<Vec2>& out) const
    {
        out = st_;
        for (size_t v = 0; v < out.size(); ++v) out[v] += t * movement(static_cast<int>(v), step);
    }

    // Largest t at which no triangle has collapsed yet.
    double stepToFirstCollapse(const Eigen::VectorXd& step) const
    {
        double limit = std::numeric_limits<double>::infinity();
        for (int f = 0; f < mesh_.faceCount(); ++f) {
            const std::array<Vec2, 3> p = corners(f, st_);
            Vec2 d[3];
            for (int k = 0; k < 3; ++k) d[k] = movement(mesh_.faces[f][k], step);
            limit = std::min(limit, firstCollapse(p, {d[0], d[1], d[2]}));
        }
        return limit;
    }

    double lineSearch(const Eigen::VectorXd& step, double slope, double energy)
    {
        double t = std::min(1.0, 0.9 * stepToFirstCollapse(step));
        std::vector<Vec2> trial, best;
        for (int halvings = 0; halvings < 40; ++halvings, t *= 0.5) {
            moved(step, t, trial);
            double lowered = energyAt(trial);
            if (!(lowered <= energy + 1e-4 * t * slope)) continue;
            // Far from the minimum the convexified step is short: lengthen it while that pays.
            if (halvings == 0)
                for (double longer = 1.6 * t; longer < 20; longer *= 1.6) {
                    moved(step, longer, best);
                    const double further = energyAt(best);
                    if (!(further < lowered)) break;
                    lowered = further;
                    trial.swap(best);
                }
            st_.swap(trial);
            return lowered;
        }
        return energy;
    }

    const Mesh& mesh_;
    const std::vector<Freedom>& freedom_;
    int unknowns_;
    std::vector<Vec2>& st_;
    std::vector<StretchElement> elements_;
    std::vector<StretchElement::Derivatives> derivatives_;
    std::vector<std::array<int, 21>> slots_; // where each pair (i, j <= i) of a face's 6 unknowns lies
    SparseMatrix hessian_;                   // lower triangle
    Eigen::VectorXd gradient_;
    std::vector<double> scratch_;
    Eigen::CholmodDecomposition<SparseMatrix, Eigen::Lower> solver_; // supernodal where matrices are large
};

} // namespace

double stretchEnergy(const Mesh& mesh, const std::vector<Vec2>& st)
{
    double energy = 0;
    for (const Triangle& f : mesh.faces) {
        const StretchElement element(mesh.positions[f[0]], mesh.positions[f[1]], mesh.positions[f[2]]);
        energy += element.area() * element.squaredStretch({st[f[0]], st[f[1]], st[f[2]]});
    }
    return energy;
}

double quarticStretchEnergy(const Mesh& mesh, const std::vector<Vec2>& st)
{
    double energy = 0;
    for (const Triangle& f : mesh.faces)
        energy += StretchElement(mesh.positions[f[0]], mesh.positions[f[1]], mesh.positions[f[2]])
                      .energy({st[f[0]], st[f[1]], st[f[2]]});
    return energy;
}

double stretchEfficiency(const Mesh& mesh, const std::vector<Vec2>& st)
{
    const double area = surfaceArea(mesh);
    return area * area / stretchEnergy(mesh, st);
}

std::vector<double> faceStretch(const Mesh& mesh, const std::vector<Vec2>& st)
{
    const double area = surfaceArea(mesh);
    std::vector<double> stretch;
    stretch.reserve(mesh.faces.size());
    for (const Triangle& f : mesh.faces) {
        const StretchElement element(mesh.positions[f[0]], mesh.positions[f[1]], mesh.positions[f[2]]);
        stretch.push_back(std::sqrt(element.squaredStretch({st[f[0]], st[f[1]], st[f[2]]}) / area));
    }
    return stretch;
}

int flippedTriangles(const std::vector<Triangle>& faces, const std::vector<Vec2>& st)
{
    int flipped = 0;
    for (const Triangle& f : faces) flipped += !(doubleArea({st[f[0]], st[f[1]], st[f[2]]}) > 0);
    return flipped;
}

double minimizeStretch(const Mesh& mesh, const std::vector<double>& importance,
                       const std::vector<Freedom>& freedom, int unknowns, std::vector<Vec2>& st,
                       const DescentOptions& options)
{
    const OneSolverThread oneThread;
    return StretchDescent(mesh, importance, freedom, unknowns, st).run(options);
}

double minimizeStretch(const Mesh& mesh, const std::vector<bool>& fixed, std::vector<Vec2>& st,
                       const DescentOptions& options)
{
    std::vector<Freedom> freedom(mesh.positions.size());
    int unknowns = 0;
    for (const Triangle& f : mesh.faces)
        for (int v : f)
            if (!fixed[v] && freedom[v].row[0] < 0) {
                freedom[v].row = {unknowns, unknowns + 1};
                unknowns += 2;
            }
    return minimizeStretch(mesh, {}, freedom, unknowns, st, options);
}

} // namespace gimg

#include "conformal/lattice.h"

#include <Eigen/Cholesky>
#include <Eigen/Jacobi>

#include <algorithm>
#include <cmath>

namespace gimg {

// Row operations on a basis B of the integer vectors. The factor L of B G B' = L L' has the lengths of the
// orthogonalised vectors on its diagonal and their projections beside it. An exchange of two rows leaves one
// entry above the diagonal, which a rotation of two columns takes away.
Eigen::MatrixXi reducedLattice(const Eigen::MatrixXd& gram)
{
    constexpr double kLovasz = 0.99;
    constexpr int kMostExchanges = 100'000;
    const Eigen::Index n = gram.rows();
    Eigen::MatrixXi basis = Eigen::MatrixXi::Identity(n, n);
    Eigen::MatrixXd factor = gram.llt().matrixL();
    int exchanges = 0;
    for (Eigen::Index k = 1; k < n && exchanges < kMostExchanges;) {
        for (Eigen::Index j = k - 1; j >= 0; --j) {
            const double times = std::round(factor(k, j) / factor(j, j));
            if (times == 0) continue;
            basis.row(k) -= static_cast<int>(times) * basis.row(j);
            factor.row(k).head(j + 1) -= times * factor.row(j).head(j + 1);
        }
        const double length = std::hypot(factor(k, k), factor(k, k - 1)), before = factor(k - 1, k - 1);
        if (length * length >= kLovasz * before * before) {
            ++k;
            continue;
        }
        basis.row(k).swap(basis.row(k - 1));
        factor.row(k).swap(factor.row(k - 1));
        Eigen::JacobiRotation<double> rotation;
        rotation.makeGivens(factor(k - 1, k - 1), factor(k - 1, k));
        factor.bottomRows(n - k + 1).applyOnTheRight(k - 1, k, rotation);
        factor(k - 1, k) = 0;
        for (const Eigen::Index j : {k - 1, k})
            if (factor(j, j) < 0) factor.col(j) = -factor.col(j);
        ++exchanges;
        k = std::max<Eigen::Index>(k - 1, 1);
    }
    return basis;
}

namespace {

/// The search one coordinate at a time, the last first: |U (v - center)|^2 is summed from below.
struct Enumeration
{
    Eigen::MatrixXd upper; // U' U = G
    const Eigen::VectorXd& center;
    long& nodesLeft;
    const std::function<bool(const Eigen::VectorXi&)>& visit;
    Eigen::VectorXi v;

    bool descend(Eigen::Index i, double budget)
    {
        double beside = 0;
        for (Eigen::Index j = i + 1; j < v.size(); ++j) beside += upper(i, j) * (v[j] - center[j]);
        const double middle = center[i] - beside / upper(i, i), reach = std::sqrt(budget) / upper(i, i);
        // (Beyond the range of integers, nothing is looked for.)
        const double low = std::ceil(std::max(middle - reach, -1e9)),
                     high = std::floor(std::min(middle + reach, 1e9));
        for (double x = low; x <= high; ++x) {
            if (--nodesLeft < 0) return false;
            v[i] = static_cast<int>(x);
            const double step = upper(i, i) * (x - middle);
            if (i == 0 ? !visit(v) : !descend(i - 1, std::max(0.0, budget - step * step))) return false;
        }
        return true;
    }
};

} // namespace

void forEachLatticePoint(const Eigen::MatrixXd& gram, const Eigen::VectorXd& center, double squaredRadius,
                         long& nodesLeft, const std::function<bool(const Eigen::VectorXi&)>& visit)
{
    Enumeration search{gram.llt().matrixU(), center, nodesLeft, visit, Eigen::VectorXi::Zero(gram.rows())};
    search.descend(gram.rows() - 1, squaredRadius * (1 + 1e-12));
}

} // namespace gimg

#include "gimg/homology.h"

#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>
#include <utility>

namespace gimg {
namespace {

using Integers = Eigen::Matrix<int64_t, Eigen::Dynamic, Eigen::Dynamic>;

constexpr int64_t kLargest = std::numeric_limits<int32_t>::max();

/// Integer row and column operations on the intersection matrix Q = A' Q0 A, with A.
struct Congruence
{
    Integers q, a;

    void swap(Eigen::Index i, Eigen::Index j)
    {
        q.row(i).swap(q.row(j));
        q.col(i).swap(q.col(j));
        a.col(i).swap(a.col(j));
    }
    void addTimes(Eigen::Index to, Eigen::Index from, int64_t times)
    {
        q.row(to) += times * q.row(from);
        q.col(to) += times * q.col(from);
        a.col(to) += times * a.col(from);
    }
    void negate(Eigen::Index i)
    {
        q.row(i) = -q.row(i);
        q.col(i) = -q.col(i);
        a.col(i) = -a.col(i);
    }
    bool isTooLarge() const
    {
        return q.cwiseAbs().maxCoeff() > kLargest || a.cwiseAbs().maxCoeff() > kLargest;
    }
};

// The first pair from `begin` on with the least nonzero intersection number.
std::optional<std::pair<Eigen::Index, Eigen::Index>> leastPair(const Integers& q, Eigen::Index begin)
{
    std::optional<std::pair<Eigen::Index, Eigen::Index>> least;
    for (Eigen::Index i = begin; i < q.rows(); ++i)
        for (Eigen::Index j = i + 1; j < q.rows(); ++j) {
            const int64_t number = std::abs(q(i, j));
            if (number == 0 || (least && number >= std::abs(q(least->first, least->second)))) continue;
            least = {i, j};
            if (number == 1) return least;
        }
    return least;
}

// Makes loops `k` and `k + 1` meet once and the later ones not meet them.
bool separatePair(Congruence& congruence, Eigen::Index k)
{
    Integers& q = congruence.q;
    for (;;) {
        const auto pair = leastPair(q, k);
        if (!pair) return false;
        congruence.swap(k, pair->first);
        congruence.swap(k + 1, pair->second);
        const int64_t number = q(k, k + 1);
        for (Eigen::Index i = k + 2; i < q.rows(); ++i) {
            congruence.addTimes(i, k + 1, -(q(k, i) / number));
            congruence.addTimes(i, k, q(k + 1, i) / number);
        }
        if (congruence.isTooLarge()) return false;
        const auto rest = q.middleRows(k, 2).rightCols(q.cols() - k - 2);
        if (std::abs(number) == 1) break;
        if (rest.isZero()) return false; // the determinant is not 1
    }
    if (q(k, k + 1) < 0) congruence.negate(k + 1);
    return true;
}

} // namespace

Result<Eigen::MatrixXi> symplecticCongruence(const Eigen::MatrixXi& intersections)
{
    const Eigen::Index n = intersections.rows();
    if (n != intersections.cols() || n % 2 != 0 || intersections != -intersections.transpose())
        return Error{ErrorKind::BadArgument, "an intersection matrix is antisymmetric and of even size"};
    Congruence congruence{intersections.cast<int64_t>(), Integers::Identity(n, n)};
    for (Eigen::Index k = 0; k < n; k += 2)
        if (!separatePair(congruence, k))
            return Error{ErrorKind::BadArgument,
                         "these intersection numbers are not those of a basis, or too large"};
    Eigen::MatrixXi a(n, n);
    for (Eigen::Index i = 0; i < n / 2; ++i) {
        a.col(i) = congruence.a.col(2 * i).cast<int>();
        a.col(n / 2 + i) = congruence.a.col(2 * i + 1).cast<int>();
    }
    return a;
}

} // namespace gimg

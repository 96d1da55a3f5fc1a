#include "conformal/primitive_set.h"

#include <cstdlib>
#include <numeric>

namespace gimg {

bool PrimitiveSet::add(const Eigen::VectorXi& v)
{
    constexpr int64_t kLargest = int64_t{1} << 40;
    const Eigen::Index n = toUnits_.rows(), k = size_;
    Eigen::Matrix<int64_t, Eigen::Dynamic, 1> w = toUnits_ * v.cast<int64_t>();
    int64_t divisor = 0;
    for (Eigen::Index i = k; i < n; ++i) divisor = std::gcd(divisor, w[i]);
    if (divisor != 1) return false;
    // Euclid's algorithm on the rows, the least remainder first, until one of them has the 1 and the others
    // 0.
    Matrix reduced = toUnits_;
    for (;;) {
        Eigen::Index least = -1;
        int others = 0;
        for (Eigen::Index i = k; i < n; ++i) {
            if (w[i] == 0) continue;
            ++others;
            if (least < 0 || std::abs(w[i]) < std::abs(w[least])) least = i;
        }
        if (others == 1) {
            reduced.row(least).swap(reduced.row(k));
            break;
        }
        for (Eigen::Index i = k; i < n; ++i) {
            if (i == least || w[i] == 0) continue;
            const int64_t quotient = w[i] / w[least];
            w[i] -= quotient * w[least];
            reduced.row(i) -= quotient * reduced.row(least);
        }
        if (reduced.cwiseAbs().maxCoeff() > kLargest) return false;
    }
    toUnits_ = reduced;
    ++size_;
    return true;
}

} // namespace gimg

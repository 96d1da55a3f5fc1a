#include "linear_fit.h"

#include <cmath>

namespace gimg::codec {

namespace {

/// A weight is expected within 1/10 of its start: 1/100 of the errors' variance.
constexpr double kPull = 100;
/// Keeps the products positive definite; relative to their trace.
constexpr double kRidge = 1e-12;

} // namespace

void LinearFit::begin(const double* start, unsigned count)
{
    count_ = count;
    squaredErrors_ = examples_ = 0;
    for (unsigned k = 0; k < count; ++k) {
        start_[k] = weights_[k] = start[k];
        targets_[k] = 0;
        for (unsigned l = 0; l <= k; ++l) products_[k][l] = 0;
    }
}

void LinearFit::learn(const double* x, double y, double error, double weight)
{
    squaredErrors_ += weight * (error * error);
    examples_ += 1.0;
    for (unsigned k = 0; k < count_; ++k) {
        const double weighted = weight * x[k];
        targets_[k] += weighted * y;
        for (unsigned l = 0; l <= k; ++l) products_[k][l] += weighted * x[l];
    }
}

void LinearFit::fade(double factor)
{
    squaredErrors_ *= factor;
    examples_ *= factor;
    for (unsigned k = 0; k < count_; ++k) {
        targets_[k] *= factor;
        for (unsigned l = 0; l <= k; ++l) products_[k][l] *= factor;
    }
}

// (products + pull I) w = targets + pull start, by Cholesky's factors.
void LinearFit::solve()
{
    if (!(examples_ > 0)) return;
    double trace = 0;
    for (unsigned k = 0; k < count_; ++k) trace += products_[k][k];
    const double pull = kPull * (squaredErrors_ / examples_) + kRidge * trace;
    double factor[kMost][kMost], solution[kMost];
    for (unsigned k = 0; k < count_; ++k)
        for (unsigned l = 0; l <= k; ++l) {
            double value = products_[k][l];
            if (l == k) value += pull;
            for (unsigned q = 0; q < l; ++q) value -= factor[k][q] * factor[l][q];
            if (l < k) {
                factor[k][l] = value / factor[l][l];
            } else {
                if (!(value > 0)) return;
                factor[k][k] = std::sqrt(value);
            }
        }
    for (unsigned k = 0; k < count_; ++k) {
        double value = targets_[k] + pull * start_[k];
        for (unsigned q = 0; q < k; ++q) value -= factor[k][q] * solution[q];
        solution[k] = value / factor[k][k];
    }
    for (unsigned k = count_; k-- > 0;) {
        double value = solution[k];
        for (unsigned q = k + 1; q < count_; ++q) value -= factor[q][k] * solution[q];
        solution[k] = value / factor[k][k];
    }
    for (unsigned k = 0; k < count_; ++k) weights_[k] = solution[k];
}

} // namespace gimg::codec

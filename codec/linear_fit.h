#pragma once

namespace gimg::codec {

/// Weighted least squares that forgets: weights w for which the sum of w[k] x[k] came nearest to y over the
/// examples so far, drawn towards a given start where examples are few or say little.
class LinearFit
{
public:
    static constexpr unsigned kMost = 15;

    /// @param start  `count` weights, to which the fit is drawn
    void begin(const double* start, unsigned count);

    double estimate(const double* x) const
    {
        double sum = 0;
        for (unsigned k = 0; k < count_; ++k) sum += weights_[k] * x[k];
        return sum;
    }

    /// An example that was estimated with an error, and what it counts.
    void learn(const double* x, double y, double error, double weight);

    /// All examples so far count less.
    void fade(double factor);

    /// Fits the weights to the examples. They stay what they are if the examples do not tell.
    void solve();

private:
    double products_[kMost][kMost]; // of x with x, lower half
    double targets_[kMost];         // of x with y
    double start_[kMost], weights_[kMost];
    double squaredErrors_, examples_;
    unsigned count_;
};

} // namespace gimg::codec

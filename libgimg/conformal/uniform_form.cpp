#include "conformal/face_forms.h"
#include "gimg/global_parameterization.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <string>

namespace gimg {
namespace {

constexpr int kMoreStarts = 12;
constexpr int kFacesOfStarts = 4000;
constexpr int kMostSteps = 500;
constexpr double kEnough = 1e-9; // of unevenness gained in a step

/// Unevenness as a function of coefficients, in a basis of forms that are orthonormal over the faces taken.
class Unevenness
{
public:
    Unevenness(const FaceForms& faces, Eigen::Index stride, bool realOnly) : realOnly_(realOnly)
    {
        const Eigen::Index count = (faces.share.size() + stride - 1) / stride;
        x_.resize(count, faces.x.cols());
        y_.resize(count, faces.x.cols());
        share_.resize(count);
        for (Eigen::Index i = 0; i < count; ++i) {
            x_.row(i) = faces.x.row(i * stride);
            y_.row(i) = faces.y.row(i * stride);
            share_[i] = faces.share[i * stride];
        }
        share_ /= share_.sum();
        const Eigen::MatrixXcd gram = weighted(share_);
        const Eigen::LLT<Eigen::MatrixXcd> factor(gram);
        regular_ = factor.info() == Eigen::Success;
        if (!regular_) return;
        // c = L'^-1 d has mean conformal factor |d|^2.
        toCoefficients_ = factor.matrixU().solve(Eigen::MatrixXcd::Identity(gram.rows(), gram.rows()));
        x_ = x_ * toCoefficients_;
        y_ = y_ * toCoefficients_;
    }

    bool regular() const { return regular_; }
    Eigen::VectorXcd coefficients(const Eigen::VectorXcd& d) const { return toCoefficients_ * d; }
    Eigen::VectorXcd orthonormal(const Eigen::VectorXcd& c) const
    {
        return toCoefficients_.triangularView<Eigen::Upper>().solve(c);
    }

    /// @param d  of length 1
    double at(const Eigen::VectorXcd& d) const { return -(share_.array() * factorOf(d).array().log()).sum(); }

    /// Where the gradient vanishes d is (a multiple of) this: sum over faces of share H d / (d' H d).
    Eigen::VectorXcd step(const Eigen::VectorXcd& d) const
    {
        const Eigen::VectorXd weight = share_.cwiseQuotient(factorOf(d));
        const auto part = [&](const Eigen::MatrixXcd& m) -> Eigen::VectorXcd {
            const Eigen::VectorXcd values = m * d;
            return m.adjoint() * weight.cwiseProduct(values) / 2;
        };
        Eigen::VectorXcd next = part(x_) + part(y_);
        if (realOnly_) next = next.real().cast<std::complex<double>>().eval();
        return next.normalized();
    }

private:
    Eigen::VectorXd factorOf(const Eigen::VectorXcd& d) const
    {
        return (((x_ * d).cwiseAbs2() + (y_ * d).cwiseAbs2()) / 2).cwiseMax(kLeastFactor);
    }
    Eigen::MatrixXcd weighted(const Eigen::VectorXd& weight) const
    {
        Eigen::MatrixXcd gram =
            (x_.adjoint() * weight.asDiagonal() * x_ + y_.adjoint() * weight.asDiagonal() * y_) / 2;
        if (realOnly_) gram = gram.real().cast<std::complex<double>>().eval();
        return gram;
    }

    bool realOnly_, regular_ = false;
    Eigen::MatrixXcd x_, y_, toCoefficients_;
    Eigen::VectorXd share_;
};

struct Descent
{
    Eigen::VectorXcd d;
    double energy = 0;
    int steps = 0;
};

// The fixed-point step, halved until it descends.
Descent descend(const Unevenness& unevenness, Eigen::VectorXcd d)
{
    Descent at{d.normalized(), 0, 0};
    at.energy = unevenness.at(at.d);
    for (; at.steps < kMostSteps; ++at.steps) {
        const Eigen::VectorXcd target = unevenness.step(at.d);
        const double before = at.energy;
        for (double t = 1; t > 1e-3; t /= 2) {
            const Eigen::VectorXcd next = (at.d + t * (target - at.d)).normalized();
            const double energy = unevenness.at(next);
            if (!(energy < at.energy)) continue;
            at.d = next;
            at.energy = energy;
            break;
        }
        if (!(at.energy < before - kEnough)) break;
    }
    return at;
}

// The forms one by one, then mixtures of all with scattered weights.
std::vector<Eigen::VectorXcd> startsFor(Eigen::Index n, bool realOnly)
{
    std::vector<Eigen::VectorXcd> starts;
    for (Eigen::Index i = 0; i < n; ++i) starts.push_back(Eigen::VectorXcd::Unit(n, i));
    if (n == 1) return starts;
    double phase = 0;
    for (int k = 0; k < kMoreStarts; ++k) {
        Eigen::VectorXcd d(n);
        for (Eigen::Index i = 0; i < n; ++i) {
            phase += 0.6180339887498949 * 2 * 3.141592653589793 * static_cast<double>(i + 1);
            d[i] = realOnly ? std::complex<double>(std::cos(phase), 0) : std::polar(1.0, phase);
        }
        starts.push_back(d);
    }
    return starts;
}

} // namespace

Result<UniformForm> mostUniformForm(const Mesh& mesh, std::span<const ComplexOneForm> basis, bool realOnly)
{
    for (const ComplexOneForm& form : basis)
        if (form.size() != 3 * static_cast<Eigen::Index>(mesh.faceCount()))
            return Error{ErrorKind::BadArgument, std::to_string(form.size()) + " numbers of a 1-form for " +
                                                     std::to_string(mesh.faceCount()) + " faces"};
    if (basis.empty()) return Error{ErrorKind::BadArgument, "no form to combine"};
    const FaceForms faces = faceForms(mesh, basis);
    const Unevenness some(faces, std::max(mesh.faceCount() / kFacesOfStarts, 1), realOnly);
    const Unevenness all(faces, 1, realOnly);
    if (!some.regular() || !all.regular())
        return Error{ErrorKind::BadArgument, "the forms are not independent"};

    UniformForm best;
    Descent start;
    for (const Eigen::VectorXcd& d : startsFor(static_cast<Eigen::Index>(basis.size()), realOnly)) {
        const Descent found = descend(some, d);
        if (best.starts++ == 0 || found.energy < start.energy) start = found;
    }
    const Descent end = descend(all, all.orthonormal(some.coefficients(start.d)));
    best.coefficients = all.coefficients(end.d);
    best.form = combination(basis, best.coefficients);
    best.unevenness = end.energy;
    best.iterations = end.steps;
    return best;
}

} // namespace gimg

#include "gimg/periods.h"

#include "conformal/lattice.h"
#include "conformal/period_norm.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gimg {

std::optional<Error> objectionToPeriods(const Eigen::MatrixXcd& periodMatrix)
{
    const Eigen::Index g = periodMatrix.rows();
    if (g == 0 || g != periodMatrix.cols() || !periodMatrix.allFinite())
        return Error{ErrorKind::BadArgument, "a period matrix is square and finite"};
    if ((periodMatrix - periodMatrix.transpose()).norm() > 1e-6 * periodMatrix.norm())
        return Error{ErrorKind::BadArgument, "a period matrix is symmetric"};
    if (Eigen::LLT<Eigen::MatrixXd>(periodMatrix.imag()).info() != Eigen::Success)
        return Error{ErrorKind::BadArgument, "the imaginary part of a period matrix is positive definite"};
    return std::nullopt;
}

Eigen::MatrixXd periodNorm(const Eigen::MatrixXcd& periodMatrix)
{
    const Eigen::Index g = periodMatrix.rows();
    const Eigen::MatrixXd x = periodMatrix.real(), y = periodMatrix.imag(), inverse = y.inverse();
    Eigen::MatrixXd norm(2 * g, 2 * g);
    norm << y + x * inverse * x, x * inverse, inverse * x, inverse;
    return 0.5 * (norm + norm.transpose());
}

Eigen::MatrixXi periodPairing(Eigen::Index genus)
{
    Eigen::MatrixXi pairing = Eigen::MatrixXi::Zero(2 * genus, 2 * genus);
    pairing.topRightCorner(genus, genus) = -Eigen::MatrixXi::Identity(genus, genus);
    pairing.bottomLeftCorner(genus, genus).setIdentity();
    return pairing;
}

Result<std::complex<double>> reducedModulus(std::complex<double> tau)
{
    constexpr double kLeast = 1e-100, kLargest = 1e100; // squares stay in range
    if (!(std::abs(tau) <= kLargest) || !(tau.imag() >= kLeast))
        return Error{ErrorKind::BadArgument, "the modulus of a torus has a positive imaginary part"};
    constexpr double kOnCircle = 1e-14;
    for (;;) {
        tau -= std::ceil(tau.real() - 0.5); // to (-1/2, 1/2]
        if (std::norm(tau) >= 1 - kOnCircle) break;
        tau = -1.0 / tau; // a larger imaginary part
    }
    if (std::norm(tau) <= 1 + kOnCircle && tau.real() < 0) tau.real(-tau.real());
    return tau;
}

Result<ShapeFactors> shapeFactors(std::complex<double> tau)
{
    const Result<std::complex<double>> reduced = reducedModulus(tau);
    if (!reduced) return reduced.error();
    const double angle = std::atan2(reduced->imag(), std::abs(reduced->real()));
    return ShapeFactors{angle * 180 / std::numbers::pi, std::max(1.0, std::abs(*reduced))};
}

Eigen::MatrixXcd transformedPeriods(const Eigen::MatrixXcd& periodMatrix,
                                    const Eigen::MatrixXi& transformation)
{
    const Eigen::Index g = periodMatrix.rows();
    const Eigen::MatrixXcd n = transformation.cast<std::complex<double>>();
    const Eigen::MatrixXcd overB = n.topLeftCorner(g, g) * periodMatrix + n.topRightCorner(g, g);
    const Eigen::MatrixXcd overA = n.bottomLeftCorner(g, g) * periodMatrix + n.bottomRightCorner(g, g);
    const Eigen::MatrixXcd moved = overA.transpose().partialPivLu().solve(overB.transpose());
    return 0.5 * (moved + moved.transpose());
}

double periodDistance(const Eigen::MatrixXcd& z, const Eigen::MatrixXcd& w)
{
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ratios(periodNorm(z), periodNorm(w),
                                                                           Eigen::EigenvaluesOnly);
    return std::log(std::max(1.0, ratios.eigenvalues().maxCoeff()));
}

namespace {

// Blocks A = U, D = U'^-1: b' = U b.
Eigen::MatrixXi ofImaginaryPart(const Eigen::MatrixXi& u)
{
    const Eigen::Index g = u.rows();
    Eigen::MatrixXi n = Eigen::MatrixXi::Zero(2 * g, 2 * g);
    n.topLeftCorner(g, g) = u;
    const Eigen::MatrixXd inverse = u.cast<double>().inverse().transpose();
    n.bottomRightCorner(g, g) = inverse.array().round().cast<int>();
    return n;
}

Eigen::MatrixXi ofShift(const Eigen::MatrixXi& shift)
{
    const Eigen::Index g = shift.rows();
    Eigen::MatrixXi n = Eigen::MatrixXi::Identity(2 * g, 2 * g);
    n.topRightCorner(g, g) = shift;
    return n;
}

// -1 / Z in the first handle: it exchanges a_1 and b_1.
Eigen::MatrixXi ofExchange(Eigen::Index g)
{
    Eigen::MatrixXi n = Eigen::MatrixXi::Identity(2 * g, 2 * g);
    n(0, 0) = n(g, g) = 0;
    n(0, g) = -1;
    n(g, 0) = 1;
    return n;
}

} // namespace

// Each exchange divides det Im Z by |Z_11|^2 < 1.
Result<ReducedPeriods> siegelReduced(const Eigen::MatrixXcd& periodMatrix)
{
    if (std::optional<Error> objection = objectionToPeriods(periodMatrix)) return *objection;
    constexpr int kMostRounds = 10'000;
    const Eigen::Index g = periodMatrix.rows();
    ReducedPeriods reduced{periodMatrix, Eigen::MatrixXi::Identity(2 * g, 2 * g)};
    Eigen::MatrixXcd& z = reduced.periodMatrix;
    const auto apply = [&](const Eigen::MatrixXi& n) {
        reduced.transformation = (n * reduced.transformation).eval();
        z = transformedPeriods(z, n);
    };
    for (int round = 0; round < kMostRounds; ++round) {
        apply(ofImaginaryPart(reducedLattice(z.imag())));
        apply(ofShift(-z.real().array().round().matrix().cast<int>()));
        if (std::abs(z(0, 0)) >= 1 - 1e-12) break;
        apply(ofExchange(g));
    }
    z = transformedPeriods(periodMatrix, reduced.transformation);
    return reduced;
}

} // namespace gimg

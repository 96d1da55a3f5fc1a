#include "gimg/periods.h"

#include "conformal/lattice.h"
#include "conformal/period_norm.h"

#include <Eigen/Dense>

#include <cmath>
#include <limits>
#include <vector>

namespace gimg {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Looks for integer vectors x_1 .. x_2g that have the inner products and intersection numbers of a short
/// basis y_1 .. y_2g of the target's homology, one after the other.
///
/// If the distance is at most d, norms of corresponding classes differ by factors in [e^-d, e^d]. Say y* is
/// the part of y_i at right angles to y_1 .. y_{i-1}, and c its coefficients: y_i = y* + sum c_j y_j. Then
/// x_i = x* + sum c_j x_j, where x* has at most the squared length e^d |y*|^2 and a part along x_1 .. x_{i-1}
/// no longer than (e^d - 1) e^(d/2) |y*|. That leaves few lattice points, and none of the images is missed.
class IsometrySearch
{
public:
    IsometrySearch(const Eigen::MatrixXcd& first, const Eigen::MatrixXcd& target, double tolerance,
                   long mostNodes)
        : first_(first), target_(target), norm_(periodNorm(first)), pairing_(periodPairing(first.rows())),
          bound_(tolerance), nodesLeft_(mostNodes)
    {
        const Eigen::MatrixXd targetNorm = periodNorm(target);
        basis_ = reducedLattice(targetNorm);
        const Eigen::MatrixXd y = basis_.cast<double>();
        targetProducts_ = y * targetNorm * y.transpose();
        targetPairing_ = basis_ * pairing_ * basis_.transpose();
        images_ = Eigen::MatrixXi::Zero(basis_.rows(), basis_.cols());
    }

    void run() { place(0); }

    double distance() const { return distance_; }
    const Eigen::MatrixXi& transformation() const { return transformation_; }
    long nodesLeft() const { return nodesLeft_; } ///< negative if the search was stopped

private:
    bool isExact() const { return distance_ < 1e-9; }

    // Returns false when the search is over.
    bool place(Eigen::Index i)
    {
        if (i == images_.rows()) return accept();
        Eigen::VectorXd center = Eigen::VectorXd::Zero(images_.cols());
        double rest = targetProducts_(i, i); // |y*|^2
        Eigen::MatrixXd form = norm_;
        const double stretch = std::exp(bound_), along = std::max(1e-6, (stretch - 1) * std::sqrt(stretch));
        if (i > 0) {
            const Eigen::MatrixXd placed = images_.topRows(i).cast<double>();
            const Eigen::VectorXd products = targetProducts_.col(i).head(i);
            const Eigen::VectorXd coefficients = targetProducts_.topLeftCorner(i, i).ldlt().solve(products);
            rest -= products.dot(coefficients);
            center = placed.transpose() * coefficients;
            const Eigen::MatrixXd dual = placed * norm_;
            form +=
                (1 / (along * along) - 1) * dual.transpose() * (dual * placed.transpose()).ldlt().solve(dual);
        }
        const Eigen::MatrixXi units = reducedLattice(form);
        const Eigen::MatrixXd u = units.cast<double>();
        const Eigen::VectorXd there = u.transpose().partialPivLu().solve(center);
        bool goesOn = true;
        forEachLatticePoint(u * form * u.transpose(), there, (stretch + (i > 0 ? 1 : 0)) * rest, nodesLeft_,
                            [&](const Eigen::VectorXi& v) {
                                images_.row(i) = v.transpose() * units;
                                if (isFit(i)) goesOn = place(i + 1);
                                return goesOn;
                            });
        return goesOn && nodesLeft_ >= 0;
    }

    // The first image may be taken up to its sign: the other sign only turns all of them around.
    bool isFit(Eigen::Index i) const
    {
        const Eigen::VectorXi x = images_.row(i).transpose();
        const Eigen::VectorXi pairings = images_.topRows(i) * (pairing_ * x);
        if (pairings != targetPairing_.col(i).head(i)) return false;
        const Eigen::VectorXd products = images_.topRows(i + 1).cast<double>() * (norm_ * x.cast<double>());
        const double loosest = std::expm1(bound_) + 1e-9;
        for (Eigen::Index j = 0; j <= i; ++j) {
            const double scale = std::sqrt(targetProducts_(i, i) * targetProducts_(j, j));
            if (std::abs(products[j] - targetProducts_(j, i)) > loosest * scale) return false;
        }
        if (i > 0) return areWithinBound(i + 1);
        for (Eigen::Index k = 0; k < x.size(); ++k)
            if (x[k] != 0) return x[k] > 0;
        return false;
    }

    // Of the classes that the first `count` span.
    bool areWithinBound(Eigen::Index count) const
    {
        const Eigen::MatrixXd placed = images_.topRows(count).cast<double>();
        const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ratios(
            placed * norm_ * placed.transpose(), targetProducts_.topLeftCorner(count, count),
            Eigen::EigenvaluesOnly);
        const double loosest = std::exp(bound_) * (1 + 1e-9);
        return ratios.eigenvalues().maxCoeff() <= loosest && ratios.eigenvalues().minCoeff() >= 1 / loosest;
    }

    bool accept()
    {
        const Eigen::MatrixXd n = basis_.cast<double>().partialPivLu().solve(images_.cast<double>());
        const Eigen::MatrixXi transformation = n.array().round().matrix().cast<int>();
        const double distance = periodDistance(transformedPeriods(first_, transformation), target_);
        if (distance > bound_ || distance >= distance_) return true;
        distance_ = distance;
        transformation_ = transformation;
        bound_ = distance; // only what is nearer matters from now on
        return !isExact();
    }

    const Eigen::MatrixXcd &first_, &target_;
    Eigen::MatrixXd norm_;
    Eigen::MatrixXi pairing_;
    Eigen::MatrixXi basis_; // y, one a row
    Eigen::MatrixXd targetProducts_;
    Eigen::MatrixXi targetPairing_;
    Eigen::MatrixXi images_; // x, one a row
    double bound_, distance_ = kInfinity;
    Eigen::MatrixXi transformation_;
    long nodesLeft_;
};

// With small tolerances first, which leave little to look at: what they find is the nearest.
void search(const Eigen::MatrixXcd& first, const Eigen::MatrixXcd& target, bool reflected,
            const EquivalenceOptions& options, Equivalence& best)
{
    long nodesLeft = options.mostNodes;
    for (const double part : {1.0 / 64, 1.0 / 16, 1.0 / 4, 1.0}) {
        IsometrySearch isometries(first, target, part * options.tolerance, nodesLeft);
        isometries.run();
        nodesLeft = isometries.nodesLeft();
        if (nodesLeft < 0) best.exhaustive = false;
        if (isometries.distance() < best.distance) {
            best.equivalent = true;
            best.distance = isometries.distance();
            best.transformation = isometries.transformation();
            best.reflected = reflected;
        }
        if (nodesLeft < 0 || isometries.distance() < kInfinity) return;
    }
}

} // namespace

Result<Equivalence> conformallyEquivalent(const Eigen::MatrixXcd& first, const Eigen::MatrixXcd& second,
                                          const EquivalenceOptions& options)
{
    for (const Eigen::MatrixXcd* periods : {&first, &second})
        if (std::optional<Error> objection = objectionToPeriods(*periods)) return *objection;
    if (first.rows() != second.rows())
        return Error{ErrorKind::BadArgument, "period matrices of different genus cannot be compared"};
    if (!(options.tolerance > 0) || !(options.tolerance <= 1))
        return Error{ErrorKind::BadArgument, "the tolerance of an equivalence is in (0, 1]"};
    Equivalence best;
    best.distance = kInfinity;
    search(first, second, false, options, best);
    if (options.allowReflection) search(first, -second.conjugate(), true, options, best);
    return best;
}

} // namespace gimg

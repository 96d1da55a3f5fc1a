#include "gimg/periods.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace gimg {
namespace {

using Complex = std::complex<double>;

double unit(std::mt19937& random) { return 2.0 * static_cast<double>(random()) / std::mt19937::max() - 1; }

Eigen::MatrixXcd randomPeriods(int g, std::mt19937& random)
{
    Eigen::MatrixXd m(g, g), x(g, g);
    for (double& entry : m.reshaped()) entry = unit(random);
    for (double& entry : x.reshaped()) entry = unit(random);
    Eigen::MatrixXcd periods(g, g);
    periods.real() = 0.5 * (x + x.transpose());
    periods.imag() = m * m.transpose() + 0.4 * Eigen::MatrixXd::Identity(g, g);
    return periods;
}

Eigen::MatrixXi pairing(int g)
{
    Eigen::MatrixXi j = Eigen::MatrixXi::Zero(2 * g, 2 * g);
    j.topRightCorner(g, g) = -Eigen::MatrixXi::Identity(g, g);
    j.bottomLeftCorner(g, g).setIdentity();
    return j;
}

// A product of shifts Z + e_ij + e_ji, exchanges -1 / Z of one handle, and b_i += b_j.
Eigen::MatrixXi randomSymplectic(int g, std::mt19937& random, int factors)
{
    Eigen::MatrixXi product = Eigen::MatrixXi::Identity(2 * g, 2 * g);
    for (int k = 0; k < factors; ++k) {
        const int i = static_cast<int>(random() % g), j = static_cast<int>(random() % g);
        Eigen::MatrixXi factor = Eigen::MatrixXi::Identity(2 * g, 2 * g);
        switch (random() % 3) {
        case 0:
            factor(i, g + j) = factor(j, g + i) = random() % 2 == 0 ? 1 : -1;
            break;
        case 1:
            factor(i, i) = factor(g + i, g + i) = 0;
            factor(i, g + i) = -1;
            factor(g + i, i) = 1;
            break;
        default:
            if (i == j) break;
            factor(i, j) = 1;
            factor(g + j, g + i) = -1;
        }
        product = (factor * product).eval();
    }
    return product;
}

TEST(ReducedModulus, IsTheSameForAllBases)
{
    std::mt19937 random(1);
    for (int i = 0; i < 200; ++i) {
        const Eigen::MatrixXcd tau = randomPeriods(1, random);
        const Complex reduced = *reducedModulus(tau(0, 0));
        EXPECT_GE(std::abs(reduced), 1 - 1e-12);
        EXPECT_LE(std::abs(reduced.real()), 0.5 + 1e-12);
        const Complex other = *reducedModulus(transformedPeriods(tau, randomSymplectic(1, random, 8))(0, 0));
        EXPECT_LT(std::abs(other - reduced), 1e-9);
    }
}

TEST(ReducedModulus, OnTheBorderOneOfTheTwoIsTaken)
{
    EXPECT_LT(std::abs(*reducedModulus({-0.5, 2}) - Complex(0.5, 2)), 1e-15);
    EXPECT_LT(std::abs(*reducedModulus({-0.6, 0.8}) - Complex(0.6 - 0.2, 0.8) / std::abs(Complex(0.4, 0.8))),
              0.5);
    EXPECT_LT(std::abs(*reducedModulus({-0.28, 0.96}) - Complex(0.28, 0.96)), 1e-12);
    EXPECT_LT(std::abs(*reducedModulus({0, 0.25}) - Complex(0, 4)), 1e-15);
    EXPECT_EQ(reducedModulus({0.3, 0}).error().kind, ErrorKind::BadArgument);
    EXPECT_EQ(reducedModulus({0.3, -1}).error().kind, ErrorKind::BadArgument);
    EXPECT_EQ(reducedModulus({NAN, 1}).error().kind, ErrorKind::BadArgument);
}

TEST(ShapeFactors, OfTheSquareAndTheHexagonalTorus)
{
    const ShapeFactors square = *shapeFactors({3, 1});
    EXPECT_NEAR(square.angleDegrees, 90, 1e-12);
    EXPECT_NEAR(square.lengthRatio, 1, 1e-12);
    const ShapeFactors hexagonal = *shapeFactors({-0.5, std::sqrt(0.75)});
    EXPECT_NEAR(hexagonal.angleDegrees, 60, 1e-12);
    EXPECT_NEAR(hexagonal.lengthRatio, 1, 1e-12);
    const ShapeFactors longer = *shapeFactors({1.3, 2}); // sides 1 and 0.3 + 2i
    EXPECT_NEAR(longer.angleDegrees, std::atan2(2, 0.3) * 180 / M_PI, 1e-12);
    EXPECT_NEAR(longer.lengthRatio, std::hypot(0.3, 2), 1e-12);
    EXPECT_EQ(shapeFactors({1, 0}).error().kind, ErrorKind::BadArgument);
}

TEST(TransformedPeriods, AreAnActionOfSymplecticMatrices)
{
    std::mt19937 random(2);
    for (int g = 1; g <= 4; ++g) {
        const Eigen::MatrixXcd z = randomPeriods(g, random);
        const Eigen::MatrixXi m = randomSymplectic(g, random, 6), n = randomSymplectic(g, random, 6);
        EXPECT_EQ(m * pairing(g) * m.transpose(), pairing(g));
        EXPECT_LT((transformedPeriods(transformedPeriods(z, m), n) - transformedPeriods(z, n * m)).norm(),
                  1e-9);
    }
}

TEST(SiegelReduced, IsTheSameSurfaceNearTheFundamentalDomain)
{
    std::mt19937 random(3);
    for (int g = 1; g <= 5; ++g)
        for (int i = 0; i < 10; ++i) {
            const Eigen::MatrixXcd z =
                transformedPeriods(randomPeriods(g, random), randomSymplectic(g, random, 12));
            const Result<ReducedPeriods> reduced = siegelReduced(z);
            ASSERT_TRUE(reduced.ok());
            const Eigen::MatrixXi& n = reduced->transformation;
            EXPECT_EQ(n * pairing(g) * n.transpose(), pairing(g));
            EXPECT_LT((transformedPeriods(z, n) - reduced->periodMatrix).norm(), 1e-9);
            EXPECT_LE(reduced->periodMatrix.real().cwiseAbs().maxCoeff(), 0.5 + 1e-9);
            EXPECT_GE(std::abs(reduced->periodMatrix(0, 0)), 1 - 1e-9);
            if (g == 1) {
                EXPECT_LT(std::abs(*reducedModulus(z(0, 0)) - reduced->periodMatrix(0, 0)), 1e-8);
            }
        }
    EXPECT_EQ(siegelReduced(-randomPeriods(2, random)).error().kind, ErrorKind::BadArgument);
}

TEST(PeriodDistance, IsHyperbolicForGenusOne)
{
    const auto distance = [](Complex s, Complex t) {
        return periodDistance(Eigen::MatrixXcd::Constant(1, 1, s), Eigen::MatrixXcd::Constant(1, 1, t));
    };
    EXPECT_NEAR(distance({0, 1}, {0, 2}), std::log(2.0), 1e-12);
    EXPECT_NEAR(distance({0, 1}, {1, 1}), std::acosh(1.5), 1e-12);
    std::mt19937 random(4);
    for (int g = 1; g <= 4; ++g) { // the same in every basis
        const Eigen::MatrixXcd z = randomPeriods(g, random), w = randomPeriods(g, random);
        const Eigen::MatrixXi n = randomSymplectic(g, random, 5);
        EXPECT_NEAR(periodDistance(transformedPeriods(z, n), transformedPeriods(w, n)), periodDistance(z, w),
                    1e-7);
        EXPECT_NEAR(periodDistance(z, w), periodDistance(w, z), 1e-9);
    }
}

TEST(ConformallyEquivalent, FindsTheChangeOfBasis)
{
    std::mt19937 random(6);
    for (int g = 1; g <= 5; ++g)
        for (int i = 0; i < 6; ++i) {
            const Eigen::MatrixXcd z = randomPeriods(g, random);
            const Eigen::MatrixXcd w = transformedPeriods(z, randomSymplectic(g, random, 10));
            const Result<Equivalence> found = conformallyEquivalent(z, w);
            ASSERT_TRUE(found.ok());
            ASSERT_TRUE(found->equivalent) << g;
            EXPECT_LT(found->distance, 1e-6);
            const Eigen::MatrixXi& n = found->transformation;
            EXPECT_EQ(n * pairing(g) * n.transpose(), pairing(g));
            EXPECT_LT(periodDistance(transformedPeriods(z, n), w), 1e-6);
        }
}

TEST(ConformallyEquivalent, AllowsForTheToleranceAndNoMore)
{
    std::mt19937 random(7);
    for (int g = 1; g <= 4; ++g) {
        const Eigen::MatrixXcd z = randomPeriods(g, random);
        const Eigen::MatrixXcd w = z + 0.002 * randomPeriods(g, random);
        const double distance = periodDistance(z, w);
        const Eigen::MatrixXcd other = transformedPeriods(w, randomSymplectic(g, random, 10));
        EquivalenceOptions options;
        options.tolerance = 1.01 * distance;
        const Result<Equivalence> found = conformallyEquivalent(z, other, options);
        ASSERT_TRUE(found->equivalent);
        EXPECT_NEAR(found->distance, distance, 1e-6);
        options.tolerance = 0.9 * distance;
        EXPECT_FALSE(conformallyEquivalent(z, other, options)->equivalent);
    }
}

TEST(ConformallyEquivalent, TellsMirrorImagesApart)
{
    const Eigen::MatrixXcd z = Eigen::MatrixXcd::Constant(1, 1, Complex(0.3, 1.2));
    const Eigen::MatrixXcd mirrored = -z.conjugate();
    EXPECT_FALSE(conformallyEquivalent(z, mirrored)->equivalent);
    EquivalenceOptions options;
    options.allowReflection = true;
    const Result<Equivalence> found = conformallyEquivalent(z, mirrored, options);
    EXPECT_TRUE(found->equivalent);
    EXPECT_TRUE(found->reflected);
    EXPECT_LT(periodDistance(transformedPeriods(z, found->transformation), -mirrored.conjugate()), 1e-9);
}

TEST(ConformallyEquivalent, SaysWhereItStopped)
{
    std::mt19937 random(8);
    EquivalenceOptions options;
    options.mostNodes = 1;
    const Result<Equivalence> found =
        conformallyEquivalent(randomPeriods(3, random), randomPeriods(3, random), options);
    EXPECT_FALSE(found->exhaustive);
    EXPECT_FALSE(found->equivalent);
    EXPECT_EQ(conformallyEquivalent(randomPeriods(2, random), randomPeriods(3, random)).error().kind,
              ErrorKind::BadArgument);
}

} // namespace
} // namespace gimg

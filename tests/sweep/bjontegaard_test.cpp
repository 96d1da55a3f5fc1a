// Bjontegaard deltas: exact cases, and numbers of an independent implementation.
#include "gimrd/bjontegaard.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace gimg::gimrd;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Curve = std::vector<RatePoint>;

// Simplify and Draco on the bunny, and the same with another simplifier.
const Curve kStrong = {{1536, 59.4}, {3072, 65.2}, {6144, 70.4}, {12288, 75.1}, {24576, 79.6}, {49152, 86.0}};
const Curve kWeak = {{1536, 54.0}, {3072, 59.1}, {6144, 64.6}, {12288, 70.1}, {24576, 75.6}, {49152, 83.2}};

Curve changed(Curve curve, double rateFactor, double dB)
{
    for (RatePoint& p : curve) p.bytes *= rateFactor, p.psnr += dB;
    return curve;
}

// The expected values come from SciPy 1.10:
//   from numpy import log10; from scipy.interpolate import PchipInterpolator as P
//   def mean(x1, y1, x2, y2):
//       a, b = max(x1[0], x2[0]), min(x1[-1], x2[-1])
//       return (P(x2, y2).integrate(a, b) - P(x1, y1).integrate(a, b)) / (b - a)
//   rate = 100 * (10 ** mean(psnr1, log10(bytes1), psnr2, log10(bytes2)) - 1)
//   dB = mean(log10(bytes1), psnr1, log10(bytes2), psnr2)
void expectDeltas(const Curve& reference, const Curve& test, double ratePercent, double dB)
{
    const Bjontegaard d = bjontegaard(reference, test);
    ASSERT_TRUE(d.ratePercent && d.psnr);
    EXPECT_NEAR(*d.ratePercent, ratePercent, 1e-9);
    EXPECT_NEAR(*d.psnr, dB, 1e-9);
}

} // namespace

TEST(Bjontegaard, AgreesWithScipysPchip)
{
    expectDeltas(kStrong, kWeak, 88.733552423134, -5.041666666667);
    // Four points each, the ranges differ at both ends.
    expectDeltas({{85.95, 31.42}, {157.11, 34.24}, {309.58, 37.18}, {686.76, 40.28}},
                 {{112.75, 31.24}, {204.93, 34.17}, {407.8, 37.21}, {893.34, 40.39}}, 31.379878202398,
                 -1.183472404622);
    // Plateaus, where the slopes are clamped; partial overlap.
    expectDeltas({{1000, 50}, {2000, 50.5}, {3000, 60}, {9000, 61}, {40000, 75}},
                 {{1500, 51}, {2500, 58}, {5000, 59}, {20000, 70}}, -18.048791311849, 1.116419991116);
}

TEST(Bjontegaard, EqualPsnrAtFourFifthsOfTheBytesIsMinusTwentyPercent)
{
    EXPECT_NEAR(*bjontegaard(kStrong, changed(kStrong, 0.8, 0)).ratePercent, -20, 1e-10);
}

TEST(Bjontegaard, OneDecibelMoreIsOne)
{
    EXPECT_NEAR(*bjontegaard(kStrong, changed(kStrong, 1, 1)).psnr, 1, 1e-12);
}

TEST(Bjontegaard, ExchangingTheCurvesInvertsTheDeltas)
{
    const Bjontegaard one = bjontegaard(kStrong, kWeak), other = bjontegaard(kWeak, kStrong);
    EXPECT_DOUBLE_EQ(*one.psnr, -*other.psnr);
    EXPECT_NEAR((1 + *one.ratePercent / 100) * (1 + *other.ratePercent / 100), 1, 1e-14);
}

TEST(Bjontegaard, IsZeroAgainstItself)
{
    const Bjontegaard same = bjontegaard(kWeak, kWeak);
    EXPECT_EQ(*same.ratePercent, 0);
    EXPECT_EQ(*same.psnr, 0);
}

TEST(Bjontegaard, NeedsFourPointsAndACommonRange)
{
    EXPECT_FALSE(bjontegaard(kStrong, {{1000, 50}, {2000, 60}, {4000, 70}}).psnr);
    const Bjontegaard above = bjontegaard(kStrong, changed(kStrong, 1, 100));
    EXPECT_FALSE(above.ratePercent);
    EXPECT_NEAR(*above.psnr, 100, 1e-10);
    const Bjontegaard larger = bjontegaard(kStrong, changed(kStrong, 1000, 0));
    EXPECT_FALSE(larger.psnr);
    EXPECT_NEAR(*larger.ratePercent, 99900, 1e-6);
}

// Whole meshes agree without error, and a coder may spend bytes in vain: neither bends the curve.
TEST(Bjontegaard, PointsThatMakeNoCurveTakeNoPart)
{
    Curve more = kStrong;
    more.push_back({100000, kInfinity});
    more.push_back({4000, 60}); // worse than the 3,072 bytes
    more.push_back({3072, 61}); // as large, worse
    more.push_back({0, 99});
    const Curve curve = rateCurve(more);
    ASSERT_EQ(curve.size(), kStrong.size());
    for (size_t i = 0; i < curve.size(); ++i) EXPECT_EQ(curve[i].psnr, kStrong[i].psnr);
    EXPECT_EQ(*bjontegaard(kWeak, more).psnr, *bjontegaard(kWeak, kStrong).psnr);
}

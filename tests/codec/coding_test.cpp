#include "codec/exp_golomb.h"
#include "codec/forward.h"
#include "codec/mixer.h"
#include "codec/range_decoder.h"
#include "codec/range_encoder.h"
#include "codec/wavelet.h"
#include "sample_images.h"

#include <cmath>
#include <gtest/gtest.h>

namespace gimg::codec {
namespace {

using samples::Dice;

TEST(RangeCoder, RoundTripOfBitsNumbersAndCarries)
{
    // Bits that are nearly always 1 push the low end up, which makes carries run far.
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        Dice dice(seed);
        const std::uint32_t bias = seed % 3 == 0 ? 1 : seed % 3 == 1 ? 500 : 999, count = dice.below(3000);
        std::vector<bool> bits;
        std::vector<std::uint32_t> numbers;
        RangeEncoder encoder;
        BitModel model;
        ExpGolombModels<32> models;
        for (std::uint32_t k = 0; k < count; ++k) {
            bits.push_back(dice.below(1000) < bias);
            numbers.push_back(dice.next() >> dice.below(31));
            encoder.bit(model, bits.back());
            if (k % 7 == 0) codeExpGolomb(encoder, models, numbers.back());
            if (k % 11 == 0) encoder.raw(9, numbers.back() & 511u);
        }
        const std::vector<std::uint8_t> bytes = encoder.finish();
        RangeDecoder decoder({bytes.data(), bytes.size()});
        BitModel again;
        ExpGolombModels<32> modelsAgain;
        for (std::uint32_t k = 0; k < count; ++k) {
            ASSERT_EQ(decoder.bit(again), bits[k]) << "seed " << seed << " bit " << k;
            if (k % 7 == 0) {
                ASSERT_EQ(codeExpGolomb(decoder, modelsAgain, 0), numbers[k]);
            }
            if (k % 11 == 0) {
                ASSERT_EQ(decoder.raw(9), numbers[k] & 511u);
            }
        }
        EXPECT_TRUE(decoder.finished()) << "seed " << seed;
    }
}

TEST(RangeCoder, CostsWhatTheProbabilitiesSay)
{
    // 20,000 bits, 5 % ones: 0.2864 bits each, 716 bytes; following the last few bits costs up to a tenth
    // more.
    Dice dice(1);
    RangeEncoder encoder;
    BitModel model;
    for (int k = 0; k < 20000; ++k) encoder.bit(model, dice.below(20) == 0);
    const std::size_t size = encoder.finish().size();
    EXPECT_GT(size, 690u);
    EXPECT_LT(size, 790u);
    // A constant stream costs next to nothing: 1.5 thousandths of a bit each.
    RangeEncoder constant;
    BitModel fresh;
    for (int k = 0; k < 20000; ++k) constant.bit(fresh, false);
    EXPECT_LT(constant.finish().size(), 10u);
}

TEST(RangeCoder, NothingTakesNoBytesAndExcessBytesAreRefused)
{
    EXPECT_EQ(RangeEncoder().finish().size(), 0u);
    const std::uint8_t bytes[6] = {};
    EXPECT_FALSE(RangeDecoder({bytes, 6}).finished());
    EXPECT_TRUE(RangeDecoder({bytes, 4}).finished());
}

TEST(BitModel, StaysInsideItsBounds)
{
    BitModel zeros, ones;
    for (int k = 0; k < 10000; ++k) zeros.update(false), ones.update(true);
    EXPECT_EQ(zeros.zero(), 32704u);
    EXPECT_EQ(ones.zero(), 32u);
}

TEST(Mixer, SquashIsTheLogisticFunctionAndStretchItsInverse)
{
    for (int x = -2040; x <= 2040; x += 17)
        EXPECT_NEAR(squash(x), 32768 / (1 + std::exp(-x / 256.0)), 110) << x;
    for (std::uint32_t k = 0; k < 4096; ++k) {
        const double p = (8 * k + 4) / 32768.0;
        if (p > 0.001 && p < 0.999) {
            EXPECT_NEAR(kStretch.value[k], 256 * std::log(p / (1 - p)), 24) << k;
        }
        if (k > 0) {
            EXPECT_GE(kStretch.value[k], kStretch.value[k - 1]);
        }
    }
}

TEST(Lifting, InverseUndoesForward)
{
    for (const std::uint32_t size : {5u, 9u, 33u, 129u}) {
        Dice dice(size);
        std::vector<double> image(std::size_t{size} * size);
        for (double& value : image) value = dice.unit();
        std::vector<double> copy = image;
        forwardLifting(copy.data(), size);
        inverseLifting(copy.data(), size);
        double worst = 0;
        for (std::size_t k = 0; k < image.size(); ++k) worst = std::max(worst, std::abs(copy[k] - image[k]));
        EXPECT_LT(worst, 1e-14) << size;
    }
}

// The 9/7 analysis high band has four vanishing moments, so cubics leave no details inside. At the
// border, where a line is mirrored, only what is even about the end stays polynomial: constants do.
TEST(Lifting, PolynomialsLeaveNoDetails)
{
    constexpr std::uint32_t size = 33;
    const auto details = [&](auto&& f, std::uint32_t margin) {
        std::vector<double> image(size * size);
        for (std::uint32_t j = 0; j < size; ++j)
            for (std::uint32_t i = 0; i < size; ++i) image[j * size + i] = f(i / 32.0, j / 32.0);
        forwardLifting(image.data(), size);
        double worst = 0;
        for (std::uint32_t j = margin; j < size - margin; ++j)
            for (std::uint32_t i = margin; i < size - margin; ++i)
                if (i % 2 == 1 || j % 2 == 1) worst = std::max(worst, std::abs(image[j * size + i]));
        return worst;
    };
    EXPECT_LT(details([](double, double) { return 1.0; }, 0), 1e-10);
    EXPECT_LT(details([](double s, double t) { return s * s * s - 2 * s * t + t * t; }, 5), 1e-10);
    EXPECT_GT(details([](double s, double) { return s * s * s * s; }, 5),
              1e-7);                                                 // the fifth moment does not vanish
    EXPECT_GT(details([](double s, double) { return s; }, 0), 1e-3); // mirrored, a slope has a kink
}

TEST(Transform, BandsAreNearlyOrthonormal)
{
    // The energy of noise is kept to a few percent.
    constexpr std::uint32_t grid = 129;
    Dice dice(3);
    std::vector<float> xyz(3 * grid * grid);
    for (float& value : xyz) value = static_cast<float>(dice.unit() - 0.5);
    const TransformedImage image = transform(xyz, grid);
    double before = 0, after = 0;
    for (const float value : xyz) before += double{value} * value;
    for (unsigned c = 0; c < kComponents; ++c) {
        for (const double value : image.detail[c]) after += value * value;
        for (const double value : image.coarse[c]) after += value * value;
    }
    EXPECT_NEAR(after / before, 1.0, 0.06);
}

TEST(Transform, ConstantsComeOutScaledByTwoALevel)
{
    constexpr std::uint32_t grid = 65; // five levels
    const std::vector<float> xyz(3 * grid * grid, 1.5f);
    const TransformedImage image = transform(xyz, grid);
    for (const double value : image.coarse[1]) EXPECT_NEAR(value, 1.5 * 32, 1e-9);
}

} // namespace
} // namespace gimg::codec

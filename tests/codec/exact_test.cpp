#include "codec/exact_decoder.h"
#include "codec/exact_encoder.h"
#include "sample_images.h"

#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>

namespace gimg::codec {
namespace {

using format::ReadStatus;
using samples::Dice;
using Bytes = std::vector<std::uint8_t>;

struct Decoded
{
    ReadStatus status;
    std::vector<float> samples;
};

/// Decodes in exactly the memory that is asked for.
Decoded decode(const Bytes& bytes, const ExactFormat& format, const std::vector<std::uint32_t>& classes)
{
    Decoded out;
    out.samples.resize(std::size_t{format.grid} * format.grid * format.channels);
    std::vector<unsigned char> memory(exactWorkspace(format) + Arena::kAlignment);
    Arena arena(memory.data(), memory.size());
    out.status = decodeExact({bytes.data(), bytes.size()}, format, classes.empty() ? nullptr : classes.data(),
                             arena, out.samples.data());
    return out;
}

bool sameBits(const std::vector<float>& a, const std::vector<float>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

/// What an encoder makes of samples that do not agree: those at the smallest position of each class.
std::vector<float> closed(std::vector<float> image, const ExactFormat& format,
                          const std::vector<std::uint32_t>& classes)
{
    for (std::uint32_t k = 0; k < classes.size(); ++k)
        for (unsigned c = 0; c < format.channels; ++c)
            image[borderSample(format.grid, k) * std::size_t{format.channels} + c] =
                image[borderSample(format.grid, classes[k]) * std::size_t{format.channels} + c];
    return image;
}

std::vector<float> noise(const ExactFormat& format, std::uint64_t seed)
{
    std::vector<float> out(std::size_t{format.grid} * format.grid * format.channels);
    if (format.bits == 0) {
        out = samples::wildImage(format.grid * (format.channels / 3 + 1), seed);
        out.resize(std::size_t{format.grid} * format.grid * format.channels);
        return out;
    }
    Dice dice(seed);
    for (float& value : out) value = static_cast<float>(dice.below(1u << format.bits));
    return out;
}

/// A bowl in each channel, over the whole range of integers.
std::vector<float> smooth(const ExactFormat& format)
{
    const double most = format.bits == 0 ? 1 : (1u << format.bits) - 1, last = format.grid - 1;
    std::vector<float> out;
    for (std::uint32_t j = 0; j < format.grid; ++j)
        for (std::uint32_t i = 0; i < format.grid; ++i)
            for (unsigned c = 0; c < format.channels; ++c) {
                const double s = i / last - 0.1 * c, t = j / last - 0.5;
                const double value = most * std::clamp(0.1 + s * s / 2 + t * t, 0.0, 1.0);
                out.push_back(static_cast<float>(format.bits == 0 ? value : std::floor(value)));
            }
    return out;
}

std::vector<std::vector<std::uint32_t>> gluings(std::uint32_t grid)
{
    const Seam boundary{17, 5, {{0, 12, 1}, {1, 10, 0}, {2, 8, 1}, {0, 12, 2}, {2, 8, 2}, {3, 14, 0}}};
    std::vector<std::vector<std::uint32_t>> out{{}, borderClasses(samples::torusSeam(3), grid)};
    if (grid >= 17) {
        out.push_back(borderClasses(boundary, grid));
        out.push_back(borderClasses(samples::closedSeam(3, 17, 9), grid));
    }
    return out;
}

TEST(Exact, RoundTripOfAllBitsChannelsGridsAndSeams)
{
    std::uint64_t seed = 0;
    for (const unsigned bits : {0u, 1u, 2u, 3u, 5u, 8u, 11u, 12u, 13u, 16u})
        for (const unsigned channels : {1u, 2u, 3u, 7u, 16u})
            for (const std::uint32_t grid : {3u, 5u, 9u, 17u, 33u})
                for (const auto& classes : gluings(grid)) {
                    const ExactFormat format{grid, channels, bits};
                    for (const auto& image : {noise(format, ++seed), smooth(format)}) {
                        const Bytes bytes = encodeExact(image, format, classes);
                        const Decoded out = decode(bytes, format, classes);
                        ASSERT_EQ(out.status, ReadStatus::Ok) << bits << ' ' << channels << ' ' << grid;
                        ASSERT_TRUE(sameBits(out.samples, closed(image, format, classes)))
                            << bits << ' ' << channels << ' ' << grid;
                    }
                }
}

TEST(Exact, SmoothImagesTakeFewBits)
{
    const auto bitsASample = [](const ExactFormat& format, const std::vector<float>& image) {
        return 8.0 * static_cast<double>(encodeExact(image, format, {}).size()) /
               static_cast<double>(image.size());
    };
    for (const unsigned bits : {8u, 12u, 16u}) {
        const ExactFormat format{129, 3, bits};
        EXPECT_LT(bitsASample(format, smooth(format)), 1.0) << bits; // what rounding adds
    }
    const ExactFormat floats{129, 3, 0};
    EXPECT_LT(bitsASample(floats, smooth(floats)), 5);
    const ExactFormat torus{129, 3, 0};
    EXPECT_LT(bitsASample(torus, samples::torusImage(129)), 12); // deflated differences took 20
    EXPECT_LT(bitsASample(torus, std::vector<float>(3 * 129 * 129, 0.7f)), 0.05);
}

TEST(Exact, NoiseCostsLittleMoreThanItsBits)
{
    for (const unsigned bits : {1u, 4u, 12u, 16u}) {
        const ExactFormat format{129, 1, bits};
        const std::vector<float> image = noise(format, bits);
        const double cost = 8.0 * static_cast<double>(encodeExact(image, format, {}).size()) /
                            static_cast<double>(image.size());
        EXPECT_GT(cost, bits * 0.999);
        EXPECT_LT(cost, bits + 0.75) << bits;
    }
}

TEST(Exact, GluedSamplesAreCodedOnce)
{
    const ExactFormat format{65, 3, 12};
    const std::vector<float> image = noise(format, 5);
    const auto classes = borderClasses(samples::torusSeam(3), 65);
    const double all = static_cast<double>(encodeExact(image, format, {}).size());
    const double once = static_cast<double>(encodeExact(image, format, classes).size());
    EXPECT_NEAR(once / all, 64.0 * 64 / (65 * 65), 0.003);
}

TEST(Exact, EveryCutAndEveryByteTooManyIsRefused)
{
    const ExactFormat format{17, 3, 12};
    const auto classes = borderClasses(samples::torusSeam(3), 17);
    Bytes bytes = encodeExact(noise(format, 3), format, classes);
    for (std::size_t size = 0; size + 8 < bytes.size(); ++size)
        ASSERT_EQ(
            decode(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)), format, classes)
                .status,
            ReadStatus::Corrupt)
            << size;
    bytes.resize(bytes.size() + 5, 0x55);
    EXPECT_EQ(decode(bytes, format, classes).status, ReadStatus::Corrupt);
}

TEST(Exact, ForgedBytesGiveSamplesInRangeOrAreRefused)
{
    int decodedWhole = 0, refused = 0;
    for (std::uint64_t seed = 0; seed < 600; ++seed) {
        Dice dice(seed);
        const ExactFormat format{1u + (4u << dice.below(4)), 1 + dice.below(4), dice.below(3) * 6};
        const auto classes = gluings(format.grid)[dice.below(2)];
        Bytes bytes = encodeExact(smooth(format), format, classes);
        if (dice.below(4) == 0) bytes = encodeExact(noise(format, seed), format, classes);
        for (std::uint32_t changes = 1 + dice.below(3); changes > 0; --changes)
            bytes[dice.below(static_cast<std::uint32_t>(bytes.size()))] =
                static_cast<std::uint8_t>(dice.next());
        const Decoded out = decode(bytes, format, classes);
        if (out.status != ReadStatus::Ok) {
            ++refused;
            continue;
        }
        ++decodedWhole;
        for (const float value : out.samples) {
            ASSERT_TRUE(std::isfinite(value));
            if (format.bits != 0) {
                ASSERT_GE(value, 0);
                ASSERT_LT(value, static_cast<float>(1u << format.bits));
                ASSERT_EQ(value, std::floor(value));
            }
        }
    }
    EXPECT_GT(decodedWhole, 20);
    EXPECT_GT(refused, 100);
}

TEST(Exact, TooLittleMemoryIsToldAndNotExceeded)
{
    const ExactFormat format{17, 2, 8};
    const Bytes bytes = encodeExact(smooth(format), format, {});
    std::vector<unsigned char> memory(exactWorkspace(format) - 1);
    Arena arena(memory.data(), memory.size());
    std::vector<float> out(2 * 17 * 17);
    EXPECT_EQ(decodeExact({bytes.data(), bytes.size()}, format, nullptr, arena, out.data()),
              ReadStatus::Misuse);
}

TEST(Exact, EncodingIsRepeatable)
{
    const ExactFormat format{65, 3, 0};
    const std::vector<float> image = samples::torusImage(65);
    EXPECT_EQ(encodeExact(image, format, {}), encodeExact(image, format, {}));
}

// y = 2 a - b + noise: the weights are found, and the start is kept where nothing speaks against it.
TEST(LinearFit, FindsWeightsAndKeepsTheStartOtherwise)
{
    Dice dice(2);
    LinearFit fit;
    const double start[3] = {0.5, 0, 0.25};
    fit.begin(start, 3);
    fit.solve(); // of nothing
    const double unit[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    EXPECT_EQ(fit.estimate(unit[0]), 0.5);
    for (int k = 0; k < 2000; ++k) {
        const double x[3] = {dice.unit() - 0.5, dice.unit() - 0.5, 0};
        const double y = 2 * x[0] - x[1] + 0.01 * (dice.unit() - 0.5);
        fit.learn(x, y, y - fit.estimate(x), 1);
        if (k % 50 == 0) fit.fade(0.95), fit.solve();
    }
    EXPECT_NEAR(fit.estimate(unit[0]), 2, 0.03); // still drawn to the start a little
    EXPECT_NEAR(fit.estimate(unit[1]), -1, 0.03);
    EXPECT_NEAR(fit.estimate(unit[2]), 0.25, 1e-9);
}

} // namespace
} // namespace gimg::codec

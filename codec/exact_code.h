#pragma once

#include "arena.h"
#include "border.h"
#include "linear_fit.h"
#include "mixer.h"
#include "subbands.h"

#include <cstring>

namespace gimg::codec {

// Lossless coding of n x n samples of some channels, coarse to fine: the 3 x 3 image comes first, and each
// further level predicts its new samples from those around them, by weights that are fitted to the samples
// before. What is coded is a sample's distance from its prediction, as a count of the numbers between.

struct ExactFormat
{
    static constexpr unsigned kMostChannels = 16, kMostBits = 16;

    std::uint32_t grid = 0;
    unsigned channels = 1; ///< 1 .. kMostChannels
    unsigned bits = 0;     ///< of integers, 1 .. kMostBits; 0: the samples are finite floats
};

constexpr unsigned kLengthModels = 3;    ///< mixed for each bit of a length
constexpr unsigned kLengthPlaces = 5;    ///< of a bit in the walk to a length
constexpr unsigned kSmallLengths = 4;    ///< told apart
constexpr unsigned kFineDistances = 64;  ///< quarter octaves
constexpr unsigned kRoughDistances = 48; ///< likewise
constexpr unsigned kRoughRatios = 16;    ///< half octaves
constexpr unsigned kLongest = 32;        ///< bits of a distance
constexpr unsigned kExactComponents = 3; ///< channels told apart

struct ExactModels
{
    BitModel byExpected[kFineDistances][kExactComponents][kLengthPlaces][kSmallLengths];
    BitModel byCoarser[kRoughDistances][kRoughRatios][kLengthPlaces][kSmallLengths];
    BitModel byCorrection[kRoughDistances][kRoughRatios][kLengthPlaces][kSmallLengths];
    MixWeights<kLengthModels> weights[kLengthPlaces][kSmallLengths][3];
    BitModel leading[kLongest + 1][8]; ///< the bits below the highest
    BitModel second[kLongest + 1][2];
    BitModel third[kLongest + 1][4];
    BitModel negative[kExactComponents][3][3][3][3];
};

/// Memory for coding, in an arena.
struct ExactWork
{
    static std::uint64_t size(const ExactFormat& format);
    /// @param classes  borderClasses() of the grid; nullptr: nothing is glued
    bool take(Arena& arena, const ExactFormat& format, const std::uint32_t* classes);

    static constexpr std::uint32_t kKnown = 1u << 31;

    std::uint16_t* sizes; ///< twice that of each sample's distance, + 1 for negative ones; 0: none
    LinearFit* fits;      ///< by band and channel
    ExactModels* models;
    std::uint32_t* next; ///< around each class of the border; with kKnown once it is coded
};

namespace detail {

/// Order-preserving; +0 follows -0.
inline std::uint32_t orderOf(float value)
{
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    return (bits >> 31) != 0 ? ~bits : bits | 1u << 31;
}

inline float floatOfOrder(std::uint32_t order)
{
    const std::uint32_t bits = (order >> 31) != 0 ? order & ~(1u << 31) : ~order;
    float value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

inline unsigned exponentBits(float value)
{
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    const unsigned exponent = bits >> 23 & 0xFFu;
    return exponent == 0 ? 1 : exponent;
}

/// The exponent of the number whose last binary place is 1, a unit of integers.
constexpr unsigned kUnitExponent = 150;

/// 2^exponent, within the range of normal doubles.
inline double powerOfTwo(int exponent)
{
    const std::uint64_t bits = static_cast<std::uint64_t>(exponent + 1023) << 52;
    double value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

/// A magnitude in quarter octaves, on the scale of sizes: the last binary place of a float with exponent
/// bits e has 4 e + 4. At least 0.
inline int quarterOctaves(double magnitude)
{
    std::uint64_t bits;
    std::memcpy(&bits, &magnitude, sizeof bits);
    const int exponent = static_cast<int>(bits >> 52 & 0x7FFu) - 1023;
    const int quarters =
        4 * (exponent + static_cast<int>(kUnitExponent)) + 4 + static_cast<int>(bits >> 50 & 3u);
    return quarters < 0 ? 0 : quarters;
}

inline unsigned clampTo(int value, unsigned count)
{
    return value < 0 ? 0u : value >= static_cast<int>(count) ? count - 1 : static_cast<unsigned>(value);
}

/// One of the samples a prediction is made from: its place in steps of the level's grid, and how it counts
/// before anything is learnt.
struct Neighbour
{
    int di, dj;
    double weight;
};

/// A band's samples: at odd i and even j (Horizontal), even i and odd j (Vertical), odd both (Diagonal).
struct ExactBand
{
    unsigned nearest;        ///< so many come first; their mean is the prediction's base
    unsigned known, count;   ///< how many neighbours are of the bands before; how many there are in all
    Neighbour neighbour[16]; ///< the first follows from the base and the others of the nearest
};

constexpr ExactBand kExactBands[3] = {
    {2,
     8,
     12,
     {{1, 0, 0},
      {-1, 0, 0},
      {-3, 0, -0.0625},
      {3, 0, -0.0625},
      {-1, -2, 0},
      {1, -2, 0},
      {-1, 2, 0},
      {1, 2, 0},
      {-2, 0, 0},
      {0, -2, 0},
      {-2, -2, 0},
      {2, -2, 0}}},
    {2,
     12,
     16,
     {{0, 1, 0},
      {0, -1, 0},
      {0, -3, -0.0625},
      {0, 3, -0.0625},
      {-1, -1, 0},
      {1, -1, 0},
      {-1, 1, 0},
      {1, 1, 0},
      {-2, -1, 0},
      {2, -1, 0},
      {-2, 1, 0},
      {2, 1, 0},
      {-2, 0, 0},
      {0, -2, 0},
      {-2, -2, 0},
      {2, -2, 0}}},
    {4,
     12,
     14,
     {{0, 1, 0},
      {-1, 0, 0.25},
      {1, 0, 0.25},
      {0, -1, 0.25},
      {-1, -1, -0.25},
      {1, -1, -0.25},
      {-1, 1, -0.25},
      {1, 1, -0.25},
      {-3, 0, 0},
      {3, 0, 0},
      {0, -3, 0},
      {0, 3, 0},
      {-2, 0, 0},
      {0, -2, 0}}},
};

/// One image on its way through a coder.
template <class Coder> class ExactImage
{
public:
    ExactImage(Coder& coder, const ExactWork& work, const ExactFormat& format, bool isGlued, float* samples)
        : coder_(coder), work_(work), models_(*work.models), format_(format), isGlued_(isGlued),
          samples_(samples), last_(static_cast<std::int32_t>(format.grid - 1)), channels_(format.channels),
          longest_(format.bits == 0 ? kLongest : format.bits)
    {
    }

    void code()
    {
        const std::int32_t half = last_ / 2;
        for (std::int32_t j = 0; j <= last_; j += half)
            for (std::int32_t i = 0; i <= last_; i += half) codeCoarse(i, j);
        for (unsigned band = 0; band < 3; ++band) {
            double start[LinearFit::kMost];
            const unsigned count = kExactBands[band].count - 1;
            for (unsigned k = 0; k < count; ++k) start[k] = kExactBands[band].neighbour[k + 1].weight;
            for (unsigned c = 0; c < channels_; ++c) fitOf(band, c).begin(start, count);
        }
        for (step_ = half / 2; step_ >= 1 && !coder_.failed(); step_ /= 2)
            for (unsigned band = 0; band < 3; ++band) codeBand(band);
    }

private:
    static constexpr double kFadePerLevel = 0.1, kFadePerRow = 0.95;
    static constexpr double kLargest = 3.4028234663852886e38;

    /// What is known of a sample before it is coded. Sizes are 0 where nothing is known.
    struct Expectation
    {
        int size;       ///< of its distance
        int near;       ///< the mean size around it in its band
        int coarser;    ///< and in the bands before
        int correction; ///< of the prediction from its base
        unsigned sign[4];
    };

    LinearFit& fitOf(unsigned band, unsigned channel) { return work_.fits[band * channels_ + channel]; }

    std::size_t indexOf(std::int32_t i, std::int32_t j) const
    {
        return (static_cast<std::size_t>(j) * format_.grid + static_cast<std::size_t>(i)) * channels_;
    }

    bool isInside(std::int32_t i, std::int32_t j) const
    {
        return i >= 0 && j >= 0 && i <= last_ && j <= last_;
    }

    // Outside, the sample of the same lattice that is next inside.
    std::int32_t folded(std::int32_t i) const
    {
        while (i < 0) i += 2 * step_;
        while (i > last_) i -= 2 * step_;
        return i;
    }

    bool isCoded(std::int32_t i, std::int32_t j) const
    {
        const auto x = static_cast<std::uint32_t>(i), y = static_cast<std::uint32_t>(j);
        return isGlued_ && onBorder(format_.grid, x, y) &&
               (work_.next[borderPosition(format_.grid, x, y)] & ExactWork::kKnown) != 0;
    }

    // What is glued to a sample is the same.
    void copyToClass(std::int32_t i, std::int32_t j)
    {
        const std::uint32_t grid = format_.grid;
        const auto x = static_cast<std::uint32_t>(i), y = static_cast<std::uint32_t>(j);
        if (!isGlued_ || !onBorder(grid, x, y)) return;
        const std::size_t from = indexOf(i, j);
        std::uint32_t position = borderPosition(grid, x, y);
        while ((work_.next[position] & ExactWork::kKnown) == 0) {
            const std::uint32_t next = work_.next[position];
            work_.next[position] |= ExactWork::kKnown;
            const std::size_t to = std::size_t{borderSample(grid, position)} * channels_;
            for (unsigned c = 0; c < channels_; ++c) {
                samples_[to + c] = samples_[from + c];
                work_.sizes[to + c] = work_.sizes[from + c];
            }
            position = next;
        }
    }

    void codeCoarse(std::int32_t i, std::int32_t j)
    {
        if (isCoded(i, j)) return;
        const std::size_t at = indexOf(i, j);
        for (unsigned c = 0; c < channels_; ++c) {
            float& sample = samples_[at + c];
            const std::uint32_t order = Coder::kDecodes ? 0 : orderAt(at + c);
            sample = sampleOf(coder_.raw(longest_, order));
            work_.sizes[at + c] = 0;
        }
        copyToClass(i, j);
    }

    std::uint32_t orderAt(std::size_t index) const
    {
        return format_.bits == 0 ? orderOf(samples_[index]) : static_cast<std::uint32_t>(samples_[index]);
    }

    // Fails if there is none.
    float sampleOf(std::uint32_t order)
    {
        if (format_.bits != 0) {
            if (order >> format_.bits != 0) return coder_.fail(), 0.0f;
            return static_cast<float>(order);
        }
        const float value = floatOfOrder(order);
        if (!(value - value == 0.0f)) return coder_.fail(), 0.0f;
        return value;
    }

    void codeBand(unsigned band)
    {
        band_ = &kExactBands[band];
        for (unsigned k = 0; k < band_->count; ++k) {
            const Neighbour& at = band_->neighbour[k];
            offset_[k] = (std::ptrdiff_t{at.dj} * static_cast<std::ptrdiff_t>(format_.grid) + at.di) * step_ *
                         static_cast<std::ptrdiff_t>(channels_);
        }
        for (unsigned c = 0; c < channels_; ++c) fitOf(band, c).fade(kFadePerLevel);
        const std::int32_t i0 = band == Vertical ? 0 : step_, j0 = band == Horizontal ? 0 : step_;
        for (std::int32_t j = j0; j <= last_ && !coder_.failed(); j += 2 * step_) {
            for (unsigned c = 0; c < channels_; ++c) {
                LinearFit& fit = fitOf(band, c);
                fit.fade(kFadePerRow);
                fit.solve();
            }
            for (std::int32_t i = i0; i <= last_; i += 2 * step_) {
                if (isCoded(i, j)) continue;
                for (unsigned c = 0; c < channels_; ++c) codeSample(band, i, j, c);
                copyToClass(i, j);
            }
        }
    }

    void codeSample(unsigned band, std::int32_t i, std::int32_t j, unsigned channel)
    {
        const std::size_t at = indexOf(i, j) + channel;
        double values[16] = {}, x[LinearFit::kMost];
        const double base = gather(i, j, channel, values);
        for (unsigned k = 1; k < band_->count; ++k) x[k - 1] = values[k] - base;

        LinearFit& fit = fitOf(band, channel);
        double prediction = base + fit.estimate(x);
        if (!(prediction <= kLargest && prediction >= -kLargest)) prediction = base;
        const unsigned unit =
            format_.bits == 0 ? exponentBits(static_cast<float>(prediction)) : kUnitExponent;
        const Expectation expected = expectation(band, i, j, channel, prediction - base);
        samples_[at] = codeFrom(at, prediction, unit, expected, band, channel);

        const double error = static_cast<double>(samples_[at]) - prediction;
        const double weight = 1.0 / ((error * error + powerOfTwo((expected.size >> 1) - 300)) +
                                     powerOfTwo(2 * static_cast<int>(unit) - 300));
        fit.learn(x, static_cast<double>(samples_[at]) - base, error, weight);
    }

    double baseOf(const double* values) const
    {
        double sum = 0;
        for (unsigned k = 0; k < band_->nearest; ++k) sum += values[k];
        return sum * (band_->nearest == 2 ? 0.5 : 0.25);
    }

    // Returns the base.
    double gather(std::int32_t i, std::int32_t j, unsigned channel, double* values) const
    {
        const std::int32_t reach = 3 * step_;
        if (i >= reach && j >= reach && i + reach <= last_ && j + reach <= last_) {
            const float* here = samples_ + indexOf(i, j) + channel;
            for (unsigned k = 0; k < band_->count; ++k) values[k] = static_cast<double>(here[offset_[k]]);
            return baseOf(values);
        }
        const auto sample = [&](std::int32_t x, std::int32_t y) {
            return static_cast<double>(samples_[indexOf(x, y) + channel]);
        };
        for (unsigned k = 0; k < band_->known; ++k)
            values[k] = sample(folded(i + band_->neighbour[k].di * step_),
                               folded(j + band_->neighbour[k].dj * step_));
        // A neighbour of this band that is not there says nothing.
        const double base = baseOf(values);
        for (unsigned k = band_->known; k < band_->count; ++k) {
            const std::int32_t x = i + band_->neighbour[k].di * step_, y = j + band_->neighbour[k].dj * step_;
            values[k] = isInside(x, y) ? sample(x, y) : base;
        }
        return base;
    }

    int sizeAt(std::int32_t i, std::int32_t j, unsigned channel) const
    {
        return isInside(i, j) ? work_.sizes[indexOf(i, j) + channel] : 0;
    }

    static unsigned signOfSize(int size) { return size == 0 ? 0u : 1u + (static_cast<unsigned>(size) & 1u); }

    /// A mean of sizes, of which 0 are none.
    struct SizeMean
    {
        int sum = 0, weights = 0;

        void add(int size, int weight)
        {
            if (size == 0) return;
            sum += weight * (size >> 1);
            weights += weight;
        }
        int mean() const { return weights == 0 ? 0 : sum / weights; }
    };

    Expectation expectation(unsigned band, std::int32_t i, std::int32_t j, unsigned c,
                            double correction) const
    {
        const std::int32_t s = step_;
        Expectation out;
        SizeMean near, coarser, others;
        const int west = sizeAt(i - 2 * s, j, c), north = sizeAt(i, j - 2 * s, c);
        near.add(west, 3);
        near.add(north, 3);
        near.add(sizeAt(i - 2 * s, j - 2 * s, c), 2);
        near.add(sizeAt(i + 2 * s, j - 2 * s, c), 2);
        near.add(sizeAt(i - 4 * s, j, c), 1);
        near.add(sizeAt(i, j - 4 * s, c), 1);
        const auto addPair = [&](std::int32_t di, std::int32_t dj) {
            coarser.add(sizeAt(i - di, j - dj, c), 1);
            coarser.add(sizeAt(i + di, j + dj, c), 1);
        };
        addPair(s, band == Vertical ? s : 0);
        if (band == Vertical) addPair(s, -s);
        if (band == Diagonal) addPair(0, s);
        const std::size_t here = indexOf(i, j);
        for (unsigned k = 0; k < c; ++k) others.add(work_.sizes[here + k], 1);
        for (unsigned k = 1; c == 0 && k < channels_; ++k) {
            others.add(sizeAt(i - 2 * s, j, k), 1);
            others.add(sizeAt(i, j - 2 * s, k), 1);
        }
        out.near = near.mean();
        out.coarser = coarser.mean();
        out.correction = quarterOctaves(correction);
        const int other = others.mean();
        const int weights =
            (out.near != 0 ? 6 : 0) + (out.coarser != 0 ? 2 : 0) + (other != 0 ? (c == 0 ? 1 : 4) : 0);
        out.size = weights == 0 ? out.correction
                                : (6 * out.near + 2 * out.coarser + (c == 0 ? 1 : 4) * other) / weights;
        if (out.near == 0) out.near = out.size;
        if (out.coarser == 0) out.coarser = out.size;
        out.sign[0] = signOfSize(west);
        out.sign[1] = signOfSize(north);
        out.sign[2] = c > 0 ? signOfSize(work_.sizes[here + c - 1]) : 0;
        out.sign[3] = c > 1 ? signOfSize(work_.sizes[here + c - 2]) : 0;
        return out;
    }

    float codeFrom(std::size_t at, double prediction, unsigned unit, const Expectation& expected,
                   unsigned band, unsigned channel)
    {
        std::uint32_t order;
        if (format_.bits == 0) {
            order = orderOf(static_cast<float>(prediction));
        } else {
            const double most = static_cast<double>((1u << format_.bits) - 1);
            const double clamped = prediction > most ? most : prediction > 0 ? prediction : 0.0;
            order = static_cast<std::uint32_t>(clamped + 0.5);
        }
        const std::uint32_t difference = Coder::kDecodes ? 0 : orderAt(at) - order;
        bool isNegative = (difference >> 31) != 0;
        std::uint32_t distance = isNegative ? 0u - difference : difference;
        distance = codeDistance(distance, unit, expected, band, channel);
        if (distance != 0) {
            const unsigned* s = expected.sign;
            BitModel& model = models_.negative[channel < kExactComponents ? channel : kExactComponents - 1]
                                              [s[0]][s[1]][s[2]][s[3]];
            isNegative = coder_.bit(model, isNegative);
            order += isNegative ? 0u - distance : distance;
        }
        // Of a distance that is not 0, as quarterOctaves() tells those of the samples themselves.
        unsigned size = 4 * unit;
        if (distance != 0) {
            const unsigned octave = log2Floor(distance);
            const std::uint32_t next = octave >= 2 ? distance >> (octave - 2) : distance << (2 - octave);
            size += 4 * octave + 4 + (next & 3u);
        }
        work_.sizes[at] = static_cast<std::uint16_t>(2 * size + (distance != 0 && isNegative ? 1 : 0));
        return sampleOf(order);
    }

    // The number of bits, from the expected one up or down; then all bits but the highest.
    std::uint32_t codeDistance(std::uint32_t distance, unsigned unit, const Expectation& expected,
                               unsigned band, unsigned channel)
    {
        const int scale = 4 * static_cast<int>(unit);
        const auto inUnits = [&](int size) { return static_cast<int>(clampTo(size - scale, 131)); };
        const int size = inUnits(expected.size), near = inUnits(expected.near),
                  coarser = inUnits(expected.coarser), correction = inUnits(expected.correction);
        const unsigned first =
            static_cast<unsigned>(size >> 2) < longest_ ? static_cast<unsigned>(size >> 2) : longest_ - 1;
        const unsigned component = channel < kExactComponents ? channel : kExactComponents - 1;
        const unsigned roughCoarser = clampTo((correction - coarser + 16) >> 1, kRoughRatios);
        const unsigned roughNear = clampTo((near - correction + 16) >> 1, kRoughRatios);
        const unsigned length = distance == 0 ? 0 : log2Floor(distance) + 1;
        const auto isAbove = [&](unsigned bits) {
            const unsigned place = bits == first       ? 0
                                   : bits == first + 1 ? 1
                                   : bits > first      ? 2
                                   : bits + 1 == first ? 3
                                                       : 4;
            const unsigned small = bits < kSmallLengths ? bits : kSmallLengths - 1;
            const int quarters = 4 * static_cast<int>(bits);
            BitModel* const mixed[kLengthModels] = {
                &models_.byExpected[clampTo(quarters - size + 32, kFineDistances)][component][place][small],
                &models_.byCoarser[clampTo(quarters - coarser + 24, kRoughDistances)][roughCoarser][place]
                                  [small],
                &models_.byCorrection[clampTo(quarters - correction + 24, kRoughDistances)][roughNear][place]
                                     [small]};
            return codeMixed(coder_, mixed, models_.weights[place][small][band], length > bits);
        };
        unsigned bits = first;
        if (isAbove(bits)) {
            ++bits;
            while (bits < longest_ && isAbove(bits)) ++bits;
        } else {
            while (bits > 0 && !isAbove(bits - 1)) --bits;
        }
        if (bits == 0) return 0;
        std::uint32_t value = 1;
        unsigned rest = bits - 1;
        const auto next = [&](BitModel& model) {
            --rest;
            value = value << 1 | (coder_.bit(model, (distance >> rest & 1u) != 0) ? 1u : 0u);
        };
        if (rest > 0) next(models_.leading[bits][clampTo((size - 4 * static_cast<int>(bits) + 16) >> 2, 8)]);
        if (rest > 0) next(models_.second[bits][value & 1u]);
        if (rest > 0) next(models_.third[bits][value & 3u]);
        if (rest > 0) value = value << rest | coder_.raw(rest, distance & ((1u << rest) - 1));
        return value;
    }

    Coder& coder_;
    const ExactWork& work_;
    ExactModels& models_;
    const ExactFormat& format_;
    const bool isGlued_;
    float* const samples_;
    const std::int32_t last_;
    const unsigned channels_, longest_;
    std::int32_t step_ = 0;
    const ExactBand* band_ = nullptr;
    std::ptrdiff_t offset_[16] = {};
};

} // namespace detail

/// Codes an image.
/// @param samples  grid x grid samples of `channels` floats; integers are held in floats
/// Encoders must have made the samples of each class equal. Failure shows in the coder.
template <class Coder>
void codeExact(Coder& coder, const ExactWork& work, const ExactFormat& format, const std::uint32_t* classes,
               float* samples)
{
    detail::ExactImage<Coder>(coder, work, format, classes != nullptr, samples).code();
}

} // namespace gimg::codec

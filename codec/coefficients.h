#pragma once

#include "exp_golomb.h"
#include "mixer.h"
#include "subbands.h"

#include <cstring>

namespace gimg::codec {

constexpr unsigned kComponents = 3;

/// Quantised coefficients of an image of three components.
struct QuantizedImage
{
    std::uint32_t grid = 0;
    std::int32_t* detail[kComponents] = {};                       ///< planes of grid^2; [0, 3)^2 is unused
    std::int64_t coarse[kComponents][kCoarsest * kCoarsest] = {}; ///< the 3 x 3 image
};

/// Details fit 30 bits; the coarsest image's samples are exact in a double.
constexpr unsigned kDetailPrefixes = 30;
constexpr std::int32_t kMaxDetail = (1 << 30) - 1;
constexpr unsigned kCoarseBits = 50;
constexpr std::int64_t kMaxCoarse = (std::int64_t{1} << kCoarseBits) - 1;

/// A sum of magnitudes in half octaves: 0, 1, 2, 3, 4-5, 6-7, 8-11, 12-15..., at most `cap`.
inline unsigned activityClass(std::uint64_t sum, unsigned cap)
{
    if (sum < 2) return static_cast<unsigned>(sum);
    if (sum > 0xFFFF) return cap;
    const auto small = static_cast<std::uint32_t>(sum);
    const unsigned octave = log2Floor(small);
    const unsigned value = 2 * octave + (small >> (octave - 1) & 1u);
    return value < cap ? value : cap;
}

/// The same for the caps in use, from a table.
struct ActivityTable
{
    static constexpr unsigned kSize = 3072; // where class 23 begins
    std::uint8_t value[kSize + 1];

    constexpr ActivityTable() : value()
    {
        for (std::uint32_t sum = 0; sum <= kSize; ++sum) {
            unsigned octave = 0;
            while (sum >> (octave + 1) != 0) ++octave;
            value[sum] = static_cast<std::uint8_t>(sum < 2 ? sum : 2 * octave + (sum >> (octave - 1) & 1u));
        }
    }
};
inline constexpr ActivityTable kActivity{};

template <unsigned Cap> unsigned quickClass(std::uint64_t sum)
{
    static_assert(Cap >= 2 && Cap <= 23);
    constexpr std::uint64_t kFirst = (std::uint64_t{2} + Cap % 2) << (Cap / 2 - 1); // sum of class Cap
    return kActivity.value[sum < kFirst ? sum : kFirst];
}

inline std::uint64_t magnitudeOf(std::int32_t value)
{
    return static_cast<std::uint64_t>(value < 0 ? -std::int64_t{value} : std::int64_t{value});
}

inline int signOf(std::int64_t value) { return (value > 0 ? 1 : 0) - (value < 0 ? 1 : 0); }

constexpr unsigned kOwnClasses = 18;
constexpr unsigned kOtherClasses = 8;
constexpr unsigned kFamilyClasses = 8;
constexpr unsigned kEachClasses = 8;
constexpr unsigned kTotalClasses = 24;
constexpr unsigned kPlaceClasses = 10;
constexpr unsigned kLevels = 11; ///< of details, in the largest grid

/// How many estimates are mixed for each bit of a magnitude, and how many bits are coded that way before
/// the escape.
constexpr unsigned kMixed = 5;
constexpr unsigned kSteps = 3;
constexpr unsigned kMixedSigns = 3;

struct CoefficientModels
{
    BitModel bandIsEmpty[kComponents];
    // Magnitudes; the last index counts the bits.
    BitModel nearAndOthers[kOwnClasses][kOtherClasses][kComponents][kSteps];
    BitModel nearAndFamily[kOwnClasses][kFamilyClasses][2][kSteps];
    BitModel eachNear[kEachClasses][kEachClasses][kEachClasses][kSteps];
    BitModel everything[kTotalClasses][kComponents][kSteps];
    BitModel place[kLevels][3][kPlaceClasses][kSteps];
    MixWeights<kMixed> weights[kTotalClasses][kSteps];
    ExpGolombModels<kDetailPrefixes> larger[kOwnClasses];
    BitModel signAlong[3][3][3][3][3];
    BitModel signAcross[3][7];
    BitModel signFamily[3][3][3];
    MixWeights<kMixedSigns> signWeights[3];
    ExpGolombModels<kCoarseBits> coarse;
};

/// Coefficients around one place of a band that are coded before it.
struct Neighbourhood
{
    enum Direction : unsigned
    {
        West,
        North,
        NorthWest,
        NorthEast,
        Parent,  ///< in the coarser level's band of the same orientation
        Sibling, ///< at the same place of this level's horizontal band
        kCount,
    };
    std::int32_t value[kComponents][kCount];
    std::uint64_t farther[kComponents];       ///< magnitudes two steps west and north
    std::uint64_t secondSibling[kComponents]; ///< magnitude at the same place of the vertical band
    std::int32_t here[kComponents];           ///< this place's components coded so far; 0 for the others
};

/// The models that one coefficient uses.
struct CoefficientContext
{
    BitModel* magnitude[kMixed]; ///< of the first bit; those of the next bits follow
    MixWeights<kMixed>* weights; ///< likewise
    ExpGolombModels<kDetailPrefixes>* larger;
    CoefficientModels* all; ///< with the rest, for the sign
    const Neighbourhood* near;
    unsigned component;
    unsigned orientation;
};

/// Codes whether a coefficient that is not zero is negative.
template <class Coder> bool codeSign(Coder& coder, const CoefficientContext& context, bool negative)
{
    const unsigned component = context.component;
    const Neighbourhood& near = *context.near;
    const std::int32_t* own = near.value[component];
    // Where neighbours of this component and one coded before varied alike, so will they here.
    std::int64_t expected = 0;
    for (unsigned c = 0; c < component; ++c) {
        if (near.here[c] == 0) continue;
        std::int64_t alike = 0;
        for (unsigned k = 0; k < Neighbourhood::kCount; ++k) {
            const std::int32_t other = near.value[c][k];
            alike += signOf(other) * signOf(own[k]) *
                     static_cast<std::int64_t>(activityClass(magnitudeOf(other), 63) *
                                               activityClass(magnitudeOf(own[k]), 63));
        }
        expected += signOf(near.here[c]) * alike;
    }
    const std::int64_t clarity = expected < 0 ? -expected : expected;
    const unsigned across = expected == 0 ? 0u
                                          : (expected < 0 ? 1u : 4u) + (clarity < 4    ? 0u
                                                                        : clarity < 16 ? 1u
                                                                                       : 2u);

    const auto side = [own](Neighbourhood::Direction k) { return static_cast<unsigned>(signOf(own[k]) + 1); };
    CoefficientModels& models = *context.all;
    const unsigned o = context.orientation;
    BitModel* const mixed[kMixedSigns] = {
        &models.signAlong[o][side(Neighbourhood::West)][side(Neighbourhood::North)]
                         [side(Neighbourhood::NorthWest)][side(Neighbourhood::NorthEast)],
        &models.signAcross[component][across],
        &models.signFamily[o][side(Neighbourhood::Parent)][side(Neighbourhood::Sibling)],
    };
    return codeMixed(coder, mixed, models.signWeights[o], negative);
}

/// Codes a detail: up to `Count` bits that say whether its magnitude is above 0, 1, .., an escape, and the
/// sign.
/// @param isAbove     codes such a bit: isAbove(its number, bit)
/// @param isNegative  codes the sign: isNegative(bit)
template <unsigned Count, class Coder, class IsAbove, class IsNegative>
std::int32_t codeSigned(Coder& coder, ExpGolombModels<kDetailPrefixes>& larger, const IsAbove& isAbove,
                        const IsNegative& isNegative, std::int32_t value)
{
    std::uint64_t magnitude = magnitudeOf(value);
    unsigned bit = 0;
    while (bit < Count && isAbove(bit, magnitude > bit)) ++bit;
    if (bit == 0) return 0;
    magnitude = bit < Count ? bit : Count + codeExpGolomb(coder, larger, magnitude - Count);
    // The escape's largest value would leave the range of a detail by a hair.
    if (magnitude > static_cast<std::uint64_t>(kMaxDetail)) return coder.fail(), 0;
    const auto size = static_cast<std::int32_t>(magnitude);
    return isNegative(value < 0) ? -size : size;
}

template <class Coder>
std::int32_t codeDetail(Coder& coder, const CoefficientContext& context, std::int32_t value)
{
    const auto isAbove = [&](unsigned step, bool bit) {
        BitModel* models[kMixed];
        for (unsigned k = 0; k < kMixed; ++k) models[k] = context.magnitude[k] + step;
        return codeMixed(coder, models, context.weights[step], bit);
    };
    const auto isNegative = [&](bool bit) { return codeSign(coder, context, bit); };
    return codeSigned<kSteps>(coder, *context.larger, isAbove, isNegative, value);
}

/// Three rows of coefficients of one component with zeros around, for neighbours without branches.
class NeighbourRows
{
public:
    static constexpr std::uint32_t kMargin = 2;
    static constexpr std::size_t scratchSize(std::uint32_t width)
    {
        return 3 * (std::size_t{width} + 2 * kMargin);
    }

    void begin(std::int32_t* scratch, std::uint32_t width)
    {
        pitch_ = width + 2 * kMargin;
        std::memset(scratch, 0, scratchSize(width) * sizeof *scratch);
        for (unsigned k = 0; k < 3; ++k) row_[k] = scratch + k * pitch_ + kMargin;
    }

    void nextRow()
    {
        std::int32_t* oldest = row_[2];
        row_[2] = row_[1];
        row_[1] = row_[0];
        row_[0] = oldest;
        std::memset(oldest - kMargin, 0, pitch_ * sizeof *oldest);
    }

    std::int32_t* row(unsigned up) const { return row_[up]; }

private:
    std::size_t pitch_ = 0;
    std::int32_t* row_[3] = {};
};

/// Codes all coefficients of an image, coarse to fine.
///
/// @param pick     called as pick(coder, context, component, index) for each detail of a band that is not
///                 empty; codes it with codeDetail() and returns it. A decoder's just decodes.
/// @param isEmpty  isEmpty(component, band) of an encoder: the band holds zeros only
/// @param scratch  kComponents * NeighbourRows::scratchSize(grid / 2 + 1) entries
/// The planes must be zero at the start in a decoder. Failure shows in the coder.
template <class Coder, class Pick, class IsEmpty>
void codeImage(Coder& coder, CoefficientModels& models, QuantizedImage& image, Pick& pick, IsEmpty& isEmpty,
               std::int32_t* scratch);

namespace detail {

template <class Coder>
void codeCoarse(Coder& coder, ExpGolombModels<kCoarseBits>& models, QuantizedImage& image,
                unsigned components = kComponents)
{
    for (unsigned c = 0; c < components; ++c) {
        for (unsigned k = 0; k < kCoarsest * kCoarsest; ++k) {
            std::int64_t& value = image.coarse[c][k];
            const std::int64_t expected =
                k == 0 ? 0 : image.coarse[c][k % kCoarsest == 0 ? k - kCoarsest : k - 1];
            if (coder.hasEnded()) {
                value = expected;
                continue;
            }
            const std::int64_t difference = Coder::kDecodes ? 0 : value - expected;
            std::uint64_t magnitude = difference < 0 ? static_cast<std::uint64_t>(-difference)
                                                     : static_cast<std::uint64_t>(difference);
            if (k == 0) {
                // Where the surface lies in space: nothing is known of it but that.
                unsigned bits = 0;
                while (magnitude >> bits != 0) ++bits;
                bits = static_cast<unsigned>(coder.raw(6, bits));
                if (coder.hasEnded()) bits = 0;
                if (bits > kCoarseBits) return coder.fail();
                magnitude = codeRaw(coder, bits, magnitude);
            } else {
                magnitude = codeExpGolomb(coder, models, magnitude);
            }
            if (magnitude != 0) {
                const bool negative = coder.raw(1, difference < 0 ? 1 : 0) != 0;
                value = expected + (negative ? -static_cast<std::int64_t>(magnitude)
                                             : static_cast<std::int64_t>(magnitude));
            } else {
                value = expected;
            }
            if (coder.hasEnded()) value = expected;
            if (value > kMaxCoarse || value < -kMaxCoarse) return coder.fail();
        }
    }
}

inline CoefficientContext contextOf(CoefficientModels& models, const Neighbourhood& near, unsigned component,
                                    unsigned orientation, unsigned level)
{
    std::uint64_t own[Neighbourhood::kCount];
    for (unsigned k = 0; k < Neighbourhood::kCount; ++k) own[k] = magnitudeOf(near.value[component][k]);
    const std::uint64_t west = own[Neighbourhood::West], north = own[Neighbourhood::North];
    const std::uint64_t diagonals = own[Neighbourhood::NorthWest] + own[Neighbourhood::NorthEast];
    const std::uint64_t around = 2 * (west + north) + diagonals + near.farther[component];
    const std::uint64_t family =
        own[Neighbourhood::Parent] + 2 * (own[Neighbourhood::Sibling] + near.secondSibling[component]);
    // Components already coded at this place say more than the neighbours of those that are not.
    std::uint64_t others = 0;
    for (unsigned c = 0; c < kComponents; ++c) {
        if (c < component)
            others += 2 * magnitudeOf(near.here[c]);
        else if (c > component)
            others += (magnitudeOf(near.value[c][Neighbourhood::West]) +
                       magnitudeOf(near.value[c][Neighbourhood::North]) + 1) /
                      2;
    }

    const unsigned a = activityClass(around, kOwnClasses - 1);
    const unsigned b = activityClass(others, kOtherClasses - 1);
    const unsigned f = activityClass(family, kFamilyClasses - 1);
    const unsigned w = activityClass(west, kEachClasses - 1);
    const unsigned n = activityClass(north, kEachClasses - 1);
    const unsigned d = activityClass(diagonals, kEachClasses - 1);
    const unsigned all = activityClass(2 * around + 3 * others + 2 * family, kTotalClasses - 1);
    CoefficientContext context;
    context.magnitude[0] = models.nearAndOthers[a][b][component];
    context.magnitude[1] = models.nearAndFamily[a][f][orientation == Diagonal];
    context.magnitude[2] = models.eachNear[w][n][d];
    context.magnitude[3] = models.everything[all][component];
    context.magnitude[4] = models.place[level][orientation][a < kPlaceClasses ? a : kPlaceClasses - 1];
    context.weights = models.weights[all];
    context.larger = &models.larger[a];
    context.all = &models;
    context.near = &near;
    context.component = component;
    context.orientation = orientation;
    return context;
}

} // namespace detail

template <class Coder, class Pick, class IsEmpty>
void codeImage(Coder& coder, CoefficientModels& models, QuantizedImage& image, Pick& pick, IsEmpty& isEmpty,
               std::int32_t* scratch)
{
    detail::codeCoarse(coder, models.coarse, image);
    const std::size_t pitch = image.grid;
    unsigned level = 0;
    for (std::uint32_t m = kCoarsest; 2 * m - 1 <= image.grid && !coder.failed(); m = 2 * m - 1, ++level) {
        for (unsigned orientation = 0; orientation < 3; ++orientation) {
            const Subband band = subband(m, orientation);
            const bool hasParent = m > kCoarsest;
            const Subband parent = subband((m + 1) / 2, orientation);
            const Subband horizontal = subband(m, Horizontal), vertical = subband(m, Vertical);

            bool empty[kComponents];
            NeighbourRows rows[kComponents];
            for (unsigned c = 0; c < kComponents; ++c) {
                empty[c] = coder.bit(models.bandIsEmpty[c], isEmpty(c, band));
                rows[c].begin(scratch + c * NeighbourRows::scratchSize(image.grid / 2 + 1), band.width);
            }
            if (empty[0] && empty[1] && empty[2]) continue;

            for (std::uint32_t j = 0; j < band.height; ++j) {
                if (coder.failed()) return;
                for (unsigned c = 0; c < kComponents; ++c) rows[c].nextRow();
                const std::int32_t* parents[kComponents];
                const std::int32_t* siblings[kComponents];
                const std::int32_t* secondSiblings[kComponents];
                for (unsigned c = 0; c < kComponents; ++c) {
                    parents[c] = image.detail[c] + (parent.j0 + j / 2) * pitch + parent.i0;
                    siblings[c] = image.detail[c] + (horizontal.j0 + j) * pitch + horizontal.i0;
                    secondSiblings[c] = image.detail[c] + (vertical.j0 + j) * pitch + vertical.i0;
                }
                for (std::uint32_t i = 0; i < band.width; ++i) {
                    // The horizontal band is a column narrower than the vertical one.
                    const std::uint32_t beside = i < horizontal.width ? i : i - 1;
                    Neighbourhood near;
                    for (unsigned c = 0; c < kComponents; ++c) {
                        const std::int32_t* r0 = rows[c].row(0) + i;
                        const std::int32_t* r1 = rows[c].row(1) + i;
                        std::int32_t* v = near.value[c];
                        v[Neighbourhood::West] = r0[-1];
                        v[Neighbourhood::North] = r1[0];
                        v[Neighbourhood::NorthWest] = r1[-1];
                        v[Neighbourhood::NorthEast] = r1[1];
                        v[Neighbourhood::Parent] = hasParent ? parents[c][i / 2] : 0;
                        v[Neighbourhood::Sibling] = orientation == Horizontal ? 0 : siblings[c][beside];
                        near.farther[c] = magnitudeOf(r0[-2]) + magnitudeOf(rows[c].row(2)[i]);
                        near.secondSibling[c] =
                            orientation == Diagonal ? magnitudeOf(secondSiblings[c][i]) : 0;
                        near.here[c] = 0;
                    }
                    for (unsigned c = 0; c < kComponents; ++c) {
                        if (empty[c]) continue;
                        const CoefficientContext context =
                            detail::contextOf(models, near, c, orientation, level);
                        const std::size_t index = (band.j0 + j) * pitch + band.i0 + i;
                        const std::int32_t value = pick(coder, context, c, index);
                        near.here[c] = value;
                        image.detail[c][index] = value;
                        rows[c].row(0)[i] = value;
                    }
                }
            }
        }
    }
}

} // namespace gimg::codec

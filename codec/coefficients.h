#pragma once

#include "exp_golomb.h"
#include "subbands.h"

#include <cstring>

namespace gimg::codec {

constexpr unsigned kComponents = 3;

/// Quantised coefficients of an image of three components.
struct QuantizedImage
{
    std::uint32_t grid = 0;
    std::int32_t* detail[kComponents] = {};                            ///< planes of grid^2; [0, 3)^2 is unused
    std::int64_t coarse[kComponents][kCoarsest * kCoarsest] = {};      ///< the 3 x 3 image
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

inline std::uint64_t magnitudeOf(std::int32_t value)
{
    return static_cast<std::uint64_t>(value < 0 ? -std::int64_t{value} : std::int64_t{value});
}

inline int signOf(std::int64_t value) { return (value > 0 ? 1 : 0) - (value < 0 ? 1 : 0); }

constexpr unsigned kOwnClasses = 18;
constexpr unsigned kOtherClasses = 8;
constexpr unsigned kFamilyClasses = 8;

struct CoefficientModels
{
    BitModel bandIsEmpty[kComponents];
    BitModel notZero[2][kOwnClasses][kOtherClasses][kFamilyClasses];
    BitModel aboveOne[kOwnClasses][kOtherClasses];
    BitModel aboveTwo[kOwnClasses][kOtherClasses];
    ExpGolombModels<kDetailPrefixes> larger[kOwnClasses];
    BitModel sign[3][3][9];
    ExpGolombModels<kCoarseBits> coarse;
};

/// The models that one coefficient uses.
struct CoefficientContext
{
    BitModel* notZero;
    BitModel* aboveOne;
    BitModel* aboveTwo;
    ExpGolombModels<kDetailPrefixes>* larger;
    BitModel* sign;
    bool expectNegative; ///< the sign is coded as differing from this
};

template <class Coder> std::int32_t codeDetail(Coder& coder, const CoefficientContext& context, std::int32_t value)
{
    std::uint64_t magnitude = magnitudeOf(value);
    if (!coder.bit(*context.notZero, magnitude > 0)) return 0;
    if (!coder.bit(*context.aboveOne, magnitude > 1)) magnitude = 1;
    else if (!coder.bit(*context.aboveTwo, magnitude > 2)) magnitude = 2;
    else magnitude = 3 + codeExpGolomb(coder, *context.larger, magnitude - 3);
    // The escape's largest value would leave the range of a detail by a hair.
    if (magnitude > static_cast<std::uint64_t>(kMaxDetail)) return coder.fail(), 0;
    const bool negative = coder.bit(*context.sign, (value < 0) != context.expectNegative) != context.expectNegative;
    return negative ? -static_cast<std::int32_t>(magnitude) : static_cast<std::int32_t>(magnitude);
}

/// Three rows of coefficients of one component with zeros around, for neighbours without branches.
class NeighbourRows
{
public:
    static constexpr std::uint32_t kMargin = 2;
    static constexpr std::size_t scratchSize(std::uint32_t width) { return 3 * (std::size_t{width} + 2 * kMargin); }

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

/// What a context is made from at one place of a band: signed neighbours in coding order.
struct Neighbourhood
{
    static constexpr unsigned kCount = 6; ///< W, N, NW, NE, parent, sibling
    std::int32_t value[kComponents][kCount];
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

template <class Coder> void codeCoarse(Coder& coder, CoefficientModels& models, QuantizedImage& image)
{
    for (unsigned c = 0; c < kComponents; ++c) {
        for (unsigned k = 0; k < kCoarsest * kCoarsest; ++k) {
            std::int64_t& value = image.coarse[c][k];
            const std::int64_t expected =
                k == 0 ? 0 : image.coarse[c][k % kCoarsest == 0 ? k - kCoarsest : k - 1];
            const std::int64_t difference = Coder::kDecodes ? 0 : value - expected;
            std::uint64_t magnitude =
                difference < 0 ? static_cast<std::uint64_t>(-difference) : static_cast<std::uint64_t>(difference);
            if (k == 0) {
                // Where the surface lies in space: nothing is known of it but that.
                unsigned bits = 0;
                while (magnitude >> bits != 0) ++bits;
                bits = static_cast<unsigned>(coder.raw(6, bits));
                if (bits > kCoarseBits) return coder.fail();
                magnitude = codeRaw(coder, bits, magnitude);
            } else {
                magnitude = codeExpGolomb(coder, models.coarse, magnitude);
            }
            if (magnitude != 0) {
                const bool negative = coder.raw(1, difference < 0 ? 1 : 0) != 0;
                value = expected + (negative ? -static_cast<std::int64_t>(magnitude) : static_cast<std::int64_t>(magnitude));
            } else {
                value = expected;
            }
            if (value > kMaxCoarse || value < -kMaxCoarse) return coder.fail();
        }
    }
}

inline CoefficientContext contextOf(CoefficientModels& models, const Neighbourhood& near, unsigned component,
                                    unsigned orientation, const std::int32_t (&here)[kComponents],
                                    std::uint64_t farther, std::uint64_t otherSiblings)
{
    const std::int32_t* own = near.value[component];
    const std::uint64_t ownSum = 2 * (magnitudeOf(own[0]) + magnitudeOf(own[1])) + magnitudeOf(own[2]) +
                                 magnitudeOf(own[3]) + farther;
    const std::uint64_t family = magnitudeOf(own[4]) + 2 * magnitudeOf(own[5]) + otherSiblings;
    // Components already coded at this place say more than the neighbours of those that are not.
    std::uint64_t others = 0;
    for (unsigned c = 0; c < kComponents; ++c) {
        if (c < component) others += 2 * magnitudeOf(here[c]);
        else if (c > component) others += (magnitudeOf(near.value[c][0]) + magnitudeOf(near.value[c][1]) + 1) / 2;
    }

    // Where neighbours of this and a coded component varied alike, so will they here.
    std::int64_t expected = 0;
    for (unsigned c = 0; c < component; ++c) {
        if (here[c] == 0) continue;
        std::int64_t product = 0;
        for (unsigned k = 0; k < Neighbourhood::kCount; ++k)
            product += signOf(near.value[c][k]) * signOf(own[k]) *
                       static_cast<std::int64_t>(activityClass(magnitudeOf(near.value[c][k]), 63) *
                                                 activityClass(magnitudeOf(own[k]), 63));
        expected += signOf(here[c]) * product;
    }
    const unsigned west = static_cast<unsigned>(signOf(own[0]) + 1);
    const unsigned north = static_cast<unsigned>(signOf(own[1]) + 1);

    const unsigned a = activityClass(ownSum, kOwnClasses - 1);
    const unsigned b = activityClass(others, kOtherClasses - 1);
    const unsigned f = activityClass(family, kFamilyClasses - 1);
    return {&models.notZero[orientation == Diagonal][a][b][f],
            &models.aboveOne[a][b],
            &models.aboveTwo[a][b],
            &models.larger[a],
            &models.sign[orientation][expected == 0 ? 0 : (expected > 0 ? 1 : 1)][3 * west + north],
            expected < 0};
}

} // namespace detail

template <class Coder, class Pick, class IsEmpty>
void codeImage(Coder& coder, CoefficientModels& models, QuantizedImage& image, Pick& pick, IsEmpty& isEmpty,
               std::int32_t* scratch)
{
    detail::codeCoarse(coder, models, image);
    const std::size_t pitch = image.grid;
    for (std::uint32_t m = kCoarsest; 2 * m - 1 <= image.grid && !coder.failed(); m = 2 * m - 1) {
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
                for (std::uint32_t i = 0; i < band.width; ++i) {
                    Neighbourhood near;
                    std::uint64_t farther[kComponents], otherSiblings[kComponents];
                    for (unsigned c = 0; c < kComponents; ++c) {
                        const std::int32_t* r0 = rows[c].row(0) + i;
                        const std::int32_t* r1 = rows[c].row(1) + i;
                        std::int32_t* v = near.value[c];
                        v[0] = r0[-1];
                        v[1] = r1[0];
                        v[2] = r1[-1];
                        v[3] = r1[1];
                        farther[c] = magnitudeOf(r0[-2]) + magnitudeOf(rows[c].row(2)[i]);
                        const std::int32_t* plane = image.detail[c];
                        v[4] = hasParent ? plane[(parent.j0 + j / 2) * pitch + parent.i0 + i / 2] : 0;
                        v[5] = 0;
                        otherSiblings[c] = 0;
                        if (orientation != Horizontal) {
                            const std::uint32_t hi = i < horizontal.width ? i : i - 1;
                            v[5] = plane[(horizontal.j0 + j) * pitch + horizontal.i0 + hi];
                        }
                        if (orientation == Diagonal)
                            otherSiblings[c] = 2 * magnitudeOf(plane[(vertical.j0 + j) * pitch + vertical.i0 + i]);
                    }
                    std::int32_t here[kComponents] = {};
                    for (unsigned c = 0; c < kComponents; ++c) {
                        if (empty[c]) continue;
                        const CoefficientContext context = detail::contextOf(models, near, c, orientation, here,
                                                                             farther[c], otherSiblings[c]);
                        const std::size_t index = (band.j0 + j) * pitch + band.i0 + i;
                        here[c] = pick(coder, context, c, index);
                        image.detail[c][index] = here[c];
                        rows[c].row(0)[i] = here[c];
                    }
                }
            }
        }
    }
}

} // namespace gimg::codec

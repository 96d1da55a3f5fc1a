#pragma once

#include "coefficients.h"

namespace gimg::codec {

/// Details along the normal, and along the two tangents, are coded with models of their own.
constexpr unsigned kDirections = 2;
constexpr unsigned kMagnitudeModels = 4;
constexpr unsigned kSignModels = 4;
constexpr unsigned kMagnitudeBits = 3; ///< before the escape

struct SurfaceModels
{
    BitModel levelIsEmpty[kLevels];
    BitModel blockByLevel[kDirections][2][kLevels][7];
    BitModel blockByParents[kDirections][2][7][14];
    BitModel blockByRing[kDirections][2][10][14];
    MixWeights<3> blockWeights[kDirections][2];
    BitModel eachNear[8][8][8][kDirections][kMagnitudeBits];
    BitModel everything[24][kComponents][kMagnitudeBits];
    BitModel bent[14][8][kDirections][kMagnitudeBits];
    BitModel family[10][12][3][kDirections][kMagnitudeBits];
    MixWeights<kMagnitudeModels> byActivity[24][kDirections][kMagnitudeBits];
    MixWeights<kMagnitudeModels> byPlace[kLevels][3][kDirections][kMagnitudeBits];
    ExpGolombModels<kDetailPrefixes> larger[18];
    BitModel signNear[3][3][3][3][3][kDirections];
    BitModel signFamily[3][3][3][3][kDirections];
    BitModel signBent[3][16][kDirections];
    BitModel signParentNear[3][3][3][3][kDirections];
    MixWeights<kSignModels> signWeights[3][kDirections];
    ExpGolombModels<kCoarseBits> coarse;
};

/// Everything coded before that says something about a detail's three components.
struct DetailNeighbourhood
{
    const std::int32_t* near[kComponents];   ///< its own place
    const std::int32_t* parent[kComponents]; ///< its parent's place, nullptr at the coarsest level
    std::size_t pitch, parentPitch;
};

inline std::uint64_t sizeAt(const std::int32_t* q, std::ptrdiff_t offset) { return magnitudeOf(q[offset]); }
/// A sign as 0, 1 or 2.
inline unsigned third(std::int64_t value) { return static_cast<unsigned>(signOf(value) + 1); }

struct DetailContext
{
    BitModel* magnitude[kMagnitudeModels];
    MixWeights<kMagnitudeModels>*byActivity, *byPlace;
    BitModel* sign[kSignModels];
    MixWeights<kSignModels>* signWeights;
    ExpGolombModels<kDetailPrefixes>* larger;
};

inline DetailContext contextOfDetail(SurfaceModels& models, const DetailNeighbourhood& around,
                                     const std::int32_t (&here)[kComponents], unsigned component,
                                     unsigned orientation, unsigned level, double bend)
{
    const std::int32_t* q = around.near[component];
    const auto row = static_cast<std::ptrdiff_t>(around.pitch);
    const unsigned direction = component == 0 ? 0 : 1;
    const std::uint64_t west = sizeAt(q, -2), north = sizeAt(q, -2 * row);
    const std::uint64_t diagonals = sizeAt(q, -2 * row - 2) + sizeAt(q, -2 * row + 2);
    const std::uint64_t farther = sizeAt(q, -4) + sizeAt(q, -4 * row);
    const std::uint64_t near = 2 * (west + north) + diagonals + farther;

    std::uint64_t siblings = 0;
    std::int64_t siblingSign = 0;
    if (orientation == Vertical) {
        siblings = sizeAt(q, -1 - row) + sizeAt(q, 1 - row) + sizeAt(q, row - 1) + sizeAt(q, row + 1);
    } else if (orientation == Diagonal) {
        siblings = sizeAt(q, -row) + sizeAt(q, row) + sizeAt(q, -1) + sizeAt(q, 1);
    }
    siblingSign = orientation == Vertical   ? q[-1 - row] - std::int64_t{q[1 - row]} - q[row - 1] + q[row + 1]
                  : orientation == Diagonal ? std::int64_t{q[-row]} + q[row] + q[-1] + q[1]
                                            : 0;

    std::uint64_t parent = 0, parentNear = 0;
    std::int32_t parentSign = 0;
    if (around.parent[component] != nullptr) {
        const std::int32_t* p = around.parent[component];
        const auto up = static_cast<std::ptrdiff_t>(around.parentPitch);
        parent = sizeAt(p, 0);
        parentSign = *p;
        parentNear = sizeAt(p, -2) + sizeAt(p, 2) + sizeAt(p, -2 * up) + sizeAt(p, 2 * up);
    }
    std::uint64_t others = 0;
    for (unsigned c = 0; c < kComponents; ++c) {
        if (c < component)
            others += 2 * magnitudeOf(here[c]);
        else if (c > component)
            others += (sizeAt(around.near[c], -2) + sizeAt(around.near[c], -2 * row) + 1) / 2;
    }
    const double size = bend < 0 ? -bend : bend;
    const unsigned bent = activityClass(size < 16384.0 ? static_cast<std::uint64_t>(size * 4) : 65536, 13);

    const unsigned a = activityClass(near, 17);
    const unsigned p = activityClass(2 * parent + parentNear, 9), s = activityClass(siblings, 11);
    const unsigned w = activityClass(west, 7), n = activityClass(north, 7), d = activityClass(diagonals, 7);
    const unsigned all = activityClass(2 * near + 3 * others + 2 * parent + parentNear + 2 * siblings, 23);
    DetailContext c;
    c.magnitude[0] = models.eachNear[w][n][d][direction];
    c.magnitude[1] = models.everything[all][component];
    c.magnitude[2] = models.bent[bent][a < 7 ? a : 7][direction];
    c.magnitude[3] = models.family[p][s][orientation][direction];
    c.byActivity = models.byActivity[all][direction];
    c.byPlace = models.byPlace[level][orientation][direction];
    c.larger = &models.larger[a];

    c.sign[0] = &models.signNear[orientation][third(q[-2])][third(q[-2 * row])][third(q[-2 * row - 2])]
                                [third(q[-2 * row + 2])][direction];
    c.sign[1] =
        &models.signFamily[orientation][third(parentSign)][third(siblingSign)][third(q[-2])][direction];
    c.sign[2] = &models.signBent[orientation][2 * (bent < 7 ? bent : 7) + (bend < 0 ? 1u : 0u)][direction];
    c.sign[3] =
        &models.signParentNear[orientation][third(parentSign)][third(q[-4])][third(q[-4 * row])][direction];
    c.signWeights = &models.signWeights[orientation][direction];
    return c;
}

template <class Coder>
std::int32_t codeSurfaceDetail(Coder& coder, const DetailContext& context, std::int32_t value)
{
    const auto isAbove = [&](unsigned step, bool bit) {
        BitModel* models[kMagnitudeModels];
        for (unsigned k = 0; k < kMagnitudeModels; ++k) models[k] = context.magnitude[k] + step;
        return codeMixed(coder, models, context.byActivity[step], context.byPlace[step], bit);
    };
    const auto isNegative = [&](bool bit) {
        return codeMixed(coder, context.sign, *context.signWeights, bit);
    };
    return codeSigned<kMagnitudeBits>(coder, *context.larger, isAbove, isNegative, value);
}

} // namespace gimg::codec

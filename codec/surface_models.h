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

/// What a detail is coded with. Its sign's part is worked out only where there is one.
struct DetailContext
{
    BitModel* magnitude[kMagnitudeModels];
    MixWeights<kMagnitudeModels>*byActivity, *byPlace;
    ExpGolombModels<kDetailPrefixes>* larger;

    SurfaceModels* models;
    const std::int32_t *own, *parent; ///< places of its component; parent: nullptr at the coarsest level
    std::ptrdiff_t row;
    unsigned orientation, direction, bent;
    bool bendsBack;
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
    if (orientation == Vertical)
        siblings = sizeAt(q, -1 - row) + sizeAt(q, 1 - row) + sizeAt(q, row - 1) + sizeAt(q, row + 1);
    else if (orientation == Diagonal)
        siblings = sizeAt(q, -row) + sizeAt(q, row) + sizeAt(q, -1) + sizeAt(q, 1);

    std::uint64_t parent = 0, parentNear = 0;
    if (const std::int32_t* p = around.parent[component]; p != nullptr) {
        const auto up = static_cast<std::ptrdiff_t>(around.parentPitch);
        parent = sizeAt(p, 0);
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
    const unsigned bent = quickClass<13>(size < 16384.0 ? static_cast<std::uint64_t>(size * 4) : 65536);

    const unsigned a = quickClass<17>(near);
    const unsigned p = quickClass<9>(2 * parent + parentNear), s = quickClass<11>(siblings);
    const unsigned w = quickClass<7>(west), n = quickClass<7>(north), d = quickClass<7>(diagonals);
    const unsigned all = quickClass<23>(2 * near + 3 * others + 2 * parent + parentNear + 2 * siblings);
    return {{models.eachNear[w][n][d][direction], models.everything[all][component],
             models.bent[bent][a < 7 ? a : 7][direction], models.family[p][s][orientation][direction]},
            models.byActivity[all][direction],
            models.byPlace[level][orientation][direction],
            &models.larger[a],
            &models,
            q,
            around.parent[component],
            row,
            orientation,
            direction,
            bent,
            bend < 0};
}

template <class Coder> bool codeSurfaceSign(Coder& coder, const DetailContext& context, bool negative)
{
    const std::int32_t* q = context.own;
    const std::ptrdiff_t row = context.row;
    const unsigned o = context.orientation, d = context.direction;
    const std::int64_t siblings = o == Vertical
                                      ? q[-1 - row] - std::int64_t{q[1 - row]} - q[row - 1] + q[row + 1]
                                  : o == Diagonal ? std::int64_t{q[-row]} + q[row] + q[-1] + q[1]
                                                  : 0;
    const unsigned parent = third(context.parent == nullptr ? 0 : *context.parent);
    const unsigned west = third(q[-2]), bent = context.bent < 7 ? context.bent : 7;
    SurfaceModels& models = *context.models;
    BitModel* const mixed[kSignModels] = {
        &models.signNear[o][west][third(q[-2 * row])][third(q[-2 * row - 2])][third(q[-2 * row + 2])][d],
        &models.signFamily[o][parent][third(siblings)][west][d],
        &models.signBent[o][2 * bent + (context.bendsBack ? 1u : 0u)][d],
        &models.signParentNear[o][parent][third(q[-4])][third(q[-4 * row])][d]};
    return codeMixed(coder, mixed, models.signWeights[o][d], negative);
}

template <class Coder>
std::int32_t codeSurfaceDetail(Coder& coder, const DetailContext& context, std::int32_t value)
{
    const auto isAbove = [&](unsigned step, bool bit) {
        BitModel* models[kMagnitudeModels];
        for (unsigned k = 0; k < kMagnitudeModels; ++k) models[k] = context.magnitude[k] + step;
        return codeMixed(coder, models, context.byActivity[step], context.byPlace[step], bit);
    };
    const auto isNegative = [&](bool bit) { return codeSurfaceSign(coder, context, bit); };
    return codeSigned<kMagnitudeBits>(coder, *context.larger, isAbove, isNegative, value);
}

} // namespace gimg::codec

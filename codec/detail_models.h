#pragma once

#include "detail_levels.h"
#include "mixer.h"

namespace gimg::codec {

/// Details along the normal, and along the two tangents, are coded with models of their own.
constexpr unsigned kDirections = 2;
constexpr unsigned kGrowthModels = 4, kRunModels = 3, kSignModels = 3, kBlockModels = 3;
constexpr unsigned kRun = 4;   ///< places in a row of a block whose zeros are told at once
constexpr unsigned kSizes = 4; ///< classes of magnitudes that are refined

/// Models of the bits of details.
struct DetailModels
{
    ExpGolombModels<kCoarseBits> coarse;
    BitModel levelIsEmpty[kLevels];
    BitModel blockByLevel[kDirections][2][kLevels][9];
    BitModel blockByParents[kDirections][2][9][14];
    BitModel blockByRing[kDirections][2][10][14];
    MixWeights<kBlockModels> blockWeights[kDirections][2];

    BitModel lonelyRun[kLevels][3];
    BitModel runFamily[10][14][3];
    BitModel runBelow[8][14];
    BitModel runByLevel[kLevels][3][14];
    MixWeights<kRunModels> runWeights[3];
    BitModel firstOfRun[kRun - 1][6][6];

    BitModel lonely[kLevels][3][kDirections];
    BitModel near[8][8][8][kDirections];
    BitModel everything[24][kComponents][kLevels];
    BitModel family[10][12][3][kDirections];
    BitModel wide[14][12][kDirections];
    MixWeights<kGrowthModels> growthWeights[12][kDirections];

    BitModel next[kSizes][24];

    BitModel signNear[3][3][3][3][3][kDirections];
    BitModel signFamily[3][3][3][3][kDirections];
    BitModel signParentNear[3][3][3][3][kDirections];
    MixWeights<kSignModels> signWeights[3][kDirections];
};

/// A sign as 0, 1 or 2.
inline unsigned third(std::int64_t value) { return static_cast<unsigned>(signOf(value) + 1); }

/// Sums of magnitudes around a detail.
struct Surroundings
{
    unsigned across, along, diagonals, siblings, parents, below, others;

    unsigned near() const { return across + along + (diagonals + 1) / 2; }
    unsigned all() const { return 2 * (near() + others) + parents + siblings + below; }
};

/// Sums of magnitudes around a run of places of which all the band's own neighbours are 0.
struct RunSurroundings
{
    unsigned siblings, parents, below;
};

/// Whether any detail of such a run, all of which were 0 down to the bit before, is not any more.
template <unsigned Orientation, class Coder>
bool codeRunGrowth(Coder& coder, DetailModels& models, unsigned level, const RunSurroundings& s, bool grows)
{
    constexpr unsigned o = Orientation;
    const unsigned sum = 2 * s.parents + s.siblings + s.below;
    if (sum == 0) return coder.bit(models.lonelyRun[level][o], grows);
    BitModel* const mixed[kRunModels] = {
        &models.runFamily[quickClass<9>(s.parents)][quickClass<13>(s.siblings)][o],
        &models.runBelow[quickClass<7>(s.below)][quickClass<13>(s.parents + s.siblings)],
        &models.runByLevel[level][o][quickClass<13>(sum)]};
    return codeMixed(coder, mixed, models.runWeights[o], grows);
}

/// Whether a detail that was 0 down to the bit before is not any more.
template <unsigned Orientation, class Coder>
bool codeGrowth(Coder& coder, DetailModels& models, unsigned level, const Surroundings& s, unsigned component,
                bool grows)
{
    constexpr unsigned o = Orientation;
    const unsigned d = component == 0 ? 0 : 1;
    const unsigned sum = s.all();
    if (sum == 0) return coder.bit(models.lonely[level][o][d], grows);
    const unsigned all = quickClass<23>(sum);
    BitModel* const mixed[kGrowthModels] = {
        &models.near[quickClass<7>(s.across)][quickClass<7>(s.along)][quickClass<7>(s.diagonals)][d],
        &models.everything[all][component][level],
        &models.family[quickClass<9>(s.parents)][quickClass<11>(s.siblings)][o][d],
        &models.wide[quickClass<13>(s.near())][quickClass<11>(2 * s.others + s.below)][d]};
    return codeMixed(coder, mixed, models.growthWeights[all / 2][d], grows);
}

/// The next bit of a detail that is not 0.
/// @param known  its magnitude with a 0 there
template <class Coder>
bool codeNext(Coder& coder, DetailModels& models, const Surroundings& s, unsigned known, bool bit)
{
    const unsigned size = known < 4 ? 0 : known < 8 ? 1 : known < 16 ? 2 : 3;
    return coder.bit(models.next[size][quickClass<23>(s.all())], bit);
}

/// The sign of a detail that has just grown.
/// @param q       its place
/// @param parent  its parent's, nullptr at the coarsest level
template <unsigned Orientation, class Coder>
bool codeDetailSign(Coder& coder, DetailModels& models, std::ptrdiff_t row, const std::int32_t* q,
                    const std::int32_t* parent, unsigned component, bool negative)
{
    constexpr unsigned o = Orientation;
    const unsigned d = component == 0 ? 0 : 1;
    const std::ptrdiff_t two = 2 * row;
    const auto sum = [q](std::ptrdiff_t a, std::ptrdiff_t b) { return third(std::int64_t{q[a]} + q[b]); };
    const std::int64_t siblings = o == Diagonal
                                      ? std::int64_t{q[-row]} + q[row] + q[-1] + q[1]
                                      : q[-row - 1] - std::int64_t{q[-row + 1]} - q[row - 1] + q[row + 1];
    const unsigned up = third(parent == nullptr ? 0 : *parent);
    const unsigned west = third(q[-2]);
    BitModel* const mixed[kSignModels] = {
        &models.signNear[o][west][third(q[2])][third(q[-two])][third(q[two])][d],
        &models.signFamily[o][up][third(siblings)][west][d],
        &models.signParentNear[o][up][sum(-2, 2)][sum(-two, two)][d]};
    return codeMixed(coder, mixed, models.signWeights[o][d], negative);
}

} // namespace gimg::codec

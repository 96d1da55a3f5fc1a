#include "effort.h"

namespace gimg {

namespace {

// Down from `deepest` again and again; the last round is at the step of the whole file.
std::vector<int> inTurn(int rounds, int deepest)
{
    std::vector<int> octaves;
    for (int round = 0; round < rounds; ++round)
        octaves.push_back(round + 1 == rounds ? 0 : deepest - round % (deepest + 1));
    return octaves;
}

// Down once, each octave for as long as the others.
std::vector<int> downOnce(int rounds, int deepest)
{
    std::vector<int> octaves;
    for (int round = 0; round < rounds; ++round)
        octaves.push_back((deepest + 1) * (rounds - 1 - round) / rounds);
    return octaves;
}

// What sliding for prefixes takes from the whole file, refits give back.
constexpr int kRefitsForPrefixes = 2;

} // namespace

Effort Effort::of(const EncodeOptions& options)
{
    struct Row
    {
        int fitRounds, slides, refits;
        double gridWorth;
    };
    static constexpr Row kEfforts[] = {
        {1, 0, 0, 0.5},   // 1
        {3, 1, 0, 0.5},   // 2
        {3, 2, 0, 0.5},   // 3
        {3, 4, 0, 0.5},   // 4
        {3, 7, 0, 0.5},   // 5
        {3, 10, 0, 0.5},  // 6
        {3, 10, 2, 0.25}, // 7
        {3, 10, 4, 0.1},  // 8
        {3, 10, 7, 0},    // 9
    };
    const Row& row = kEfforts[options.effort - 1];
    Effort effort{row.fitRounds, {}, row.refits, row.gridWorth, {}};
    if (row.slides == 0) return effort;
    effort.slides = {{inTurn(row.slides, 0)}};
    if (!options.progressive) return effort;
    // Which care is best depends on the surface.
    const std::vector<double> cares = row.refits > 0 ? std::vector{0.0, 4.0, 6.0} : std::vector{4.0};
    for (const double care : cares)
        effort.slidesForPrefixes.push_back({{inTurn(row.slides + 3, 2), care},
                                            {inTurn(row.slides + 2, 1), care},
                                            {inTurn(row.slides + 5, 3), care},
                                            {downOnce(row.slides + 4, 3), care}});
    if (effort.refits > 0) effort.refits += kRefitsForPrefixes;
    return effort;
}

} // namespace gimg

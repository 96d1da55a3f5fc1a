#pragma once

#include "gimg/encode.h"

#include <vector>

namespace gimg {

/// What EncodeOptions::effort and progressive stand for.
struct Effort
{
    int fitRounds; ///< see FitOptions
    /// Ways to slide, of which the best is taken: octaves by which the steps of the rounds are coarser, see
    /// codec::Encoder::slid. Empty: samples stay where they are.
    std::vector<std::vector<int>> slides;
    int refits;       ///< how often the decoded surface is fitted and slides anew
    double gridWorth; ///< dB by which a finer grid has to be better, where the grid is left open
    bool prefixes;    ///< files are compared by their prefixes, too

    static Effort of(const EncodeOptions& options);
};

} // namespace gimg

#pragma once

#include "codec/encode.h"
#include "gimg/encode.h"

#include <vector>

namespace gimg {

/// What EncodeOptions::effort and progressive stand for.
struct Effort
{
    int fitRounds;                     ///< see FitOptions
    std::vector<codec::Slides> slides; ///< ways to slide, of which the best file is kept; none: samples stay
    int refits;                        ///< how often the decoded surface is fitted and slides anew
    double gridWorth; ///< dB by which a finer grid has to be better, where the grid is left open
    /// Ways to slide where prefixes count too, in sets that are tried each on its own; none: they do not.
    std::vector<std::vector<codec::Slides>> slidesForPrefixes;

    static Effort of(const EncodeOptions& options);
};

} // namespace gimg

#pragma once

#include "gimg/encode.h"

namespace gimg {

/// What EncodeOptions::effort and progressive stand for.
struct Effort
{
    int fitRounds;    ///< see FitOptions
    int slides;       ///< rounds of sliding; 0: samples stay where they are
    int refits;       ///< how often the decoded surface is fitted and slides anew
    double gridWorth; ///< dB by which a finer grid has to be better, where the grid is left open
    double octaves;   ///< see codec::Encoder::slid

    static Effort of(const EncodeOptions& options);
};

} // namespace gimg

#pragma once

namespace gimg {

/// What EncodeOptions::effort stands for.
struct Effort
{
    int fitRounds;    ///< see FitOptions
    int slides;       ///< rounds of sliding; 0: samples stay where they are
    int refits;       ///< how often the decoded surface is fitted and slides anew
    double gridWorth; ///< dB by which a finer grid has to be better, where the grid is left open

    /// @param effort  1 to 9
    static Effort of(int effort);
};

} // namespace gimg

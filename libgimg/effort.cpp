#include "effort.h"

namespace gimg {

Effort Effort::of(const EncodeOptions& options)
{
    constexpr double kEarlyOctaves = 1;
    static constexpr Effort kEfforts[] = {
        {1, 0, 0, 0.5, 0},   // 1
        {3, 1, 0, 0.5, 0},   // 2
        {3, 2, 0, 0.5, 0},   // 3
        {3, 4, 0, 0.5, 0},   // 4
        {3, 7, 0, 0.5, 0},   // 5
        {3, 10, 0, 0.5, 0},  // 6
        {3, 10, 2, 0.25, 0}, // 7
        {3, 10, 4, 0.1, 0},  // 8
        {3, 10, 7, 0, 0},    // 9
    };
    Effort effort = kEfforts[options.effort - 1];
    if (options.progressive) effort.octaves = kEarlyOctaves;
    return effort;
}

} // namespace gimg

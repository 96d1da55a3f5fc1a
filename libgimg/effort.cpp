#include "effort.h"

namespace gimg {

Effort Effort::of(int effort)
{
    static constexpr Effort kEfforts[] = {
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
    return kEfforts[effort - 1];
}

} // namespace gimg

#pragma once

#include <functional>

namespace gimg {

/// Called now and then with the fraction done, in [0,1].
using Progress = std::function<void(double)>;

} // namespace gimg

#pragma once

#include <nlohmann/json_fwd.hpp>

namespace gimg::gimrd {

/// Prints the report of `gimrd bench` as tables on standard output. Returns whether it was written.
bool printBench(const nlohmann::ordered_json& report);

} // namespace gimg::gimrd

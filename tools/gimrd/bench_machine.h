#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>

namespace gimg::gimrd {

/// What figures depend on: processor, cores, memory, system, compiler, and how busy the machine is.
nlohmann::ordered_json describeMachine();

/// Bytes of this process that are in memory now; 0 if the system does not say.
std::int64_t residentBytes();

} // namespace gimg::gimrd

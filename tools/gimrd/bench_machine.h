#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>

namespace gimg::gimrd {

/// What figures depend on: processor, cores, memory, system, compiler, and how busy the machine is.
nlohmann::ordered_json describeMachine();

/// Bytes of this process that are in memory now and of no file; 0 if the system does not say. A program that
/// is started begins with as many counted as its own peak, although they are gone.
std::int64_t ownBytes();

} // namespace gimg::gimrd

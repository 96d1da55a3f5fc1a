#pragma once

#include "gimg/result.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace gimg::cli {

/// How a program ended.
struct Ended
{
    int code = 0;               ///< exit status; 128 + the signal's number where one ended it
    std::string errors;         ///< the last 4,000 bytes of its standard error
    std::int64_t peakBytes = 0; ///< most memory resident at a time
};

/// Runs a program to its end; it reads nothing. `line` gets each line of its standard output as it comes,
/// without the line end. Thread-safe. A program that is still running when this process is killed by SIGKILL
/// ends with it. Errors: FileNotReadable if it cannot be started.
Result<Ended> runProgram(const std::vector<std::string>& command,
                         const std::function<void(const std::string&)>& line);

/// Ends all that runProgram() runs, with what they have started, and lets it start no more. For a thread that
/// is about to end the whole process: runProgram() does not return any more.
void endPrograms();

/// Does not return after endPrograms(): what fails then fails for that reason, and nobody is to hear of it.
void restIfEnding();

} // namespace gimg::cli

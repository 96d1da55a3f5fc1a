#pragma once

#include "../whole_file.h"
#include "arguments.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>

/// A job's record, OUTPUT.json, says what OUTPUT was made from and how, or why it could not be made. It is
/// all that is known of a job, so that machines which share no more than a folder can share a list.
namespace gimg::gimenc {

enum class Standing
{
    Pending, ///< no record, or one of other options or another version, or not of the OUTPUT that is there
    Failed,  ///< the last try of these options failed
    Done,    ///< OUTPUT is there, made with these options
};

/// What a record says, by itself and the size of OUTPUT. The input is not looked at.
struct Recorded
{
    Standing standing = Standing::Pending;
    nlohmann::ordered_json record; ///< null if Pending
};

std::string recordPath(const std::string& output);

Recorded recorded(const Arguments& a);

/// Whether OUTPUT is, to the byte, what a record of these options and this version and this input tells.
bool isFinished(const Arguments& a, const cli::Contents& input);

/// Writes OUTPUT and then its record. Nothing if both are written, otherwise what could not be.
std::optional<std::string> recordDone(const Arguments& a, const cli::Contents& input,
                                      const std::vector<std::uint8_t>& file,
                                      const nlohmann::ordered_json& report);

/// Records that a job failed. An OUTPUT made of something else, which could be taken for the result, is
/// renamed to OUTPUT.old, its record to OUTPUT.old.json. One that another process finished meanwhile, or that
/// is what the options ask for as far as can be told when the input cannot be read, stays with its record.
void recordFailure(const Arguments& a, const std::optional<cli::Contents>& input, const std::string& error);

} // namespace gimg::gimenc

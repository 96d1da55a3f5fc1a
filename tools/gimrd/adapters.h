#pragma once

#include "gimg/result.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace gimg::gimrd {

/// A coder that gimrd can run: a program of the adapters' folder, see bench/adapters/README.md.
struct CoderProgram
{
    std::filesystem::path program;
    std::string name, title, codec;
    bool takesImage = false; ///< a geometry image instead of the mesh
    bool ours = false;
    bool usesGrid = false;
    std::vector<std::string> packages; ///< what it needs
    std::vector<std::string> missing;  ///< what of that is not there; empty: it can run
};

/// Where the adapters are: $GIMRD_ADAPTERS, or else ../libexec/gimg/adapters beside the running program.
std::filesystem::path adapterFolder();

/// All coders of adapterFolder(), ours first, each side by name.
/// @param broken  gets what is wrong with programs there that do not describe themselves or share a name with
///                another; they are then left out. Null: the first of them is an error.
/// Errors: FileNotReadable if the folder cannot be read; CodecFailure.
Result<std::vector<CoderProgram>> findCoders(std::vector<Error>* broken = nullptr);

/// What an adapter made for one size.
struct CodedFile
{
    std::size_t target = 0;
    std::size_t bytes = 0;
    std::filesystem::path file, decoded;
    std::string unreachable; ///< why there is no file; empty if there is one
    nlohmann::ordered_json settings;
};

/// Runs `encode` of the protocol; `done` is called as each size is finished, once for each, with a file whose
/// size has been checked to be `bytes`. Whether that is at most the target is left to the caller.
/// Errors: CodecFailure, with the last line the adapter printed, if it failed or broke the protocol.
Status encodeWith(const CoderProgram& coder, const std::filesystem::path& input,
                  const std::filesystem::path& out, const std::vector<std::size_t>& sizes, int grid,
                  int threads, const std::function<void(const CodedFile&)>& done);

/// Times of coding an input whole, in milliseconds, one a run.
struct CoderTimes
{
    std::size_t bytes = 0; ///< of the file
    std::vector<double> encode, decode;
    std::string note;           ///< what the times include that others do not
    std::int64_t peakBytes = 0; ///< see cli::Ended
};

/// Runs `time` of the protocol. Errors: as encodeWith.
Result<CoderTimes> timeWith(const CoderProgram& coder, const std::filesystem::path& input, std::size_t bytes,
                            int runs);

} // namespace gimg::gimrd

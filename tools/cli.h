#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App; // what builds a command line includes <CLI/App.hpp>; cli.cpp compiles the rest of CLI11
}

/// What the command-line tools share: exit codes, one-line errors, files and JSON.
namespace gimg::cli {

/// What a tool ends with.
enum Exit : int
{
    Done = 0,
    Refused = 1,     ///< the input cannot be read or used, or the output not written
    Usage = 2,       ///< the command line is wrong
    Unreachable = 3, ///< the target asked for cannot be met
};

/// Prints "TOOL: MESSAGE" on standard error and returns `code`, so that main can return fail(...).
int fail(const std::string& tool, Exit code, const std::string& message);

/// Reads the command line into `app`. The tool goes on if nothing is returned; otherwise it ends with
/// what is returned: Done after --help and --version, Usage after printing what is wrong, on one line.
std::optional<int> parse(CLI::App& app, int argc, char** argv);

/// One of `count` equal shares of a list, for as many processes or machines: I, I + N, I + 2N, ... of I/N.
struct Part
{
    std::size_t index = 1; ///< from 1
    std::size_t count = 1;

    /// Whether the entry at `position`, from 0, is in this share; each is in exactly one of the `count`.
    bool has(std::size_t position) const { return position % count == index - 1; }
};

/// Reads "I/N" with 1 <= I <= N; nothing if it is anything else.
std::optional<Part> parsePart(const std::string& text);

/// The bytes of a file; nothing if it cannot be read.
std::optional<std::vector<std::uint8_t>> readFile(const std::string& path);

/// Whether all bytes reached the file.
bool writeFile(const std::string& path, const void* bytes, std::size_t size);

/// Writes a JSON object, indented, to a file or, for "-", to standard output. Returns whether it was written.
bool writeJson(const std::string& path, const nlohmann::ordered_json& object);

/// The last line of what a program printed, without the line end.
std::string lastLine(std::string text);

} // namespace gimg::cli

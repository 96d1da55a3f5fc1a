#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

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
inline int fail(const std::string& tool, Exit code, const std::string& message)
{
    std::cerr << tool << ": " << message << '\n';
    return code;
}

/// Reads the command line into `app`. The tool goes on if nothing is returned; otherwise it ends with
/// what is returned: Done after --help and --version, Usage after printing what is wrong, on one line.
inline std::optional<int> parse(CLI::App& app, int argc, char** argv)
{
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
            app.exit(error);
            return Done;
        }
        return fail(app.get_name(), Usage, std::string(error.what()) + " (try --help)");
    }
    return std::nullopt;
}

/// One of `count` equal shares of a list, for as many processes or machines: I, I + N, I + 2N, ... of I/N.
struct Part
{
    std::size_t index = 1; ///< from 1
    std::size_t count = 1;

    /// Whether the entry at `position`, from 0, is in this share; each is in exactly one of the `count`.
    bool has(std::size_t position) const { return position % count == index - 1; }
};

/// Reads "I/N" with 1 <= I <= N; nothing if it is anything else.
inline std::optional<Part> parsePart(const std::string& text)
{
    Part part;
    const char* const end = text.data() + text.size();
    const auto index = std::from_chars(text.data(), end, part.index);
    if (index.ec != std::errc() || index.ptr == end || *index.ptr != '/') return std::nullopt;
    const auto count = std::from_chars(index.ptr + 1, end, part.count);
    if (count.ec != std::errc() || count.ptr != end || part.index < 1 || part.index > part.count)
        return std::nullopt;
    return part;
}

/// The bytes of a file; nothing if it cannot be read.
inline std::optional<std::vector<std::uint8_t>> readFile(const std::string& path)
{
    std::ifstream in(path, std::ios::binary);
    std::vector<std::uint8_t> bytes;
    char block[1 << 16];
    while (in.read(block, sizeof block) || in.gcount() > 0)
        bytes.insert(bytes.end(), block, block + in.gcount());
    if (!in.eof()) return std::nullopt; // not there, or a folder, or a failing disk
    return bytes;
}

/// Whether all bytes reached the file.
inline bool writeFile(const std::string& path, const void* bytes, std::size_t size)
{
    std::ofstream out(path, std::ios::binary);
    out.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
    out.close();
    return out.good();
}

/// Writes a JSON object, indented, to a file or, for "-", to standard output. Returns whether it was written.
inline bool writeJson(const std::string& path, const nlohmann::ordered_json& object)
{
    const std::string text = object.dump(2) + '\n';
    if (path != "-") return writeFile(path, text.data(), text.size());
    std::cout << text << std::flush;
    return std::cout.good();
}

} // namespace gimg::cli

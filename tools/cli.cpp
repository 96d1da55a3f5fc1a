#include "cli.h"

#include <CLI/CLI.hpp> // here only: seconds, in whatever includes it
#include <nlohmann/json.hpp>

#include <charconv>
#include <fstream>
#include <iostream>
#include <system_error>

namespace gimg::cli {

int fail(const std::string& tool, Exit code, const std::string& message)
{
    std::cerr << tool << ": " << message << '\n';
    return code;
}

std::optional<int> parse(CLI::App& app, int argc, char** argv)
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

std::optional<Part> parsePart(const std::string& text)
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

std::optional<std::vector<std::uint8_t>> readFile(const std::string& path)
{
    std::ifstream in(path, std::ios::binary);
    std::vector<std::uint8_t> bytes;
    char block[1 << 16];
    while (in.read(block, sizeof block) || in.gcount() > 0)
        bytes.insert(bytes.end(), block, block + in.gcount());
    if (!in.eof()) return std::nullopt; // not there, or a folder, or a failing disk
    return bytes;
}

bool writeFile(const std::string& path, const void* bytes, std::size_t size)
{
    std::ofstream out(path, std::ios::binary);
    out.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
    out.close();
    return out.good();
}

bool writeJson(const std::string& path, const nlohmann::ordered_json& object)
{
    const std::string text = object.dump(2) + '\n';
    if (path != "-") return writeFile(path, text.data(), text.size());
    std::cout << text << std::flush;
    return std::cout.good();
}

std::string lastLine(std::string text)
{
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text.substr(text.find_last_of('\n') + 1);
}

} // namespace gimg::cli

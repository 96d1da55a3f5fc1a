#include "bench_text.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

namespace gimg::gimrd {
namespace {

using Json = nlohmann::ordered_json;

std::string text(const Json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

std::string list(const Json& words)
{
    std::string all;
    for (const Json& word : words) {
        if (!all.empty()) all += ' ';
        all += text(word);
    }
    return all;
}

// "gim_positions_ms" reads "gim positions".
std::string label(std::string key)
{
    for (const char* unit : {"_ms", "_bytes"})
        if (key.ends_with(unit)) key.resize(key.size() - std::string(unit).size());
    for (char& c : key)
        if (c == '_') c = ' ';
    return key;
}

std::string milliseconds(const Json& value)
{
    char text[32];
    const double ms = value.get<double>();
    std::snprintf(text, sizeof text, ms < 1000 ? "%.2f" : "%.0f", ms);
    return text;
}

std::string megabytes(const Json& value)
{
    char text[32];
    if (!value.is_number()) return "?";
    std::snprintf(text, sizeof text, "%.1f", value.get<double>() / 1e6);
    return text;
}

void printSpread(const Json& report, const char* section, const char* title)
{
    if (!report["spread"].contains(section)) return;
    std::printf("\n%-28s %10s %10s %10s %6s\n", title, "median", "min", "max", "runs");
    for (const auto& [key, s] : report["spread"][section].items())
        std::printf("  %-26s %10s %10s %10s %6s\n", label(key).c_str(), milliseconds(s["median"]).c_str(),
                    milliseconds(s["min"]).c_str(), milliseconds(s["max"]).c_str(), text(s["runs"]).c_str());
}

void printMemory(const Json& report)
{
    std::printf("\nmemory, MB\n");
    for (const auto& [key, value] : report["memory"].items()) {
        std::printf("  %-26s %10s\n", label(key).c_str(), megabytes(value).c_str());
    }
}

std::string cell(const std::string& key, const Json& step)
{
    if (!step.contains(key)) return "-";
    if (key.ends_with("_ms")) return milliseconds(step[key]);
    if (key.ends_with("_bytes")) return megabytes(step[key]);
    return text(step[key]);
}

// Adds a cell to each line, right-aligned and two spaces from the one before.
void appendColumn(std::vector<std::string>& lines, const std::vector<std::string>& cells)
{
    size_t width = 0;
    for (const std::string& text : cells) width = std::max(width, text.size());
    for (size_t k = 0; k < cells.size(); ++k)
        lines[k] += std::string(2 + width - cells[k].size(), ' ') + cells[k];
}

// A line for each step, a column for each number that any step has.
void printSteps(const Json& steps, const char* title)
{
    if (steps.empty()) return;
    std::vector<std::string> columns;
    for (const Json& step : steps)
        for (const auto& [key, value] : step.items())
            if (key != "failed" && std::find(columns.begin(), columns.end(), key) == columns.end())
                columns.push_back(key);
    std::printf("\n%s\n", title);
    std::vector<std::string> lines(steps.size() + 1);
    for (const std::string& column : columns) {
        std::vector<std::string> cells = {label(column)};
        for (const Json& step : steps) cells.push_back(cell(column, step));
        appendColumn(lines, cells);
    }
    for (size_t k = 0; k < lines.size(); ++k) {
        const bool broken = k > 0 && steps[k - 1].contains("failed");
        std::printf("%s%s\n", lines[k].c_str(), broken ? "  failed" : "");
    }
}

} // namespace

bool printBench(const Json& report)
{
    const Json &machine = report["machine"], &gim = report["gim"];
    std::printf("%s, %s cores, %.1f GB, %s, %s, load %s\n", text(machine["cpu"]).c_str(),
                text(machine["cores"]).c_str(), machine["memory"].get<double>() / 1e9,
                text(machine["os"]).c_str(), text(machine["compiler"]).c_str(),
                text(machine["load"]).c_str());
    std::printf("%s: %s faces -> %s bytes, %s x %s samples, %s triangles",
                text(report["mesh"]["name"]).c_str(), text(report["mesh"]["faces"]).c_str(),
                text(gim["bytes"]).c_str(), text(gim["grid"]).c_str(), text(gim["grid"]).c_str(),
                text(gim["triangles"]).c_str());
    if (gim["psnr"].is_number()) std::printf(", PSNR %.2f dB", gim["psnr"].get<double>());
    std::printf("\n");

    printSpread(report, "decode", "decode, ms, one thread");
    printSpread(report, "decode_mesh", "decode the whole mesh, ms");
    printSpread(report, "encode", "encode, ms, one thread");
    printSpread(report, "gim_stages_ms", "stages of gim, ms");
    printMemory(report);
    printSteps(report["scaling"], "the mesh with more faces, ms and MB");
    printSteps(report["decode_scaling"], "decoding larger grids, ms");
    for (const Json& peer : report["peers"])
        if (peer.contains("note"))
            std::printf("%s: %s\n", text(peer["codec"]).c_str(), text(peer["note"]).c_str());
    for (const Json& peer : report["skipped"])
        std::printf("%s: skipped, not installed: %s\n", text(peer["name"]).c_str(),
                    list(peer["missing"]).c_str());
    for (const Json& failure : report["failed"])
        std::printf("%s: failed: %s\n", text(failure["section"]).c_str(), text(failure["message"]).c_str());
    return std::fflush(stdout) == 0;
}

} // namespace gimg::gimrd

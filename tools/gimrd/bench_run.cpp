#include "bench_run.h"

#include "bench_machine.h"

#include "../cli.h"
#include "../process.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <sstream>

namespace gimg::gimrd {

namespace {

double medianOf(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    const size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

// See ownBytes(): a peak not above that says nothing.
Json peakOf(std::int64_t peakBytes, std::int64_t ownBefore)
{
    return peakBytes > ownBefore ? Json(peakBytes) : Json(nullptr);
}

std::string messageOf(const cli::Ended& ended)
{
    std::istringstream lines(ended.errors);
    std::string last;
    for (std::string line; std::getline(lines, line);)
        if (!line.empty()) last = line;
    return last.empty() ? "ended with status " + std::to_string(ended.code) : last;
}

} // namespace

void progress(const std::string& what)
{
    if (::isatty(STDERR_FILENO) == 1) std::fprintf(stderr, "\r\033[K%s", what.c_str());
}

void recordFailure(Bench& bench, const std::string& section, const std::string& message)
{
    progress("");
    std::cerr << "gimrd: " << section << ": " << message << '\n';
    bench.json["failed"].push_back({{"section", section}, {"message", message}});
}

void record(Bench& bench, const std::string& section, const std::string& key, double milliseconds)
{
    bench.times[section][key].push_back(milliseconds);
}

Json medians(Bench& bench, const std::string& section)
{
    Json result = Json::object();
    if (!bench.times.contains(section)) return result;
    for (const auto& [key, list] : bench.times[section].items()) {
        const auto values = list.get<std::vector<double>>();
        const double median = medianOf(values);
        result[key] = median;
        bench.json["spread"][section][key] = {{"min", *std::min_element(values.begin(), values.end())},
                                              {"median", median},
                                              {"max", *std::max_element(values.begin(), values.end())},
                                              {"runs", values.size()}};
    }
    return result;
}

void raise(Json& peak, const Json& candidate)
{
    if (peak.is_null() || (candidate.is_number() && candidate > peak)) peak = candidate;
}

Result<ToolRun> runTool(const std::string& name, std::vector<std::string> arguments)
{
    std::error_code failed;
    const Path self = std::filesystem::read_symlink("/proc/self/exe", failed);
    arguments.insert(arguments.begin(), (self.parent_path() / name).string());
    std::string out;
    const std::int64_t own = ownBytes();
    const Result<cli::Ended> ended =
        cli::runProgram(arguments, [&](const std::string& line) { out += line; });
    if (!ended) return ended.error();
    if (ended->code != 0) {
        const bool unreachable = ended->code == cli::Unreachable;
        return Error{unreachable ? ErrorKind::TargetUnreachable : ErrorKind::CodecFailure, messageOf(*ended)};
    }
    ToolRun run{Json::parse(out, nullptr, false), peakOf(ended->peakBytes, own)};
    return run;
}

Result<ToolRun> gimenc(const EncodeRequest& request)
{
    std::vector<std::string> arguments = {"--quiet", "--json", "-", "--grid", std::to_string(request.grid)};
    arguments.insert(arguments.end(), request.target.begin(), request.target.end());
    if (request.threads > 0)
        arguments.insert(arguments.end(), {"--threads", std::to_string(request.threads)});
    if (request.normals > 0)
        arguments.insert(arguments.end(), {"--normals", std::to_string(request.normals)});
    arguments.insert(arguments.end(), {request.mesh.string(), request.out.string()});
    Result<ToolRun> run = runTool("gimenc", arguments);
    if (run && !run->report.is_object()) return Error{ErrorKind::CodecFailure, "gimenc printed no JSON"};
    return run;
}

double encodeMilliseconds(const ToolRun& run)
{
    const Json& seconds = run.report.at("seconds");
    return 1000 * (seconds.at("total").get<double>() - seconds.at("read").get<double>());
}

EncodeRequest encodeRequest(const Bench& bench, const std::string& out)
{
    return {bench.options.mesh, bench.folder / out, {"--bytes", std::to_string(bench.options.bytes)},
            bench.options.grid, /*threads=*/1,      bench.options.normals};
}

Result<GimDecoder> openFile(const Path& path)
{
    std::optional<std::vector<std::uint8_t>> bytes = cli::readFile(path.string());
    if (!bytes) return Error{ErrorKind::FileNotReadable, path.string() + ": cannot be read"};
    return GimDecoder::open(std::move(*bytes));
}

Status timeGim(Bench& bench, GimDecoder& decoder, int runs, const std::string& section)
{
    for (int k = 0; k <= runs; ++k) {
        const Result<DecodeTimes> times = decoder.run();
        if (!times) return times.error();
        if (k == 0) continue;
        record(bench, section, "gim_ms", times->all);
        record(bench, section, "gim_positions_ms", times->positions);
        record(bench, section, "gim_samples_ms", times->samples);
    }
    return Done{};
}

std::optional<PeerRun> timePeer(Bench& bench, const CoderProgram& peer, const Path& input, int runs,
                                const std::string& section)
{
    if (bench.broken.contains(section + ' ' + peer.name)) return std::nullopt;
    progress(section + ": " + peer.title);
    const std::int64_t own = ownBytes();
    Result<CoderTimes> times = timeWith(peer, input, bench.options.bytes, runs + 1);
    if (!times) {
        bench.broken.insert(section + ' ' + peer.name);
        recordFailure(bench, section, times.error().message);
        return std::nullopt;
    }
    times->encode.erase(times->encode.begin());
    times->decode.erase(times->decode.begin());
    return PeerRun{*times, peakOf(times->peakBytes, own)};
}

void recordAll(Bench& bench, const std::string& section, const std::string& key,
               const std::vector<double>& times)
{
    for (const double time : times) record(bench, section, key, time);
}

void describeFile(Bench& bench, const CoderProgram& peer, const std::string& what, const CoderTimes& times)
{
    for (Json& entry : bench.json["peers"]) {
        if (entry["name"] != peer.name) continue;
        entry[what] = times.bytes;
        if (!times.note.empty()) entry["note"] = times.note;
    }
}

} // namespace gimg::gimrd

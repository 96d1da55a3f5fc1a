#pragma once

#include "adapters.h"
#include "bench_decode.h"

#include "gimg/result.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace gimg::gimrd {

using Json = nlohmann::ordered_json;
using Path = std::filesystem::path;

struct BenchOptions
{
    std::string mesh, json;
    std::string peers = "all", scaling = "1,4,16", grids = "129,257,513,1025";
    size_t bytes = 12288;
    int grid = 257;
    int normals = 0;
    int runs = 11;
};

/// Rounds in which coders take turns, so that a machine that is busy for a while is so for all of them.
constexpr int kRounds = 3;
/// Above this many triangles few runs are enough, and one encoding.
constexpr std::int64_t kLarge = 400000;
constexpr int kLargeRuns = 3;

struct Bench
{
    BenchOptions options;
    std::vector<int> factors, grids;
    Path folder;                     ///< for files, gone at the end
    std::vector<CoderProgram> peers; ///< that can run
    std::set<std::string> broken;    ///< "SECTION PEER" of those that failed
    Json times = Json::object();     ///< by section and key, lists of milliseconds
    Json json;                       ///< the report
};

void progress(const std::string& what);
void recordFailure(Bench& bench, const std::string& section, const std::string& message);
void record(Bench& bench, const std::string& section, const std::string& key, double milliseconds);
void recordAll(Bench& bench, const std::string& section, const std::string& key,
               const std::vector<double>& times);

/// The medians of a section, and its spread into the report.
Json medians(Bench& bench, const std::string& section);

/// The larger of what was there and what is new.
void raise(Json& peak, const Json& candidate);

/// What is known of a peer's files, into the report.
void describeFile(Bench& bench, const CoderProgram& peer, const std::string& what, const CoderTimes& times);

struct ToolRun
{
    Json report;
    Json peak;
};

/// Runs a program of gimg that stands beside this one; what it prints is JSON or nothing.
Result<ToolRun> runTool(const std::string& name, std::vector<std::string> arguments);

struct EncodeRequest
{
    Path mesh, out;
    std::vector<std::string> target;
    int grid = 0;
    int threads = 0; ///< 0: one a core
    int normals = 0;
};

EncodeRequest encodeRequest(const Bench& bench, const std::string& out);
Result<ToolRun> gimenc(const EncodeRequest& request);

/// From the mesh in memory to the file in memory.
double encodeMilliseconds(const ToolRun& run);

Result<GimDecoder> openFile(const Path& path);

/// The first run only warms up.
Status timeGim(Bench& bench, GimDecoder& decoder, int runs, const std::string& section);

struct PeerRun
{
    CoderTimes times; ///< without the first run of each, which only warms up
    Json peak;
};

/// Times a peer; if it fails, that is recorded once and the peer skipped for the rest of the section.
std::optional<PeerRun> timePeer(Bench& bench, const CoderProgram& peer, const Path& input, int runs,
                                const std::string& section);

} // namespace gimg::gimrd

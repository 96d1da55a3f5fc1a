// gimrd bench: speed, memory and scaling of gimg and its peers, in one run.
#include "../process.h"
#include "adapters.h"
#include "bench_decode.h"
#include "bench_machine.h"
#include "bench_text.h"
#include "command.h"
#include "subdivide.h"

#include "../cli.h"

#include "gimg/decode.h"
#include "gimg/mesh_io.h"

#include <CLI/App.hpp>
#include <nlohmann/json.hpp>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <set>
#include <sstream>

namespace gimg::gimrd {
namespace {

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

// Rounds in which coders take turns, so that a machine that is busy for a while is so for all of them.
constexpr int kRounds = 3;
// Above this many triangles few runs are enough, and one encoding.
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

// A folder of its own in the system's place for such, removed at the end.
class TemporaryFolder
{
public:
    TemporaryFolder()
    {
        std::error_code failed;
        std::string pattern = (std::filesystem::temp_directory_path(failed) / "gimrd-XXXXXX").string();
        if (!failed && ::mkdtemp(pattern.data()) != nullptr) path_ = pattern;
    }
    ~TemporaryFolder()
    {
        std::error_code ignored;
        if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const Path& path() const { return path_; } ///< empty if there is none

private:
    Path path_;
};

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

double medianOf(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    const size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

// The medians of a section, and its spread into the report.
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

// See ownBytes(): a peak not above that says nothing.
Json peakOf(std::int64_t peakBytes, std::int64_t ownBefore)
{
    return peakBytes > ownBefore ? Json(peakBytes) : Json(nullptr);
}

// The larger of what was there and what is new.
void raise(Json& peak, const Json& candidate)
{
    if (peak.is_null() || (candidate.is_number() && candidate > peak)) peak = candidate;
}

struct ToolRun
{
    Json report;
    Json peak;
};

std::string messageOf(const cli::Ended& ended)
{
    std::istringstream lines(ended.errors);
    std::string last;
    for (std::string line; std::getline(lines, line);)
        if (!line.empty()) last = line;
    return last.empty() ? "ended with status " + std::to_string(ended.code) : last;
}

// Runs a program of gimg that stands beside this one; what it prints is JSON or nothing.
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

struct EncodeRequest
{
    Path mesh, out;
    std::vector<std::string> target;
    int grid = 0;
    int threads = 0; ///< 0: one a core
    int normals = 0;
};

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

// From the mesh in memory to the file in memory.
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

// The first run only warms up.
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

struct PeerRun
{
    CoderTimes times; ///< without the first run of each, which only warms up
    Json peak;
};

// Times a peer; if it fails, that is recorded once and the peer skipped for the rest of the section.
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

// What is known of a peer's files, into the report.
void describeFile(Bench& bench, const CoderProgram& peer, const std::string& what, const CoderTimes& times)
{
    for (Json& entry : bench.json["peers"]) {
        if (entry["name"] != peer.name) continue;
        entry[what] = times.bytes;
        if (!times.note.empty()) entry["note"] = times.note;
    }
}

// Runs of round `round` when `runs` are spread over all rounds.
int runsOf(int runs, int round) { return runs / kRounds + (round < runs % kRounds ? 1 : 0); }

// The mesh after repair, as adapters read it.
Status writeInput(const Bench& bench)
{
    const Result<MeshFile> file = readMesh(bench.options.mesh);
    if (!file) return file.error();
    return writeMesh(file->mesh, (bench.folder / "input.ply").string());
}

// gimg from the mesh to the file; mesh coders on the same mesh, whole.
Status measureEncoding(Bench& bench)
{
    Json& memory = bench.json["memory"];
    for (int round = 0; round < kRounds; ++round) {
        const int runs = runsOf(bench.options.runs, round);
        if (runs == 0) break;
        progress("encode: gimg");
        EncodeRequest request = encodeRequest(bench, "mesh.gim");
        const Result<ToolRun> single = gimenc(request);
        if (!single) return single.error();
        record(bench, "encode", "gim_ms", encodeMilliseconds(*single));
        for (const char* stage : {"cut", "parameterize", "sample", "code"})
            record(bench, "gim_stages_ms", stage, 1000 * single->report["seconds"][stage].get<double>());
        bench.json["mesh"]["faces"] = single->report["faces"];
        bench.json["gim"]["psnr"] = single->report["psnr"];

        request.threads = 0;
        const Result<ToolRun> every = gimenc(request);
        if (!every) return every.error();
        record(bench, "encode", "gim_all_cores_ms", encodeMilliseconds(*every));
        raise(memory["gim_encode_bytes"], every->peak);

        for (const CoderProgram& peer : bench.peers) {
            if (peer.takesImage) continue;
            const auto run = timePeer(bench, peer, bench.folder / "input.ply", runs, "encode");
            if (!run) continue;
            recordAll(bench, "encode", peer.codec + "_ms", run->times.encode);
            recordAll(bench, "decode_mesh", peer.codec + "_ms", run->times.decode);
            raise(memory[peer.codec + "_process_bytes"], run->peak);
            describeFile(bench, peer, "mesh_bytes", run->times);
        }
    }
    return Done{};
}

Status measureDecoderMemory(Bench& bench)
{
    const Result<ToolRun> run =
        runTool("gimdec", {(bench.folder / "mesh.gim").string(), (bench.folder / "mesh.ply").string()});
    if (!run) return run.error();
    bench.json["memory"]["gim_decode_bytes"] = run->peak;
    return Done{};
}

// The geometry image before compression, planar little-endian floats, as image coders take it.
Status writeImage(const Bench& bench, const Path& out)
{
    EncodeRequest request = encodeRequest(bench, "image.gim");
    request.target = {"--raw", "float"};
    request.normals = 0;
    request.threads = 0;
    const Result<ToolRun> run = gimenc(request);
    if (!run) return run.error();
    const std::optional<std::vector<std::uint8_t>> bytes = cli::readFile(request.out.string());
    if (!bytes) return Error{ErrorKind::FileNotReadable, request.out.string() + ": cannot be read"};
    const Result<DecodedImages> images = decodeImages(*bytes);
    if (!images) return images.error();
    return writeF32(images->geometry, out.string());
}

bool anyPeer(const Bench& bench, bool takesImage)
{
    return std::any_of(bench.peers.begin(), bench.peers.end(),
                       [&](const CoderProgram& peer) { return peer.takesImage == takesImage; });
}

// gimg and mesh coders on the mesh that the file decodes to.
Status decodeSideBySide(Bench& bench, GimDecoder& decoder, const Path& mesh, int allRuns,
                        const std::string& section)
{
    for (int round = 0; round < kRounds; ++round) {
        const int runs = runsOf(allRuns, round);
        if (runs == 0) break;
        progress(section + ": gimg");
        if (const Status timed = timeGim(bench, decoder, runs, section); !timed) return timed;
        for (const CoderProgram& peer : bench.peers) {
            if (peer.takesImage) continue;
            const auto run = timePeer(bench, peer, mesh, runs, section);
            if (!run) continue;
            recordAll(bench, section, peer.codec + "_ms", run->times.decode);
            if (section == "decode") describeFile(bench, peer, "equal_mesh_bytes", run->times);
        }
    }
    return Done{};
}

// Image coders, on the geometry image that gimg compressed.
Status timeImageCoders(Bench& bench)
{
    if (!anyPeer(bench, true)) return Done{};
    const Path image = bench.folder / "image.f32";
    progress("decode: geometry image");
    if (const Status written = writeImage(bench, image); !written) return written;
    for (int round = 0; round < kRounds; ++round) {
        const int runs = runsOf(bench.options.runs, round);
        if (runs == 0) break;
        for (const CoderProgram& peer : bench.peers) {
            if (!peer.takesImage) continue;
            const auto run = timePeer(bench, peer, image, runs, "decode");
            if (!run) continue;
            recordAll(bench, "decode", peer.codec + "_ms", run->times.decode);
            recordAll(bench, "encode", peer.codec + "_ms", run->times.encode);
            describeFile(bench, peer, "image_bytes", run->times);
        }
    }
    return Done{};
}

Status writeDecoded(GimDecoder& decoder, const Path& out)
{
    if (const Result<DecodeTimes> decoded = decoder.run(); !decoded) return decoded.error();
    return writeMesh(decoder.mesh(), out.string());
}

Status measureDecoding(Bench& bench)
{
    Result<GimDecoder> decoder = openFile(bench.folder / "mesh.gim");
    if (!decoder) return decoder.error();
    const Path mesh = bench.folder / "equal.ply";
    if (const Status written = writeDecoded(*decoder, mesh); !written) return written;
    Json& gim = bench.json["gim"];
    gim["bytes"] = std::filesystem::file_size(bench.folder / "mesh.gim");
    gim["grid"] = decoder->info().grid;
    gim["normal_grid"] = decoder->info().normal_grid;
    gim["vertices"] = decoder->counts().vertices;
    gim["triangles"] = decoder->counts().triangles;
    bench.json["memory"]["gim_decode_output_bytes"] = decoder->outputBytes();
    bench.json["memory"]["gim_workspace_bytes"] = gim_workspace_size(&decoder->info());
    const Status timed = decodeSideBySide(bench, *decoder, mesh, bench.options.runs, "decode");
    return timed ? timeImageCoders(bench) : timed;
}

// The mesh itself was measured already.
void takeScalingOfMesh(Bench& bench, Json& step)
{
    const Json encode = medians(bench, "encode"), decodeMesh = medians(bench, "decode_mesh");
    step["faces"] = bench.json["mesh"]["faces"];
    step["encode_ms"] = encode.at("gim_ms");
    step["encode_peak_bytes"] = bench.json["memory"]["gim_encode_bytes"];
    step["decode_ms"] = medians(bench, "decode").at("gim_ms");
    for (const auto& [key, value] : decodeMesh.items()) {
        const std::string codec = key.substr(0, key.size() - 3);
        step[codec + "_encode_ms"] = encode.at(key);
        step[codec + "_decode_ms"] = value;
    }
}

Status writeSubdivided(const std::string& mesh, int factor, const Path& out)
{
    Result<MeshFile> file = readMesh(mesh);
    if (!file) return file.error();
    for (int f = factor; f > 1; f /= 4) file->mesh = subdivide(file->mesh);
    return writeMesh(file->mesh, out.string());
}

Status measureSubdivided(Bench& bench, int factor, Json& step)
{
    const std::string section = "scaling x" + std::to_string(factor);
    const Path mesh = bench.folder / "scaled.ply";
    progress(section + ": gimg");
    if (const Status written = writeSubdivided(bench.options.mesh, factor, mesh); !written) return written;
    EncodeRequest request = encodeRequest(bench, "scaled.gim");
    request.mesh = mesh;
    const Result<ToolRun> run = gimenc(request);
    if (!run) return run.error();
    step["faces"] = run->report.at("faces");
    step["encode_ms"] = encodeMilliseconds(*run);
    step["encode_peak_bytes"] = run->peak;
    Result<GimDecoder> decoder = openFile(request.out);
    if (!decoder) return decoder.error();
    const Status timed = timeGim(bench, *decoder, std::min(bench.options.runs, kLargeRuns), section);
    if (!timed) return timed;
    step["decode_ms"] = medians(bench, section).at("gim_ms");
    for (const CoderProgram& peer : bench.peers) {
        if (peer.takesImage) continue;
        const auto peerRun = timePeer(bench, peer, mesh, 1, section);
        if (!peerRun) continue;
        step[peer.codec + "_encode_ms"] = peerRun->times.encode[0];
        step[peer.codec + "_decode_ms"] = peerRun->times.decode[0];
    }
    return Done{};
}

void measureScaling(Bench& bench)
{
    for (const int factor : bench.factors) {
        Json step = {{"factor", factor}};
        if (factor == 1) {
            takeScalingOfMesh(bench, step);
        } else if (const Status measured = measureSubdivided(bench, factor, step); !measured) {
            step["failed"] = measured.error().message;
            recordFailure(bench, "scaling x" + std::to_string(factor), measured.error().message);
        }
        bench.json["scaling"].push_back(step);
    }
}

// The same bits a sample at every size.
size_t bytesAt(const BenchOptions& options, int grid)
{
    const double cells = std::pow(double(grid - 1) / (options.grid - 1), 2);
    return static_cast<size_t>(std::lround(static_cast<double>(options.bytes) * cells));
}

Status measureGrid(Bench& bench, int grid, const std::string& section, Json& step)
{
    progress(section + ": gimg");
    EncodeRequest request = encodeRequest(bench, "grid.gim");
    request.grid = grid;
    request.threads = 0;
    request.target = {"--bytes", std::to_string(bytesAt(bench.options, grid))};
    const Result<ToolRun> run = gimenc(request);
    if (!run) return run.error();
    Result<GimDecoder> decoder = openFile(request.out);
    if (!decoder) return decoder.error();
    const Path mesh = bench.folder / "grid.ply";
    if (const Status written = writeDecoded(*decoder, mesh); !written) return written;
    step["triangles"] = decoder->counts().triangles;
    step["bytes"] = run->report.at("bytes").at("total");
    const bool large = decoder->counts().triangles > kLarge;
    const int runs = large ? std::min(bench.options.runs, kLargeRuns) : bench.options.runs;
    return decodeSideBySide(bench, *decoder, mesh, runs, section);
}

void measureDecodeScaling(Bench& bench)
{
    for (const int grid : bench.grids) {
        std::string section = "decode scaling " + std::to_string(grid);
        Json step = {{"grid", grid}};
        Status measured = Done{};
        if (grid == bench.options.grid) { // measured already
            section = "decode";
            step["triangles"] = bench.json["gim"]["triangles"];
            step["bytes"] = bench.json["gim"]["bytes"];
        } else {
            measured = measureGrid(bench, grid, section, step);
        }
        const Json times = medians(bench, section);
        for (const auto& [key, value] : times.items()) {
            const bool image = std::any_of(bench.peers.begin(), bench.peers.end(), [&](const auto& peer) {
                return peer.takesImage && peer.codec + "_ms" == key;
            });
            if (!image) step[key] = value;
        }
        if (!measured) {
            step["failed"] = measured.error().message;
            recordFailure(bench, section, measured.error().message);
        }
        bench.json["decode_scaling"].push_back(step);
    }
}

std::optional<std::vector<std::string>> words(const std::string& list)
{
    std::vector<std::string> result;
    if (list == "none") return result;
    std::istringstream in(list);
    for (std::string word; std::getline(in, word, ',');) result.push_back(word);
    if (result.empty()) return std::nullopt;
    return result;
}

// A list of whole numbers that pass the test, or "none".
template <class Test> std::optional<std::vector<int>> numbers(const std::string& list, Test allowed)
{
    const auto parts = words(list);
    if (!parts) return std::nullopt;
    std::vector<int> result;
    for (const std::string& part : *parts) {
        if (part.empty() || part.size() > 6 || part.find_first_not_of("0123456789") != std::string::npos)
            return std::nullopt;
        result.push_back(std::stoi(part));
        if (!allowed(result.back())) return std::nullopt;
    }
    return result;
}

bool isPowerOfFour(int n)
{
    while (n > 1 && n % 4 == 0) n /= 4;
    return n == 1;
}

bool isGrid(int n) { return n >= 3 && n <= 4097 && ((n - 1) & (n - 2)) == 0; }

// Chooses one coder for each codec; notes what is missing.
// Errors: BadArgument for a name that is none.
Status choosePeers(Bench& bench)
{
    bench.json["peers"] = Json::array();
    bench.json["skipped"] = Json::array();
    const auto wanted = words(bench.options.peers);
    if (!wanted) return Error{ErrorKind::BadArgument, "--peers: give names, all or none"};
    if (wanted->empty()) return Done{};
    const bool all = bench.options.peers == "all";
    const Result<std::vector<CoderProgram>> coders = findCoders();
    if (!coders) return coders.error();
    const auto names = [](const CoderProgram& coder, const std::string& word) {
        return !coder.ours && (word == coder.name || word == coder.codec);
    };
    for (const std::string& word : *wanted)
        if (!all && std::none_of(coders->begin(), coders->end(),
                                 [&](const CoderProgram& coder) { return names(coder, word); }))
            return Error{ErrorKind::BadArgument, "--peers: there is no peer " + word};

    std::set<std::string> chosen;
    for (const CoderProgram& coder : *coders) {
        const bool asked = std::any_of(wanted->begin(), wanted->end(),
                                       [&](const std::string& word) { return names(coder, word); });
        if (coder.ours || !(all || asked) || !coder.missing.empty()) continue;
        if (!chosen.insert(coder.codec).second) continue; // another one of the same codec
        bench.json["peers"].push_back({{"name", coder.name},
                                       {"title", coder.title},
                                       {"codec", coder.codec},
                                       {"input", coder.takesImage ? "image" : "mesh"}});
        bench.peers.push_back(coder);
    }
    for (const CoderProgram& coder : *coders) {
        if (coder.ours || coder.missing.empty() || !chosen.insert(coder.codec).second) continue;
        if (!all && std::none_of(wanted->begin(), wanted->end(),
                                 [&](const std::string& word) { return names(coder, word); }))
            continue;
        bench.json["skipped"].push_back({{"name", coder.name},
                                         {"title", coder.title},
                                         {"codec", coder.codec},
                                         {"missing", coder.missing}});
        std::string note = "gimrd: " + coder.name + " skipped, not installed:";
        for (const std::string& package : coder.missing) note += ' ' + package;
        std::cerr << note << '\n';
    }
    return Done{};
}

Status measureAll(Bench& bench)
{
    // What needs this process to be small comes first, see peakOf().
    Status done = writeInput(bench);
    if (done) done = measureEncoding(bench);
    if (done) done = measureDecoderMemory(bench);
    if (done) done = measureDecoding(bench);
    if (!done) return done;
    measureScaling(bench);
    measureDecodeScaling(bench);
    bench.json["decode"] = medians(bench, "decode");
    bench.json["decode_mesh"] = medians(bench, "decode_mesh");
    bench.json["encode"] = medians(bench, "encode");
    bench.json["gim_stages_ms"] = medians(bench, "gim_stages_ms");
    return Done{};
}

// The report's members in the order in which they are read.
void layOut(Bench& bench)
{
    bench.json["machine"] = describeMachine();
    bench.json["mesh"]["name"] = Path(bench.options.mesh).filename().string();
    for (const char* object : {"gim", "decode", "decode_mesh", "encode", "gim_stages_ms", "memory"})
        bench.json[object] = Json::object();
    for (const char* list : {"scaling", "decode_scaling"}) bench.json[list] = Json::array();
    bench.json["spread"] = Json::object();
    bench.json["failed"] = Json::array();
}

cli::Exit exitFor(ErrorKind kind)
{
    if (kind == ErrorKind::TargetUnreachable) return cli::Unreachable;
    return kind == ErrorKind::BadArgument ? cli::Usage : cli::Refused;
}

int run(const BenchOptions& options)
{
    Bench bench;
    bench.options = options;
    const auto factors = numbers(options.scaling, isPowerOfFour);
    if (!factors) return cli::fail("gimrd", cli::Usage, "--scaling: give powers of 4, as in 1,4,16, or none");
    const auto grids = numbers(options.grids, isGrid);
    if (!grids) return cli::fail("gimrd", cli::Usage, "--grids: give 2^j + 1 from 3 to 4097, or none");
    bench.factors = *factors;
    bench.grids = *grids;
    const TemporaryFolder folder;
    if (folder.path().empty()) return cli::fail("gimrd", cli::Refused, "no folder for temporary files");
    bench.folder = folder.path();

    layOut(bench);
    Status done = choosePeers(bench);
    if (done) done = measureAll(bench);
    progress("");
    if (!done) return cli::fail("gimrd", exitFor(done.error().kind), done.error().message);
    if (!options.json.empty() && !cli::writeJson(options.json, bench.json))
        return cli::fail("gimrd", cli::Refused, options.json + ": cannot be written");
    if (options.json != "-" && !printBench(bench.json))
        return cli::fail("gimrd", cli::Refused, "cannot write the result");
    return bench.json["failed"].empty() ? cli::Done : cli::Refused;
}

} // namespace

Command addBench(CLI::App& app)
{
    const auto options = std::make_shared<BenchOptions>();
    CLI::App* sub = app.add_subcommand("bench", "Speed, memory and scaling, beside other coders");
    sub->add_option("--mesh", options->mesh, "Mesh to code (.obj, .ply, .off, .stl)")->required();
    sub->add_option("--json", options->json, "Write the report to this file, or - for standard output");
    sub->add_option("--bytes", options->bytes, "Size of the file, and of the image coders' files")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    sub->add_option("--grid", options->grid, "Samples a side, 2^j + 1")
        ->check([](const std::string& text) {
            return numbers(text, isGrid) ? std::string() : "must be 2^j + 1 from 3 to 4097";
        })
        ->capture_default_str();
    sub->add_option("--normals", options->normals,
                    "Give the file a normal image of this many samples a side; 0: normals come from the mesh")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    sub->add_option("--runs", options->runs, "Timed runs of decoders and peers; gimg encodes 3 times at most")
        ->check(CLI::Range(1, 10000))
        ->capture_default_str();
    sub->add_option("--peers", options->peers, "Names or codecs of peers, all, or none")
        ->capture_default_str();
    sub->add_option("--scaling", options->scaling, "Multiples of the mesh's faces, powers of 4, or none")
        ->capture_default_str();
    sub->add_option("--grids", options->grids, "Samples a side for scaling the decoder, or none")
        ->capture_default_str();
    return {sub, [options] { return run(*options); }};
}

} // namespace gimg::gimrd

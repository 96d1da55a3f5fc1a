// gimrd bench: speed, memory and scaling of gimg and its peers, in one run.
#include "bench_machine.h"
#include "bench_measure.h"
#include "bench_text.h"
#include "command.h"

#include "../cli.h"

#include <CLI/App.hpp>

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <sstream>

namespace gimg::gimrd {
namespace {

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

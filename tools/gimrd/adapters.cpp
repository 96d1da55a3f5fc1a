#include "adapters.h"

#include "process.h"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <tuple>

namespace gimg::gimrd {
namespace {

using Json = nlohmann::ordered_json;

Error failure(const CoderProgram& coder, const std::string& what)
{
    return {ErrorKind::CodecFailure, coder.program.string() + ": " + what};
}

std::string lastLine(std::string text)
{
    while (!text.empty() && text.back() == '\n') text.pop_back();
    const size_t start = text.find_last_of('\n');
    return start == std::string::npos ? text : text.substr(start + 1);
}

// Runs the adapter; each line it prints must be a JSON object, which `take` reads. Anything that `take`
// misses in it is a breach of the protocol.
Status talk(const CoderProgram& coder, std::vector<std::string> arguments,
            const std::function<void(const Json&)>& take, std::int64_t* peakBytes = nullptr)
{
    arguments.insert(arguments.begin(), coder.program.string());
    std::string breach;
    const Result<Ended> ended = runProgram(arguments, [&](const std::string& line) {
        try {
            take(Json::parse(line));
        } catch (const Json::exception& error) {
            if (breach.empty())
                breach = std::string("does not speak the adapters' protocol: ") + error.what();
        }
    });
    if (!ended) return ended.error();
    if (ended->code != 0) {
        const std::string said = lastLine(ended->errors);
        return failure(coder, "ended with status " + std::to_string(ended->code) +
                                  (said.empty() ? "" : ": " + said));
    }
    if (!breach.empty()) return failure(coder, breach);
    if (peakBytes != nullptr) *peakBytes = ended->peakBytes;
    return Done{};
}

Status describe(CoderProgram& coder)
{
    return talk(coder, {"describe"}, [&](const Json& json) {
        coder.name = json.at("name");
        coder.title = json.at("title");
        coder.codec = json.at("codec");
        coder.takesImage = json.at("input") == "image";
        coder.ours = json.at("side") == "ours";
        coder.usesGrid = json.at("uses_grid");
        coder.packages = json.at("packages").get<std::vector<std::string>>();
        coder.missing = json.at("missing").get<std::vector<std::string>>();
    });
}

} // namespace

std::filesystem::path adapterFolder()
{
    if (const char* folder = std::getenv("GIMRD_ADAPTERS")) return folder;
    std::error_code failed;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", failed);
    return self.parent_path().parent_path() / "libexec/gimg/adapters";
}

Result<std::vector<CoderProgram>> findCoders()
{
    std::error_code failed;
    std::vector<CoderProgram> coders;
    for (const auto& entry : std::filesystem::directory_iterator(adapterFolder(), failed)) {
        if (!entry.is_regular_file()) continue;
        CoderProgram coder;
        coder.program = entry.path();
        const Status described = describe(coder);
        if (!described) return described.error();
        coders.push_back(std::move(coder));
    }
    if (failed)
        return Error{ErrorKind::FileNotReadable,
                     adapterFolder().string() + ": no adapters: " + failed.message()};
    std::sort(coders.begin(), coders.end(), [](const CoderProgram& a, const CoderProgram& b) {
        return std::tuple(!a.ours, a.name) < std::tuple(!b.ours, b.name);
    });
    return coders;
}

Status encodeWith(const CoderProgram& coder, const std::filesystem::path& input,
                  const std::filesystem::path& out, const std::vector<std::size_t>& sizes, int grid,
                  int threads, const std::function<void(const CodedFile&)>& done)
{
    std::string list;
    for (const size_t size : sizes) {
        if (!list.empty()) list += ',';
        list += std::to_string(size);
    }
    const std::vector<std::string> arguments = {
        "encode",    input.string(),         out.string(), "--bytes", list, "--grid", std::to_string(grid),
        "--threads", std::to_string(threads)};
    return talk(coder, arguments, [&](const Json& json) {
        CodedFile coded;
        coded.target = json.at("target");
        if (json.contains("unreachable")) {
            coded.unreachable = json.at("unreachable");
        } else {
            coded.bytes = json.at("bytes");
            coded.file = out / json.at("file").get<std::string>();
            coded.decoded = out / json.at("decoded").get<std::string>();
            coded.settings = json.at("settings");
        }
        done(coded);
    });
}

Result<CoderTimes> timeWith(const CoderProgram& coder, const std::filesystem::path& input, std::size_t bytes,
                            int runs)
{
    std::optional<CoderTimes> times;
    std::int64_t peakBytes = 0;
    const std::vector<std::string> arguments = {
        "time", input.string(), "--bytes", std::to_string(bytes), "--runs", std::to_string(runs)};
    const Status talked = talk(
        coder, arguments,
        [&](const Json& json) {
            times =
                CoderTimes{json.at("bytes"), json.at("encode_ms"), json.at("decode_ms"), json.at("note"), 0};
        },
        &peakBytes);
    if (!talked) return talked.error();
    const auto wanted = static_cast<size_t>(runs);
    if (!times || times->encode.size() != wanted || times->decode.size() != wanted)
        return failure(coder, "did not give the times of " + std::to_string(runs) + " runs");
    times->peakBytes = peakBytes;
    return *times;
}

} // namespace gimg::gimrd

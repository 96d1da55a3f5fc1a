#include "adapters.h"

#include "../cli.h"
#include "../process.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <tuple>

namespace gimg::gimrd {
namespace {

using Json = nlohmann::ordered_json;

Error failure(const CoderProgram& coder, const std::string& what)
{
    return {ErrorKind::CodecFailure, "adapter " + coder.program.filename().string() + ": " + what};
}

std::string howItEnded(int code)
{
    return code > 128 ? "ended by signal " + std::to_string(code - 128)
                      : "ended with status " + std::to_string(code);
}

// Runs the adapter; each line it prints must be a JSON object, which `take` reads. Anything that `take`
// misses in it, or names in its result, is a breach of the protocol; the first one is reported.
Status talk(const CoderProgram& coder, std::vector<std::string> arguments,
            const std::function<std::string(const Json&)>& take, std::int64_t* peakBytes = nullptr)
{
    arguments.insert(arguments.begin(), coder.program.string());
    std::string breach;
    const Result<cli::Ended> ended = cli::runProgram(arguments, [&](const std::string& line) {
        std::string wrong;
        try {
            wrong = take(Json::parse(line));
        } catch (const Json::exception& error) {
            wrong = error.what();
        }
        if (breach.empty() && !wrong.empty()) breach = "does not speak the adapters' protocol: " + wrong;
    });
    if (!ended) return ended.error();
    if (ended->code != 0) {
        const std::string said = cli::lastLine(ended->errors);
        return failure(coder, howItEnded(ended->code) + (said.empty() ? "" : ": " + said));
    }
    if (!breach.empty()) return failure(coder, breach);
    if (peakBytes != nullptr) *peakBytes = ended->peakBytes;
    return Done{};
}

Status describe(CoderProgram& coder)
{
    const Status status = talk(coder, {"describe"}, [&](const Json& json) {
        coder.name = json.at("name");
        coder.title = json.at("title");
        coder.codec = json.at("codec");
        coder.takesImage = json.at("input") == "image";
        coder.ours = json.at("side") == "ours";
        coder.usesGrid = json.at("uses_grid");
        coder.packages = json.at("packages").get<std::vector<std::string>>();
        coder.missing = json.at("missing").get<std::vector<std::string>>();
        return std::string();
    });
    if (status && coder.name.empty()) return failure(coder, "does not describe itself");
    return status;
}

// The adapters' answer for one size. A file must be where it is said to be and as large as it is said to be:
// nothing else keeps a coder from being praised for bytes that it did not write.
struct Answer
{
    CodedFile coded;
    std::string breach;
};

bool isPlainName(const std::string& name)
{
    return !name.empty() && name[0] != '.' && name.find('/') == std::string::npos;
}

Answer readAnswer(const Json& json, const std::filesystem::path& out)
{
    Answer answer;
    CodedFile& coded = answer.coded;
    coded.target = json.at("target");
    if (json.contains("unreachable")) {
        coded.unreachable = json.at("unreachable");
        if (coded.unreachable.empty()) coded.unreachable = "no reason given";
        return answer;
    }
    coded.bytes = json.at("bytes");
    coded.settings = json.at("settings");
    const std::string file = json.at("file"), decoded = json.at("decoded");
    if (!isPlainName(file)) answer.breach = "a file named '" + file + "'";
    if (!isPlainName(decoded)) answer.breach = "a file named '" + decoded + "'";
    coded.file = out / file;
    coded.decoded = out / decoded;
    std::error_code failed;
    const std::uintmax_t size = std::filesystem::file_size(coded.file, failed);
    if (answer.breach.empty() && (failed || size != coded.bytes))
        answer.breach = "the file " + file + " does not have the " + std::to_string(coded.bytes) +
                        " bytes that it should";
    return answer;
}

} // namespace

std::filesystem::path adapterFolder()
{
    if (const char* folder = std::getenv("GIMRD_ADAPTERS")) return folder;
    std::error_code failed;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", failed);
    return self.parent_path().parent_path() / "libexec/gimg/adapters";
}

Result<std::vector<CoderProgram>> findCoders(std::vector<Error>* broken)
{
    std::error_code failed;
    std::vector<std::filesystem::path> programs;
    for (const auto& entry : std::filesystem::directory_iterator(adapterFolder(), failed))
        if (entry.is_regular_file() && ::access(entry.path().c_str(), X_OK) == 0)
            programs.push_back(entry.path());
    if (failed) return Error{ErrorKind::FileNotReadable, adapterFolder().string() + ": " + failed.message()};
    std::sort(programs.begin(), programs.end());
    std::vector<CoderProgram> coders;
    for (const std::filesystem::path& program : programs) {
        CoderProgram coder;
        coder.program = program;
        Status described = describe(coder);
        for (const CoderProgram& other : coders)
            if (described && other.name == coder.name)
                described = failure(coder, "has the name " + coder.name + ", as " +
                                               other.program.filename().string() + " has");
        if (described)
            coders.push_back(std::move(coder));
        else if (broken != nullptr)
            broken->push_back(described.error());
        else
            return described.error();
    }
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
    std::vector<size_t> open = sizes;
    return talk(coder, arguments, [&](const Json& json) {
        const Answer answer = readAnswer(json, out);
        if (!answer.breach.empty()) return answer.breach;
        if (std::erase(open, answer.coded.target) == 0)
            return "an answer for " + std::to_string(answer.coded.target) + " bytes, which nobody asked for";
        done(answer.coded);
        return std::string();
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
            return std::string();
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

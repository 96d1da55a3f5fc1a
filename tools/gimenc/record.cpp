#include "record.h"

#include <filesystem>

namespace gimg::gimenc {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Safe on any JSON: files named OUTPUT.json may be somebody else's.
template <class T> bool holds(const Json& record, const char* key, const T& value)
{
    const auto found = record.find(key);
    return found != record.end() && *found == Json(value);
}

Json readRecord(const Arguments& a)
{
    const auto text = cli::readFile(recordPath(a.output));
    if (!text) return nullptr;
    Json record = Json::parse(text->begin(), text->end(), nullptr, false);
    const bool fits =
        record.is_object() && holds(record, "gimg", GIMG_VERSION) && holds(record, "options", fileOptions(a));
    return fits ? record : Json(nullptr);
}

bool fitsOutput(const Json& record, const Arguments& a)
{
    const auto output = cli::contentsOf(a.output);
    return output && holds(record, "output_sha256", output->sha256);
}

Json identity(const Arguments& a, const char* status, const std::optional<cli::Contents>& input)
{
    Json record;
    record["status"] = status;
    record["gimg"] = GIMG_VERSION;
    record["options"] = fileOptions(a);
    record["input"] = a.input;
    record["input_bytes"] = input ? Json(input->bytes) : Json();
    record["input_sha256"] = input ? Json(input->sha256) : Json();
    record["output"] = a.output;
    return record;
}

bool writeRecord(const Arguments& a, const Json& record)
{
    const std::string text = record.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
    return cli::writeWhole(recordPath(a.output), text.data(), text.size());
}

void setAside(const std::string& output)
{
    std::error_code ignored;
    if (!fs::is_regular_file(output, ignored)) return;
    const std::string aside = output + ".old";
    fs::rename(output, aside, ignored);
    if (!ignored) fs::rename(recordPath(output), recordPath(aside), ignored);
}

} // namespace

std::string recordPath(const std::string& output) { return output + ".json"; }

Recorded recorded(const Arguments& a)
{
    Json record = readRecord(a);
    if (record.is_null()) return {};
    if (holds(record, "status", "failed")) return {Standing::Failed, std::move(record)};
    std::error_code error;
    const auto size = fs::file_size(a.output, error);
    if (error || !holds(record, "status", "done") || !holds(record, "output_bytes", size)) return {};
    return {Standing::Done, std::move(record)};
}

bool isFinished(const Arguments& a, const cli::Contents& input)
{
    const Recorded found = recorded(a);
    return found.standing == Standing::Done && holds(found.record, "input_bytes", input.bytes) &&
           holds(found.record, "input_sha256", input.sha256) && fitsOutput(found.record, a);
}

std::optional<std::string> recordDone(const Arguments& a, const cli::Contents& input,
                                      const std::vector<std::uint8_t>& file, const Json& report)
{
    // The record comes last: if this process ends between the two, the job counts as not done.
    if (!cli::writeWhole(a.output, file.data(), file.size())) return a.output + ": cannot be written";
    const cli::Contents output = cli::contentsOf(file.data(), file.size());
    Json record = identity(a, "done", input);
    record["output_bytes"] = output.bytes;
    record["output_sha256"] = output.sha256;
    record.update(report);
    if (!writeRecord(a, record)) return recordPath(a.output) + ": cannot be written";
    return std::nullopt;
}

void recordFailure(const Arguments& a, const std::optional<cli::Contents>& input, const std::string& error)
{
    const Recorded found = recorded(a);
    if (input ? isFinished(a, *input) : found.standing == Standing::Done && fitsOutput(found.record, a))
        return;
    setAside(a.output);
    Json record = identity(a, "failed", input);
    record["error"] = error;
    writeRecord(a, record); // if that is not possible either, the job stays pending
}

} // namespace gimg::gimenc

#include "summary.h"

#include "record.h"

namespace gimg::gimenc {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kColumns[] = {"input", "output", "options", "status",  "bytes", "psnr",
                                    "faces", "genus",  "grid",    "seconds", "error"};

// A record of another hand may lack anything.
Json at(const Json& record, std::initializer_list<const char*> keys)
{
    const Json* value = &record;
    for (const char* key : keys) {
        if (!value->is_object() || !value->contains(key)) return nullptr;
        value = &value->at(key);
    }
    return value->is_structured() ? Json() : *value;
}

Json row(const Arguments& a, const Recorded& found)
{
    std::string options;
    for (const std::string& word : fileOptions(a)) options += (options.empty() ? "" : " ") + word;
    const char* status = found.standing == Standing::Done     ? "done"
                         : found.standing == Standing::Failed ? "failed"
                                                              : "pending";
    Json row;
    row["input"] = a.input;
    row["output"] = a.output;
    row["options"] = options;
    row["status"] = status;
    row["bytes"] = at(found.record, {"output_bytes"});
    for (const char* key : {"psnr", "faces", "genus", "grid"}) row[key] = at(found.record, {key});
    row["seconds"] = at(found.record, {"seconds", "total"});
    row["error"] = at(found.record, {"error"});
    return row;
}

// RFC 4180: quoted where it must be, quotes doubled.
std::string cell(const Json& value)
{
    if (value.is_null()) return "";
    if (!value.is_string()) return value.dump();
    const auto text = value.get<std::string>();
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
}

std::string csv(const Json& rows)
{
    std::string text;
    for (const char* column : kColumns) {
        if (!text.empty()) text += ',';
        text += column;
    }
    text += '\n';
    for (const Json& row : rows) {
        std::string line;
        for (const char* column : kColumns) line += ',' + cell(row.at(column));
        text += line.substr(1) + '\n';
    }
    return text;
}

bool endsWith(const std::string& path, const std::string& end)
{
    return path.size() > end.size() && path.compare(path.size() - end.size(), end.size(), end) == 0;
}

} // namespace

bool isSummaryName(const std::string& path) { return endsWith(path, ".csv") || endsWith(path, ".json"); }

Result<Counts> writeSummary(const std::string& path, const std::vector<Job>& jobs)
{
    Counts counts;
    Json rows = Json::array();
    for (const Job& job : jobs) {
        const Recorded found = recorded(job.arguments);
        ++(found.standing == Standing::Done     ? counts.done
           : found.standing == Standing::Failed ? counts.failed
                                                : counts.pending);
        rows.push_back(row(job.arguments, found));
    }
    const std::string text =
        endsWith(path, ".csv") ? csv(rows) : rows.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
    if (!cli::writeWhole(path, text.data(), text.size()))
        return Error{ErrorKind::FileNotWritable, path + ": cannot be written"};
    return counts;
}

} // namespace gimg::gimenc

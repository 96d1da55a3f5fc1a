#include "list.h"

#include "record.h"

#include <filesystem>
#include <iostream>
#include <iterator>
#include <unordered_map>

namespace gimg::gimenc {
namespace {

namespace fs = std::filesystem;

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

// Takes one word off the front of `rest`, which starts with it. Returns what is wrong with it, if anything.
const char* takeWord(std::string_view& rest, std::string& word)
{
    size_t i = 0;
    for (; i < rest.size() && !isBlank(rest[i]); ++i) {
        const char c = rest[i];
        if (c == '\\') {
            if (++i == rest.size()) return "nothing follows the backslash";
            word += rest[i];
        } else if (c == '\'' || c == '"') {
            for (++i; i < rest.size() && rest[i] != c; ++i) {
                const bool escape = c == '"' && rest[i] == '\\' && i + 1 < rest.size() &&
                                    std::string_view("\"\\$`").find(rest[i + 1]) != std::string_view::npos;
                word += rest[escape ? ++i : i];
            }
            if (i == rest.size()) return "a quote is not closed";
        } else {
            word += c;
        }
    }
    rest.remove_prefix(i);
    return nullptr;
}

Error atLine(int number, const std::string& what)
{
    return {ErrorKind::BadArgument, "line " + std::to_string(number) + ": " + what};
}

// One name for each file, whichever way it is reached.
std::string placeOf(const std::string& path)
{
    std::error_code error;
    const fs::path place = fs::weakly_canonical(fs::absolute(path), error);
    return error ? path : place.string();
}

std::optional<Error> clash(const std::vector<Job>& jobs)
{
    std::unordered_map<std::string, int> written, read;
    for (const Job& job : jobs) read.try_emplace(placeOf(job.arguments.input), job.line);
    for (const Job& job : jobs) {
        const std::string& output = job.arguments.output;
        for (const std::string& path : {output, recordPath(output)}) {
            const std::string place = placeOf(path);
            if (const auto by = read.find(place); by != read.end())
                return atLine(job.line, path + " is the input of line " + std::to_string(by->second));
            if (const auto [by, fresh] = written.try_emplace(place, job.line); !fresh)
                return atLine(job.line, path + " is written by line " + std::to_string(by->second) + " too");
        }
    }
    return std::nullopt;
}

std::optional<std::string> readText(const std::string& list)
{
    if (list == "-") return std::string(std::istreambuf_iterator<char>(std::cin), {});
    const auto bytes = cli::readFile(list);
    if (!bytes) return std::nullopt;
    return std::string(bytes->begin(), bytes->end());
}

} // namespace

Result<std::vector<ListLine>> splitList(std::string_view text)
{
    std::vector<ListLine> lines;
    for (int number = 1; !text.empty(); ++number) {
        const size_t end = std::min(text.find('\n'), text.size());
        std::string_view rest = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        ListLine line{number, {}};
        for (;;) {
            while (!rest.empty() && isBlank(rest.front())) rest.remove_prefix(1);
            if (rest.empty() || rest.front() == '#') break;
            if (const char* wrong = takeWord(rest, line.words.emplace_back())) return atLine(number, wrong);
        }
        if (!line.words.empty()) lines.push_back(std::move(line));
    }
    return lines;
}

Result<std::vector<Job>> readJobs(const std::string& list, const Arguments& defaults)
{
    const auto text = readText(list);
    if (!text) return Error{ErrorKind::FileNotReadable, list + ": cannot be read"};
    const Result<std::vector<ListLine>> lines = splitList(*text);
    const auto in = [&](const Error& error) { return Error{error.kind, list + ": " + error.message}; };
    if (!lines) return in(lines.error());
    std::vector<Job> jobs;
    for (const ListLine& line : *lines) {
        Result<Arguments> arguments = parseLine(line.words, defaults);
        if (!arguments) return in(atLine(line.number, arguments.error().message));
        jobs.push_back({line.number, std::move(*arguments)});
    }
    if (const auto error = clash(jobs)) return in(*error);
    return jobs;
}

} // namespace gimg::gimenc

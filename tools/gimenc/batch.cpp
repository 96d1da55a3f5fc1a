#include "batch.h"

#include "../process.h"
#include "list.h"
#include "pace.h"
#include "record.h"
#include "status_line.h"
#include "summary.h"

#include <CLI/App.hpp>
#include <sched.h>

#include <algorithm>
#include <condition_variable>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>
#include <thread>

namespace gimg::gimenc {
namespace {

constexpr int kKilled = 128; // exit statuses above are of a signal

// Cores this process may use, which can be fewer than the machine has.
int cores()
{
    cpu_set_t set;
    return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
}

std::string ownProgram()
{
    std::error_code error;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    return error ? "gimenc" : program.string(); // which PATH may know
}

std::uint64_t sizeOf(const std::string& path)
{
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    return error ? 0 : size;
}

// Each job is a process of its own: one that crashes or runs out of memory takes no other along.
std::vector<std::string> command(const std::string& program, const Arguments& a, int threads)
{
    std::vector<std::string> words = {program, "--resume"};
    for (std::string& word : fileOptions(a)) words.push_back(std::move(word));
    if (threads > 0) words.insert(words.end(), {"--threads", std::to_string(threads)});
    words.insert(words.end(), {"--", a.input, a.output});
    return words;
}

std::string lastLine(std::string text)
{
    while (!text.empty() && text.back() == '\n') text.pop_back();
    text.erase(0, text.rfind('\n') + 1); // npos + 1 is 0
    const std::string prefix = "gimenc: ";
    return text.starts_with(prefix) ? text.substr(prefix.size()) : text;
}

struct Outcome
{
    enum
    {
        Done,
        AlreadyThere,
        Failed
    } kind = Done;
    std::string text;
};

Outcome runJob(const std::string& program, const Arguments& a, int threads)
{
    const std::optional<cli::Contents> input = cli::contentsOf(a.input);
    if (input && isFinished(a, *input)) return {Outcome::AlreadyThere, ""};
    std::string printed;
    const auto ended =
        cli::runProgram(command(program, a, threads), [&](const std::string& line) { printed = line; });
    if (ended && ended->code == cli::Done) return {Outcome::Done, printed};
    std::string error = ended ? lastLine(ended->errors) : ended.error().message;
    if (ended && ended->code > kKilled)
        error = a.input + ": ended by signal " + std::to_string(ended->code - kKilled) + " (" +
                strsignal(ended->code - kKilled) + ")";
    if (error.empty()) error = a.input + ": ended with status " + std::to_string(ended->code);
    // A process that failed by itself has done this; one that was killed could not.
    recordFailure(a, input, error);
    return {Outcome::Failed, error};
}

// What the workers share.
struct Progress
{
    std::mutex mutex;
    std::condition_variable changed;
    size_t next = 0;
    int counts[3] = {};
    std::set<size_t> running;
    Pace pace;
    int finished() const { return counts[0] + counts[1] + counts[2]; }
};

class Batch
{
public:
    Batch(const std::vector<Job>& jobs, const BatchOptions& options, bool quiet)
        : jobs_(jobs), options_(options), quiet_(quiet), status_(!quiet),
          threads_(options.jobs > 1 ? std::max(1, cores() / options.jobs) : 0)
    {
        for (const Job& job : jobs) progress_.pace.expect(sizeOf(job.arguments.input));
    }

    int run()
    {
        std::vector<std::thread> workers;
        const size_t count = std::min(jobs_.size(), static_cast<size_t>(options_.jobs));
        for (size_t i = 0; i < count; ++i) workers.emplace_back([this] { work(); });
        showUntilAllEnded();
        for (std::thread& worker : workers) worker.join();
        status_.wipe();
        if (!quiet_) tellCounts();
        return progress_.counts[Outcome::Failed] > 0 ? cli::Refused : cli::Done;
    }

private:
    void work()
    {
        std::unique_lock lock(progress_.mutex);
        while (progress_.next < jobs_.size()) {
            const size_t at = progress_.next++;
            const Arguments& a = jobs_[at].arguments;
            progress_.running.insert(at);
            lock.unlock();
            const std::uint64_t size = sizeOf(a.input);
            const Outcome outcome = runJob(program_, a, a.threads > 0 ? a.threads : threads_);
            lock.lock();
            progress_.running.erase(at);
            ++progress_.counts[outcome.kind];
            progress_.pace.finish(size, outcome.kind != Outcome::AlreadyThere);
            tell(jobs_[at], outcome);
            progress_.changed.notify_one();
        }
    }

    // Called with the mutex held, so that lines do not mix.
    void tell(const Job& job, const Outcome& outcome) const
    {
        if (outcome.kind == Outcome::Failed) {
            status_.wipe();
            std::fprintf(stderr, "gimenc: %s: line %d: %s\n", options_.list.c_str(), job.line,
                         outcome.text.c_str());
        } else if (outcome.kind == Outcome::Done && !quiet_ && !status_.isShown()) {
            std::printf("[%d/%zu] %s\n", progress_.finished(), jobs_.size(), outcome.text.c_str());
            std::fflush(stdout);
        }
    }

    void showUntilAllEnded()
    {
        std::unique_lock lock(progress_.mutex);
        const int all = static_cast<int>(jobs_.size());
        while (progress_.finished() < all) {
            std::string text = std::to_string(progress_.finished()) + "/" + std::to_string(all);
            for (const size_t at : progress_.running)
                text += "  " + std::filesystem::path(jobs_[at].arguments.input).filename().string();
            if (text.size() > 60) text = text.substr(0, 57) + "...";
            status_.show(text + progress_.pace.left());
            progress_.changed.wait_for(lock, std::chrono::seconds(1));
        }
    }

    void tellCounts() const
    {
        const std::string part = options_.part.count > 1
                                     ? "part " + std::to_string(options_.part.index) + "/" +
                                           std::to_string(options_.part.count) + ": "
                                     : "";
        std::printf("%s%d done, %d already there, %d failed\n", part.c_str(), progress_.counts[Outcome::Done],
                    progress_.counts[Outcome::AlreadyThere], progress_.counts[Outcome::Failed]);
    }

    const std::vector<Job>& jobs_;
    const BatchOptions& options_;
    bool quiet_;
    StatusLine status_;
    int threads_; ///< for each job that does not say; 0: one a core
    std::string program_ = ownProgram();
    Progress progress_;
};

int merge(const std::vector<Job>& jobs, const std::string& path, bool quiet)
{
    const Result<Counts> counts = writeSummary(path, jobs);
    if (!counts) return cli::fail("gimenc", cli::Refused, counts.error().message);
    if (!quiet)
        std::printf("%s: %d done, %d failed, %d pending\n", path.c_str(), counts->done, counts->failed,
                    counts->pending);
    return counts->failed + counts->pending > 0 ? cli::Refused : cli::Done;
}

std::vector<Job> shareOf(const std::vector<Job>& jobs, const cli::Part& part)
{
    std::vector<Job> share;
    for (size_t i = 0; i < jobs.size(); ++i)
        if (part.has(i)) share.push_back(jobs[i]);
    return share;
}

} // namespace

void addBatchOptions(CLI::App& app, BatchOptions& batch)
{
    const CLI::Validator part(
        [](const std::string& text) {
            return cli::parsePart(text) ? std::string() : text + " is not I/N with 1 <= I <= N";
        },
        "");
    const CLI::Validator table(
        [](const std::string& text) {
            return isSummaryName(text) ? std::string() : text + " is neither .csv nor .json";
        },
        "");
    auto* list = app.add_option("--batch", batch.list,
                                "run the lines of this file, or of - for standard input: each the arguments "
                                "of one call; what is finished is not run again");
    app.add_option("--jobs", batch.jobs, "lines to run at a time, each with its share of the cores")
        ->check(CLI::Range(1, 4096))
        ->needs(list);
    auto* share = app.add_option_function<std::string>(
        "--part", [&](const std::string& text) { batch.part = *cli::parsePart(text); },
        "I/N: run only lines I, I + N, I + 2N, ...");
    share->check(part)->needs(list);
    auto* summary =
        app.add_option("--summary", batch.summary, "after the run write a table of all lines, .csv or .json");
    summary->check(table)->needs(list);
    app.add_option("--merge", batch.merge, "run nothing and write the table of all lines")
        ->check(table)
        ->needs(list)
        ->excludes(summary)
        ->excludes(share);
}

int runBatch(const Arguments& defaults, const BatchOptions& batch)
{
    const Result<std::vector<Job>> jobs = readJobs(batch.list, defaults);
    if (!jobs) return cli::fail("gimenc", cli::Usage, jobs.error().message);
    if (!batch.merge.empty()) return merge(*jobs, batch.merge, defaults.quiet);
    const std::vector<Job> share = shareOf(*jobs, batch.part);
    const int ended = Batch(share, batch, defaults.quiet).run();
    if (batch.summary.empty()) return ended;
    const Result<Counts> counts = writeSummary(batch.summary, *jobs);
    if (!counts) return cli::fail("gimenc", cli::Refused, counts.error().message);
    return ended;
}

} // namespace gimg::gimenc

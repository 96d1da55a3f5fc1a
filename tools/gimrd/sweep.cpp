// gimrd sweep: many meshes, coders and sizes; a report at the end.
#include "../process.h"
#include "command.h"
#include "curves.h"
#include "report.h"
#include "results.h"
#include "sweep_folder.h"
#include "sweep_plan.h"
#include "sweep_run.h"

#include "../cli.h"

#include <CLI/App.hpp>
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <thread>

namespace gimg::gimrd {
namespace {

struct SweepOptions
{
    SweepRequest request;
    std::vector<std::string> meshes, ours, peers;
    RunOptions run;
    std::string part, out;
    CLI::Option* partOption = nullptr;
    CLI::Option* oursOption = nullptr;
    CLI::Option* peersOption = nullptr;
};

int refused(const Error& error)
{
    const bool usage = error.kind == ErrorKind::BadArgument;
    return cli::fail("gimrd", usage ? cli::Usage : cli::Refused, error.message);
}

// What is finished stays, so the way out on SIGINT or SIGTERM is short: end the coders, remove the drafts,
// go. SIGKILL leaves only drafts behind, which the next sweep removes.
void leaveOnSignal(const std::shared_ptr<SweepFolder>& folder)
{
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr); // of the threads that are still to come, too
    std::thread([folder, signals] {
        int signal = 0;
        sigwait(&signals, &signal);
        cli::endPrograms();
        folder->close();
        std::fputs("\ngimrd: stopped; finished points stay, the same command goes on from here\n", stderr);
        ::_exit(128 + signal);
    }).detach();
}

// The command that makes the same report anywhere: no folders, and nothing that does not change the outcome.
std::string canonicalCommand(const SweepOptions& options, const SweepPlan& plan)
{
    const auto list = [](auto items, const auto& text) {
        std::sort(items.begin(), items.end());
        items.erase(std::unique(items.begin(), items.end()), items.end());
        std::string joined;
        for (const auto& item : items) joined += (joined.empty() ? "" : ",") + text(item);
        return joined;
    };
    const auto number = [](auto n) { return std::to_string(n); };
    const auto same = [](const std::string& s) { return s; };
    std::string command = "gimrd sweep";
    for (const SweepMesh& mesh : plan.meshes) command += ' ' + mesh.path.filename().string();
    command += " --bytes " + list(plan.sizes, number);
    if (options.request.ours) command += " --coders " + list(*options.request.ours, same);
    if (options.request.peers) command += " --peers " + list(*options.request.peers, same);
    if (!options.request.grids.empty()) command += " --grids " + list(options.request.grids, number);
    if (options.run.samples != RunOptions().samples) command += " --samples " + number(options.run.samples);
    return command + " --out DIR";
}

bool isNamed(const SweepPlan& plan, const std::string& coder)
{
    return std::find(plan.named.begin(), plan.named.end(), coder) != plan.named.end();
}

bool isWhole(const SweepPlan& plan, const Job& job, const SweepResults& results)
{
    for (size_t c = 0; c < results.series.size(); ++c)
        if (results.series[c].id == plan.series[job.series].id)
            return std::ranges::all_of(results.meshes[job.mesh].points[c],
                                       [](const auto& p) { return p && p->state != Point::State::Failed; });
    return false;
}

// Coders that are not installed and have points missing among these jobs.
std::vector<Absence> absences(const SweepPlan& plan, const std::vector<size_t>& jobs,
                              const SweepResults& results)
{
    std::vector<Absence> list;
    for (size_t c = 0; c < plan.coders.size(); ++c) {
        const CoderProgram& coder = plan.coders[c];
        const bool whole = std::ranges::all_of(jobs, [&](size_t index) {
            const Job& job = plan.jobs[index];
            return plan.series[job.series].coder != c || isWhole(plan, job, results);
        });
        if (!coder.missing.empty() && !whole) list.push_back({coder.name, coder.title, coder.missing});
    }
    return list;
}

void tellAbsence(const Absence& absence)
{
    std::string line = "gimrd: " + absence.coder + " is not installed and skipped; Debian packages:";
    for (const std::string& package : absence.packages) line += ' ' + package;
    std::fprintf(stderr, "%s\n", line.c_str());
}

void printTable(const SweepResults& results)
{
    size_t width = 4;
    for (const SweepResults::Row& row : results.meshes) width = std::max(width, row.name.size());
    size_t seriesWidth = 5;
    for (const SweepResults::Column& series : results.series)
        seriesWidth = std::max(seriesWidth, series.id.size());
    std::printf("%-*s  %-*s", static_cast<int>(width), "dB", static_cast<int>(seriesWidth), "bytes");
    for (const size_t size : results.sizes) std::printf(" %8zu", size);
    std::printf("\n");
    for (const SweepResults::Row& row : results.meshes)
        for (size_t c = 0; c < results.series.size(); ++c) {
            const auto& points = row.points[c];
            if (std::none_of(points.begin(), points.end(), [](const auto& p) { return p.has_value(); }))
                continue;
            std::printf("%-*s  %-*s", static_cast<int>(width), row.name.c_str(),
                        static_cast<int>(seriesWidth), results.series[c].id.c_str());
            for (const std::optional<Point>& p : points)
                if (p && p->state == Point::State::Done)
                    std::printf(" %8.2f", p->distance.psnr());
                else
                    std::printf(" %8s", p && p->state == Point::State::Failed ? "failed" : "-");
            std::printf("\n");
        }
}

Status writeOutputs(const SweepResults& results, SweepFolder& folder)
{
    const Status drawn = drawCurves(results, folder);
    if (!drawn) return drawn;
    const std::pair<std::string, std::string> files[] = {{"results.csv", resultsCsv(results)},
                                                         {"results.json", jsonText(resultsJson(results))},
                                                         {"report.html", reportHtml(results, folder)}};
    for (const auto& [name, text] : files) {
        const Status written = folder.publishText(text, folder.path() / name);
        if (!written) return written;
    }
    return Done{};
}

void printPlaces(const SweepFolder& folder)
{
    for (const char* name : {"report.html", "results.csv", "results.json", "curves"})
        std::printf("%s\n", (folder.path() / name).c_str());
}

// Whether an adapter that does not work could be one that was asked for: not if all of those were found.
bool brokenMatters(const SweepOptions& options) { return !options.request.ours || !options.request.peers; }

int sweep(SweepOptions& options)
{
    for (const std::string& mesh : options.meshes) options.request.meshes.emplace_back(mesh);
    if (options.oursOption->count() > 0) options.request.ours = options.ours;
    if (options.peersOption->count() > 0) options.request.peers = options.peers;
    cli::Part part;
    const bool isPart = options.partOption->count() > 0;
    if (isPart) part = *cli::parsePart(options.part);
    const std::string missing = isPart ? "" : missingForCurves();
    if (!missing.empty())
        return cli::fail("gimrd", cli::Refused,
                         "the curves need gnuplot: install the Debian package " + missing);

    const auto folder = std::make_shared<SweepFolder>(options.out);
    leaveOnSignal(folder);
    std::vector<Error> broken;
    const Result<std::vector<CoderProgram>> coders = findCoders(&broken);
    if (!coders) return cli::fail("gimrd", cli::Refused, coders.error().message);
    const Result<SweepPlan> plan = planSweep(options.request, *coders);
    if (plan && !brokenMatters(options)) broken.clear();
    for (const Error& error : broken) std::fprintf(stderr, "gimrd: %s\n", error.message.c_str());
    if (!plan) return refused(plan.error());

    const Status opened = folder->open();
    if (!opened) return cli::fail("gimrd", cli::Refused, opened.error().message);
    std::vector<size_t> jobs;
    std::vector<bool> wanted(plan->meshes.size());
    for (size_t job = 0; job < plan->jobs.size(); ++job)
        if (part.has(job)) jobs.push_back(job), wanted[plan->jobs[job].mesh] = true;
    const std::vector<std::string> hashes = hashMeshes(*plan, wanted);
    const Result<bool> ran = runJobs(*plan, jobs, hashes, *folder, options.run);
    if (!ran) {
        folder->close();
        return cli::fail("gimrd", cli::Refused, ran.error().message);
    }

    SweepResults results = collectResults(*plan, jobs, hashes, *folder, options.run.samples);
    results.skipped = absences(*plan, jobs, results);
    for (const Error& error : broken) results.broken.push_back(error.message);
    results.command = canonicalCommand(options, *plan);
    Status written = Done{};
    if (!isPart) written = writeOutputs(results, *folder);
    folder->close();
    if (!written) return cli::fail("gimrd", cli::Refused, written.error().message);
    bool namedMissing = false;
    for (const Absence& absence : results.skipped) {
        tellAbsence(absence);
        namedMissing = namedMissing || isNamed(*plan, absence.coder);
    }
    if (!isPart) {
        printTable(results);
        printPlaces(*folder);
    }
    if (!*ran || !broken.empty() || anyFailed(results))
        return cli::fail("gimrd", cli::Refused, "some points failed, see above");
    return namedMissing ? cli::Unreachable : cli::Done;
}

std::string checkGrid(const std::string& text)
{
    const long grid = std::atol(text.c_str());
    const bool isGrid = grid >= 5 && grid <= 4097 && ((grid - 1) & (grid - 2)) == 0;
    return text == "0" || isGrid ? "" : text + " is neither 0 nor 2^j + 1 from 5 to 4097";
}

} // namespace

Command addSweep(CLI::App& app)
{
    const auto options = std::make_shared<SweepOptions>();
    const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    options->run.jobs = cores;
    CLI::App* sub = app.add_subcommand("sweep", "Rate-distortion curves of coders over meshes, and a report");
    sub->add_option("MESH", options->meshes, "Meshes (.obj, .ply, .off, .stl) or geometry images (.f32)")
        ->required();
    sub->add_option("--bytes", options->request.sizes, "Sizes of the files: 1536,3072,...")
        ->delimiter(',')
        ->required()
        ->check(CLI::Range(1, 1000000000));
    options->oursOption =
        sub->add_option("--coders", options->ours, "Which of our coders, or none; all if not given")
            ->delimiter(',');
    options->peersOption =
        sub->add_option("--peers", options->peers, "Which other coders, or none; all if not given")
            ->delimiter(',');
    sub->add_option("--grids", options->request.grids,
                    "Samples a side of the geometry image, 2^j + 1; 0: automatic")
        ->delimiter(',')
        ->check(CLI::Validator(checkGrid, "GRID"));
    sub->add_option("--jobs", options->run.jobs, "Jobs at a time")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    sub->add_option("--samples", options->run.samples, "Samples on each surface")
        ->check(CLI::Range(1, 100000000))
        ->capture_default_str();
    options->partOption =
        sub->add_option("--part", options->part, "I/N: only jobs I, I+N, I+2N, ..., and no report")
            ->check(CLI::Validator(
                [](const std::string& text) {
                    return cli::parsePart(text) ? "" : text + " is not I/N with 1 <= I <= N";
                },
                "I/N"));
    sub->add_flag("--keep", options->run.keep, "Keep the decoded meshes");
    sub->add_option("--out", options->out, "Folder for everything; what is finished there is not made again")
        ->required();
    return {sub, [options] {
                const int code = sweep(*options);
                cli::restIfEnding();
                return code;
            }};
}

} // namespace gimg::gimrd

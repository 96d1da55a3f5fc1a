#include "sweep_run.h"

#include "../process.h"
#include "../whole_file.h"
#include "progress.h"
#include "sweep_reference.h"

#include "gimg/decode.h"
#include "gimg/mesh_io.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <thread>

namespace gimg::gimrd {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

std::string sha256Of(const fs::path& path)
{
    const std::optional<cli::Contents> contents = cli::contentsOf(path.string());
    return contents ? contents->sha256 : "";
}

// The versions of the packages a coder is made from, as far as dpkg knows them.
Json versionsOf(const CoderProgram& coder)
{
    Json versions = {{"gimg", GIMG_VERSION}};
    if (coder.packages.empty()) return versions;
    std::vector<std::string> command = {"dpkg-query", "-W", "-f", "${Package} ${Version}\n"};
    command.insert(command.end(), coder.packages.begin(), coder.packages.end());
    const Result<cli::Ended> ended = cli::runProgram(command, [&](const std::string& line) {
        const size_t space = line.find(' ');
        if (space != std::string::npos && space + 1 < line.size())
            versions[line.substr(0, space)] = line.substr(space + 1);
    });
    static_cast<void>(ended); // without dpkg there is nothing to say
    return versions;
}

std::string outcomeOf(const Point& point)
{
    if (point.state != Point::State::Done) return std::string(name(point.state)) + ", " + point.message;
    char text[64];
    std::snprintf(text, sizeof text, "%zu bytes, %.2f dB", point.bytes, point.distance.psnr());
    return text;
}

bool isSettled(const std::optional<Point>& point) { return point && point->state != Point::State::Failed; }

// A mesh is held from its first job to its last. Made under its own lock: jobs of other meshes do not wait.
struct MeshState
{
    std::mutex mutex;
    std::optional<Result<std::shared_ptr<SweepReference>>> reference;
    std::map<int, Result<fs::path>> images; ///< by samples a side
    size_t jobsLeft = 0;
};

class Runner
{
public:
    Runner(const SweepPlan& plan, const std::vector<std::string>& hashes, SweepFolder& folder,
           const RunOptions& options)
        : plan_(plan), hashes_(hashes), folder_(folder), options_(options), progress_(options.jobs),
          meshes_(plan.meshes.size())
    {
        const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
        threads_ = std::max(1, cores / std::max(1, options.jobs));
    }

    Result<bool> run(const std::vector<size_t>& jobs);

private:
    struct Work
    {
        Job job;
        std::vector<size_t> open;   ///< sizes still to be made
        Clock::time_point before{}; ///< when the job began or made its last point
    };

    void plan(const std::vector<size_t>& jobs);
    void tellChange(const Job& job, size_t size);
    void run(Work& work);
    void attempt(Work& work);
    Result<std::shared_ptr<SweepReference>> reference(size_t mesh);
    Result<fs::path> inputOf(const Job& job, const SweepReference& reference);
    Point blank(const Job& job, size_t size, const SweepReference* reference) const;
    Status fill(Point& point, const CodedFile& coded, const Job& job, const SweepReference& reference);
    void settle(Work& work, const Point& point);
    void failOpen(Work& work, const Error& error, const SweepReference* reference);
    std::optional<Point> stored(const Job& job, size_t size) const
    {
        return storedPoint(folder_, plan_, job, size, hashes_[job.mesh], options_.samples);
    }
    double weightOf(const Job& job) const { return 1 + static_cast<double>(plan_.meshes[job.mesh].bytes); }
    const Series& seriesOf(const Job& job) const { return plan_.series[job.series]; }
    const CoderProgram& coderOf(const Job& job) const { return plan_.coders[seriesOf(job).coder]; }

    const SweepPlan& plan_;
    const std::vector<std::string>& hashes_;
    SweepFolder& folder_;
    const RunOptions& options_;
    int threads_ = 1;
    Progress progress_;
    std::vector<MeshState> meshes_;
    std::vector<Work> work_;
    std::set<size_t> changed_;        ///< meshes that tellChange() has told of
    std::map<size_t, Json> versions_; ///< by coder
    std::atomic<bool> allEndedWell_ = true;
    std::mutex errorMutex_;
    std::optional<Error> error_; ///< the folder cannot be written
};

// A mesh that is not the one its points were made of is worth a word, as they are all made again.
void Runner::tellChange(const Job& job, size_t size)
{
    const fs::path path = folder_.point(plan_.meshes[job.mesh].name, pointStem(seriesOf(job).id, size));
    const std::optional<Point> before = readPoint(path);
    if (!before || before->sha256.empty() || before->sha256 == hashes_[job.mesh]) return;
    if (changed_.insert(job.mesh).second)
        progress_.say(plan_.meshes[job.mesh].name + " has changed; its points are made again");
}

void Runner::plan(const std::vector<size_t>& jobs)
{
    for (const size_t index : jobs) {
        Work work{plan_.jobs[index], {}, {}};
        if (!coderOf(work.job).missing.empty()) continue;
        for (const size_t size : plan_.sizes) {
            if (isSettled(stored(work.job, size))) {
                progress_.found();
                continue;
            }
            tellChange(work.job, size);
            progress_.expect(seriesOf(work.job).id, weightOf(work.job));
            work.open.push_back(size);
        }
        if (work.open.empty()) continue;
        ++meshes_[work.job.mesh].jobsLeft;
        if (const size_t coder = seriesOf(work.job).coder; !versions_.contains(coder))
            versions_[coder] = versionsOf(plan_.coders[coder]);
        work_.push_back(std::move(work));
    }
}

Result<bool> Runner::run(const std::vector<size_t>& jobs)
{
    plan(jobs);
    std::atomic<size_t> next = 0;
    const auto takeJobs = [&] {
        for (size_t i; (i = next++) < work_.size();) {
            {
                const std::lock_guard lock(errorMutex_);
                if (error_) return;
            }
            run(work_[i]);
        }
    };
    std::vector<std::thread> threads;
    for (int i = 0; i < std::min<int>(options_.jobs, static_cast<int>(work_.size())); ++i)
        threads.emplace_back(takeJobs);
    for (std::thread& thread : threads) thread.join();
    progress_.clear();
    if (error_) return *error_;
    return allEndedWell_.load();
}

Result<std::shared_ptr<SweepReference>> Runner::reference(size_t mesh)
{
    MeshState& state = meshes_[mesh];
    const std::lock_guard lock(state.mutex);
    if (!state.reference) {
        state.reference =
            makeReference(plan_.meshes[mesh], hashes_[mesh], folder_, options_.samples, threads_);
        if (*state.reference && !(**state.reference)->note.empty())
            progress_.say((**state.reference)->note + "; taken as triangles without topology");
    }
    return *state.reference;
}

// What a coder gets of a mesh. Ours, and the geometry image, need a mesh fit for cutting.
Result<fs::path> Runner::inputOf(const Job& job, const SweepReference& reference)
{
    const CoderProgram& coder = coderOf(job);
    const SweepMesh& mesh = plan_.meshes[job.mesh];
    const bool isImage = coder.takesImage && isGridImage(mesh.path);
    if ((coder.ours || coder.takesImage) && !isImage && !reference.note.empty())
        return Error{ErrorKind::BadArgument, reference.note};
    if (!coder.takesImage) return reference.ply;
    MeshState& state = meshes_[job.mesh];
    const std::lock_guard lock(state.mutex);
    const int grid = seriesOf(job).grid;
    const auto known = state.images.find(grid);
    if (known != state.images.end()) return known->second;
    Result<fs::path> image = makeGridImage(mesh, hashes_[job.mesh], reference, grid, folder_, threads_);
    return state.images.emplace(grid, std::move(image)).first->second;
}

Point Runner::blank(const Job& job, size_t size, const SweepReference* reference) const
{
    Point point;
    if (reference != nullptr) {
        point.referenceFaces = reference->mesh.faceCount();
        point.diagonal = reference->diagonal;
        point.note = reference->note;
    }
    point.mesh = plan_.meshes[job.mesh].name;
    point.sha256 = hashes_[job.mesh];
    point.coder = coderOf(job).name;
    point.grid = seriesOf(job).grid;
    point.target = size;
    point.samples = options_.samples;
    point.versions = versions_.at(seriesOf(job).coder);
    return point;
}

// Measures what the coder made, keeps what is to be kept. An error makes the point a failed one.
Status Runner::fill(Point& point, const CodedFile& coded, const Job& job, const SweepReference& reference)
{
    if (!coded.unreachable.empty()) {
        point.state = Point::State::Unreachable;
        point.message = folder_.withoutFolders(coded.unreachable);
        return Done{};
    }
    if (coded.bytes > coded.target)
        return Error{ErrorKind::CodecFailure, "made a file of " + std::to_string(coded.bytes) + " bytes"};
    Mesh decoded;
    if (coderOf(job).takesImage) {
        const Result<FloatImage> image = readF32(coded.decoded.string());
        if (!image) return image.error();
        decoded = gridMesh(*image);
    } else {
        Result<Mesh> mesh = readTriangles(coded.decoded.string());
        if (!mesh) return mesh.error();
        decoded = std::move(*mesh);
    }
    const Result<SurfaceDistance> distance = reference.measure.against(decoded);
    if (!distance) return distance.error();

    const std::string stem = pointStem(seriesOf(job).id, point.target);
    const fs::path place = folder_.work(point.mesh) / (stem + coded.file.extension().string());
    Status kept =
        drawThumbnail(decoded, reference.camera, folder_, folder_.thumbnail(point.mesh, stem), threads_);
    if (kept) kept = folder_.publish(coded.file, place);
    std::error_code ignored;
    if (options_.keep && kept)
        kept = folder_.publish(coded.decoded, folder_.work(point.mesh) /
                                                  (stem + "-decoded" + coded.decoded.extension().string()));
    else
        fs::remove(coded.decoded, ignored);
    if (!kept) return kept;
    point.state = Point::State::Done;
    point.bytes = coded.bytes;
    point.faces = decoded.faceCount();
    point.distance = *distance;
    point.normalError = distance->normalRms();
    point.file = point.mesh + '/' + place.filename().string();
    point.settings = coded.settings;
    return Done{};
}

// Writes a point, whatever became of it.
void Runner::settle(Work& work, const Point& point)
{
    cli::restIfEnding();
    const Clock::time_point now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - work.before).count();
    work.before = now;
    std::erase(work.open, point.target);
    const std::string& series = seriesOf(work.job).id;
    const Status written = folder_.publishText(jsonText(toJson(point)),
                                               folder_.point(point.mesh, pointStem(series, point.target)));
    if (!written) {
        const std::lock_guard lock(errorMutex_);
        if (!error_) error_ = written.error();
    }
    progress_.finish(point.mesh, series, point.target, weightOf(work.job), seconds, outcomeOf(point));
}

// Ends all that is open with an error: a failure, or something that cannot be had.
void Runner::failOpen(Work& work, const Error& error, const SweepReference* reference)
{
    for (const size_t size : std::vector<size_t>(work.open)) {
        Point point = blank(work.job, size, reference);
        if (error.kind == ErrorKind::TargetUnreachable) point.state = Point::State::Unreachable;
        point.message = folder_.withoutFolders(error.message);
        settle(work, point);
    }
}

void Runner::attempt(Work& work)
{
    const Job& job = work.job;
    const Result<std::shared_ptr<SweepReference>> made = reference(job.mesh);
    if (!made) return failOpen(work, made.error(), nullptr);
    const SweepReference& reference = **made;
    const Result<fs::path> input = inputOf(job, reference);
    if (!input) return failOpen(work, input.error(), &reference);

    const fs::path out = folder_.jobFolder(plan_.meshes[job.mesh].name, seriesOf(job).id);
    std::error_code ignored;
    fs::create_directories(out, ignored);
    const Status coded = encodeWith(coderOf(job), *input, out, std::vector<size_t>(work.open),
                                    seriesOf(job).grid, threads_, [&](const CodedFile& file) {
                                        Point point = blank(job, file.target, &reference);
                                        const Status filled = fill(point, file, job, reference);
                                        if (!filled)
                                            point.message = folder_.withoutFolders(filled.error().message);
                                        settle(work, point);
                                    });
    fs::remove_all(out, ignored);
    if (!coded && work.open.empty()) { // every size was answered before
        progress_.say(plan_.meshes[job.mesh].name + ' ' + seriesOf(job).id + ": " +
                      folder_.withoutFolders(coded.error().message));
        allEndedWell_ = false;
    }
    failOpen(work,
             coded ? Error{ErrorKind::CodecFailure, "the coder gave no answer for this size"} : coded.error(),
             &reference);
}

void Runner::run(Work& work)
{
    work.before = Clock::now();
    std::erase_if(work.open, [&](size_t size) {
        const bool settled = isSettled(stored(work.job, size)); // another process was faster
        if (settled) progress_.overtaken(seriesOf(work.job).id, weightOf(work.job));
        return settled;
    });
    if (!work.open.empty()) attempt(work);
    MeshState& state = meshes_[work.job.mesh];
    const std::lock_guard lock(state.mutex);
    if (--state.jobsLeft == 0) state.reference.reset();
}

} // namespace

std::vector<std::string> hashMeshes(const SweepPlan& plan, const std::vector<bool>& wanted)
{
    std::vector<std::string> hashes(plan.meshes.size());
    for (size_t m = 0; m < hashes.size(); ++m)
        if (wanted[m]) hashes[m] = sha256Of(plan.meshes[m].path);
    return hashes;
}

std::optional<Point> storedPoint(const SweepFolder& folder, const SweepPlan& plan, const Job& job,
                                 size_t size, const std::string& sha256, int samples)
{
    const Series& series = plan.series[job.series];
    const std::string& mesh = plan.meshes[job.mesh].name;
    std::optional<Point> point = readPoint(folder.point(mesh, pointStem(series.id, size)));
    if (!point) return std::nullopt;
    const bool same = point->mesh == mesh && point->coder == plan.coders[series.coder].name &&
                      point->grid == series.grid && point->target == size && point->sha256 == sha256 &&
                      point->samples == samples;
    return same ? point : std::nullopt;
}

Result<bool> runJobs(const SweepPlan& plan, const std::vector<size_t>& jobs,
                     const std::vector<std::string>& hashes, SweepFolder& folder, const RunOptions& options)
{
    return Runner(plan, hashes, folder, options).run(jobs);
}

} // namespace gimg::gimrd

#include "gimg/encode.h"

#include "codec/encode.h"
#include "gimg/decode.h"
#include "gimg/distance.h"
#include "gimg/fit.h"
#include "gimg/sample.h"
#include "gimg/unfold.h"
#include "slide.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>

namespace gimg {
namespace {

class Stopwatch
{
public:
    double lap()
    {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - last_).count();
        last_ = now;
        return seconds;
    }

private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

std::string decibels(double psnr)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.2f dB", psnr);
    return text;
}

Error fromCodec(const codec::EncodeError& error)
{
    using Kind = codec::EncodeError::Kind;
    const bool target = error.kind == Kind::TooSmall || error.kind == Kind::TooLarge;
    return {target ? ErrorKind::TargetUnreachable : ErrorKind::BadArgument, error.message};
}

template <class T> Result<T> resultOf(codec::Outcome<T> outcome)
{
    if (auto* error = std::get_if<codec::EncodeError>(&outcome)) return fromCodec(*error);
    return std::move(std::get<T>(outcome));
}

Result<std::vector<uint8_t>> fileOf(codec::Outcome<codec::EncodedFile> outcome)
{
    Result<codec::EncodedFile> file = resultOf(std::move(outcome));
    if (!file) return file.error();
    return std::move(file->bytes);
}

Result<double> decodedPsnr(const std::vector<uint8_t>& file, const SurfaceMeasure& measure)
{
    const Result<DecodedImages> images = decodeImages(file);
    if (!images) return images.error();
    const Result<Mesh> mesh = levelMesh(file, *images, 0);
    if (!mesh) return mesh.error();
    if (!(surfaceArea(*mesh) > 0)) return 0.0; // so few bytes that nothing is left
    const Result<SurfaceDistance> distance = measure.against(*mesh);
    if (!distance && distance.error().kind == ErrorKind::EmptyMesh) return 0.0; // or next to nothing
    if (!distance) return distance.error();
    return distance->psnr();
}

// Normals are judged by eye, not by distance: their step is the same at any quality of the surface.
constexpr float kNormalStep = 1.0f / 32;

struct LossyFile
{
    std::vector<uint8_t> file;
    float step;
    double psnr;
};

Result<LossyFile> judged(Result<codec::EncodedFile> encoded, const SurfaceMeasure& measure)
{
    if (!encoded) return encoded.error();
    const Result<double> psnr = decodedPsnr(encoded->bytes, measure);
    if (!psnr) return psnr.error();
    return LossyFile{std::move(encoded->bytes), encoded->step, *psnr};
}

// Searches the coarsest step that reaches the target: the quality falls by about 5 dB when the step doubles,
// which tells where to try next; bisection wherever that leaves the bracket.
class PsnrSearch
{
public:
    PsnrSearch(const codec::Encoder& encoder, gim_coding coding, const SurfaceMeasure& measure, double psnr,
               const EncodeProgress& progress)
        : encoder_(encoder), coding_(coding), measure_(measure), psnr_(psnr), progress_(progress)
    {
    }

    Result<LossyFile> run()
    {
        constexpr double kFinest = 0x1p-20, kCoarsest = 0x1p8; // of the diagonal
        constexpr double kWindow = 0.5, kAim = 0.1;            // dB above the target
        constexpr int kMostSteps = 24;
        double fine = std::log(kFinest), coarse = std::log(kCoarsest);
        Result<LossyFile> kept = attempt(fine);
        if (!kept) return kept.error();
        if (kept->psnr < psnr_)
            return Error{ErrorKind::TargetUnreachable,
                         decibels(psnr_) + " cannot be reached: this grid holds the surface to " +
                             decibels(kept->psnr) + "; use a larger --grid"};
        double next = -psnr_ / 20 * std::log(10.0);
        for (int i = 0; i < kMostSteps && kept->psnr > psnr_ + 2 * kAim && coarse - fine > 1e-6; ++i) {
            if (!(next > fine && next < coarse)) next = 0.5 * (fine + coarse);
            Result<LossyFile> trial = attempt(next);
            if (!trial) return trial.error();
            if (progress_) progress_("code", (i + 1.0) / kMostSteps);
            const double excess = trial->psnr - psnr_;
            if (excess >= 0) {
                fine = next;
                kept = std::move(*trial);
            } else {
                coarse = next;
            }
            next += (excess - kAim) / 5 * std::log(2.0);
        }
        if (kept->psnr > psnr_ + kWindow)
            return Error{ErrorKind::TargetUnreachable, "no file is within 0.5 dB of " + decibels(psnr_) +
                                                           "; the nearest above has " + decibels(kept->psnr)};
        return std::move(*kept);
    }

private:
    Result<LossyFile> attempt(double logStep)
    {
        codec::Settings settings;
        settings.coding = coding_;
        settings.step = static_cast<float>(std::exp(logStep) * encoder_.diagonal());
        settings.normalStep = kNormalStep;
        return judged(resultOf(encoder_.encode(settings)), measure_);
    }

    const codec::Encoder& encoder_;
    gim_coding coding_;
    const SurfaceMeasure& measure_;
    double psnr_;
    const EncodeProgress& progress_;
};

Result<LossyFile> codeFor(const EncodeGoal& goal, const codec::Encoder& encoder,
                          const SurfaceMeasure& measure, const EncodeProgress& progress)
{
    const gim_coding coding = goal.coding == LossyCoding::Surface ? GIM_CODING_SURFACE : GIM_CODING_WAVELET;
    if (goal.target == EncodeTarget::Psnr)
        return PsnrSearch(encoder, coding, measure, goal.psnr, progress).run();
    return judged(resultOf(encoder.encodeToBytes(goal.bytes, coding)), measure);
}

// Samples are float32: what they cannot hold is refused, what they hold badly is said.
Status checkScale(const Mesh& mesh, std::vector<std::string>& warnings)
{
    constexpr double kSmallest = 1e-15, kLargest = 1e15; // squares and products of four stay in range
    constexpr double kCoarsestStep = 1e-3, kDoubtfulStep = 1e-5;
    const double diagonal = boundingBoxDiagonal(mesh);
    char text[160];
    if (!(diagonal >= kSmallest && diagonal <= kLargest)) {
        std::snprintf(text, sizeof text, "the bounding box has a diagonal of %g; it must be from %g to %g",
                      diagonal, kSmallest, kLargest);
        return Error{ErrorKind::NotFinite, text};
    }
    if (!(surfaceArea(mesh) > 0)) return Error{ErrorKind::EmptyMesh, "the surface has no area"};
    double farthest = 0;
    for (const Vec3& p : mesh.positions) farthest = std::max(farthest, p.cwiseAbs().maxCoeff());
    const double step = std::ldexp(farthest, -24) / diagonal;
    std::snprintf(text, sizeof text,
                  "coordinates reach %g: float32 samples hold them to %.2g of the diagonal only", farthest,
                  step);
    if (step > kCoarsestStep)
        return Error{ErrorKind::NotFinite, std::string(text) + "; move the surface to the origin"};
    if (step > kDoubtfulStep) warnings.push_back(text);
    return Done{};
}

bool isImageSize(int n) { return n >= 3 && n <= BorderOptions::kLargestGrid && ((n - 1) & (n - 2)) == 0; }

Result<codec::Encoder> encoderOf(const SquareDisk& square, int grid, const FloatImage& geometry,
                                 const FloatImage& normals)
{
    codec::Source source;
    source.grid = static_cast<uint32_t>(grid);
    source.seam = {static_cast<uint32_t>(square.lowest), static_cast<uint32_t>(square.start), square.seam()};
    source.xyz = geometry.samples;
    source.normalGrid = static_cast<uint32_t>(normals.width);
    source.normals = normals.samples;
    auto encoder = codec::Encoder::prepare(source);
    if (auto* error = std::get_if<codec::EncodeError>(&encoder)) return fromCodec(*error);
    return std::move(std::get<codec::Encoder>(encoder));
}

// The PSNR of what `encode` makes of an unfolding; -1 if there is no such file.
template <class Encode>
double codedPsnr(const Unfolded& unfolded, const SurfaceMeasure& measure, Encode encode)
{
    const Result<FloatImage> geometry = sampleGeometry(unfolded.square, unfolded.map, unfolded.square.grid);
    if (!geometry) return -1;
    const Result<codec::Encoder> encoder = encoderOf(unfolded.square, unfolded.square.grid, *geometry, {});
    if (!encoder) return -1;
    const Result<std::vector<uint8_t>> file = fileOf(encode(*encoder));
    if (!file) return -1;
    const Result<double> psnr = decodedPsnr(*file, measure);
    return psnr ? *psnr : -1;
}

// What an unfolding is worth. (The bare grid says little about it: seams cost bytes, and a few dB either
// way.)
double smallFilePsnr(const Unfolded& unfolded, const SurfaceMeasure& measure)
{
    return codedPsnr(unfolded, measure,
                     [](const codec::Encoder& encoder) { return encoder.encodeToBytes(6000); });
}

double barePsnr(const Unfolded& unfolded, const SurfaceMeasure& measure)
{
    codec::Settings settings;
    settings.coding = GIM_CODING_FLOAT;
    return codedPsnr(unfolded, measure,
                     [&](const codec::Encoder& encoder) { return encoder.encode(settings); });
}

struct Fitted
{
    FitGain gain;
    std::optional<FeatureReport> features;
};

Result<Fitted> fitImages(const Mesh& mesh, const SurfaceMeasure& measure, const SquareDisk& square,
                         const std::optional<FeatureOptions>& features, FloatImage& geometry,
                         FloatImage& normals)
{
    const GridSeam seam{square.lowest, square.start, square.seam()};
    Result<FittedGeometry> fitted = fitGeometry(mesh, measure, geometry, seam);
    if (!fitted) return fitted.error();
    geometry = std::move(fitted->image);
    Fitted out{{fitted->psnrBefore, fitted->psnrAfter}, std::nullopt};
    if (features) {
        Result<FeatureGeometry> followed = followFeatures(mesh, measure, geometry, seam, *features);
        if (!followed) return followed.error();
        geometry = std::move(followed->image);
        out.features = followed->report;
    }
    if (normals.width > 0) {
        Result<FloatImage> follow = fitNormals(mesh, geometry, seam, normals);
        if (!follow) return follow.error();
        normals = std::move(*follow);
    }
    return out;
}

// As many threads as asked for while it lives.
class ThreadLimit
{
public:
    explicit ThreadLimit(int threads)
    {
        if (threads > 0)
            limit_.emplace(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
    }

private:
    std::optional<tbb::global_control> limit_;
};

// Encoders for one map at several grids, each made when first asked for.
class GridEncoders
{
public:
    GridEncoders(Unfolded unfolded, FloatImage normals, bool fit, bool features)
        : unfolded_(std::move(unfolded)), normals_(std::move(normals)), fit_(fit), features_(features)
    {
    }

    struct Sampled
    {
        codec::Encoder encoder;
        FloatImage geometry, normals;
        double seamLength;
        std::optional<Fitted> fit;
        double sampleSeconds, fitSeconds;
    };

    /// @param lossy  what the samples are for: it makes a difference to those along sharp edges
    Result<std::shared_ptr<const Sampled>> at(int grid, bool lossy, const SurfaceMeasure& measure)
    {
        const std::lock_guard lock(mutex_);
        std::shared_ptr<const Sampled>& made = made_[{grid, features_ && lossy}];
        if (made) return made;
        Stopwatch watch;
        Result<FloatImage> geometry = sampleGeometry(unfolded_.square, unfolded_.map, grid);
        if (!geometry) return geometry.error();
        const double sampleSeconds = watch.lap();
        FloatImage normals = normals_;
        std::optional<Fitted> fit;
        if (fit_ && grid <= EncodeOptions::kLargestFit) {
            std::optional<FeatureOptions> features;
            if (features_) features.emplace().ease = !lossy;
            const Result<Fitted> fitted =
                fitImages(unfolded_.square.surface, measure, unfolded_.square, features, *geometry, normals);
            if (!fitted) return fitted.error();
            fit = *fitted;
        }
        const double fitSeconds = watch.lap();
        Result<codec::Encoder> encoder = encoderOf(unfolded_.square, grid, *geometry, normals);
        if (!encoder) return encoder.error();
        const double length = gimg::seamLength(unfolded_.square, *geometry);
        made = std::make_shared<const Sampled>(Sampled{std::move(*encoder), std::move(*geometry),
                                                       std::move(normals), length, fit, sampleSeconds,
                                                       fitSeconds});
        return made;
    }

    /// The encoder of samples that slid while they were coded at a step.
    Result<codec::Encoder> slid(const Sampled& sampled, float step)
    {
        const std::lock_guard lock(mutex_);
        if (!surface_) {
            Result<SlideSurface> made = SlideSurface::of(mesh());
            if (!made) return made.error();
            surface_ = std::make_shared<const SlideSurface>(std::move(*made));
        }
        Result<SampleSlide> slide = SampleSlide::of(surface_, seam(), sampled.geometry);
        if (!slide) return slide.error();
        Result<codec::Encoder> encoder = resultOf(sampled.encoder.slid(step, kSlides, *slide));
        if (!encoder || sampled.normals.width == 0) return encoder;
        // Normals belong to where the samples are now.
        FloatImage moved = sampled.geometry;
        moved.samples.assign(encoder->samples().begin(), encoder->samples().end());
        const Result<FloatImage> normals = fitNormals(mesh(), moved, seam(), sampled.normals);
        if (!normals) return normals.error();
        return encoderOf(unfolded_.square, moved.width, moved, *normals);
    }

private:
    static constexpr int kSlides = 10;

    const Mesh& mesh() const { return unfolded_.square.surface; }
    GridSeam seam() const
    {
        return {unfolded_.square.lowest, unfolded_.square.start, unfolded_.square.seam()};
    }

    const Unfolded unfolded_;
    const FloatImage normals_;
    const bool fit_, features_;
    std::shared_ptr<const SlideSurface> surface_;
    std::mutex mutex_;
    std::map<std::pair<int, bool>, std::shared_ptr<const Sampled>> made_;
};

// What to say where sharp edges were asked for in vain.
std::string objectionToFeatures(const EncodedMesh& encoded)
{
    if (!encoded.features)
        return "a grid of " + std::to_string(encoded.grid) +
               " is not fitted: its lines do not follow sharp edges";
    if (encoded.features->length == 0)
        return "no sharp edges were found: the grid is the same as without them";
    if (!encoded.features->kept)
        return "along sharp edges the grid was no closer: it is the same as without them";
    return {};
}

constexpr int kSmallestGrid = 129, kLargestGrid = 513; // that are chosen where the grid is left open

} // namespace

struct MeshEncoder::Prepared
{
    EncodedMesh report; ///< all but what coding adds
    bool features;      ///< EncodeOptions::features
    bool anyGrid;       ///< whether the goal may choose the grid
    std::unique_ptr<GridEncoders> encoders;
    SurfaceMeasure measure;
    EncodeProgress progress;
    int threads;

    Result<LossyFile> codeRaw(const GridEncoders::Sampled& sampled, const EncodeGoal& goal) const;
    Result<LossyFile> codeSliding(const GridEncoders::Sampled& sampled, const EncodeGoal& goal) const;
};

MeshEncoder::MeshEncoder(std::unique_ptr<const Prepared> prepared) : prepared_(std::move(prepared)) {}
MeshEncoder::~MeshEncoder() = default;
MeshEncoder::MeshEncoder(MeshEncoder&&) noexcept = default;
MeshEncoder& MeshEncoder::operator=(MeshEncoder&&) noexcept = default;

Result<MeshEncoder> MeshEncoder::prepare(const Mesh& mesh, const EncodeOptions& options)
{
    if (options.threads < 0) return Error{ErrorKind::BadArgument, "the number of threads is negative"};
    const ThreadLimit limit(options.threads);
    const auto stage = [&](const char* name, double fraction) {
        if (options.progress) options.progress(name, fraction);
    };

    if (options.features && !options.fit)
        return Error{ErrorKind::BadArgument, "grid lines along sharp edges need the fit"};
    if (options.normals != 0 && !isImageSize(options.normals))
        return Error{ErrorKind::BadArgument, "normal image of " + std::to_string(options.normals) +
                                                 " is not 2^k + 1 between 3 and " +
                                                 std::to_string(BorderOptions::kLargestGrid)};

    EncodedMesh out;
    if (const Status scale = checkScale(mesh, out.warnings); !scale) return scale.error();
    Stopwatch watch;
    out.topology = topology(mesh);

    stage("cut", 0);
    std::optional<SurfaceMeasure> measure; // built when needed: it takes as much memory as the mesh
    const auto measured = [&]() -> const SurfaceMeasure& {
        return measure ? *measure : measure.emplace(mesh);
    };
    double cutSeconds = 0;
    Result<Unfolded> unfolded =
        unfold(mesh, {{options.grid, options.lowest, options.layout}, options.param, options.density},
               {[&](const Unfolded& candidate) { return smallFilePsnr(candidate, measured()); },
                [&](const Unfolded& candidate) { return barePsnr(candidate, measured()); }},
               [&](const char* name, double fraction) {
                   if (cutSeconds == 0 && std::string_view(name) != "cut") cutSeconds = watch.lap();
                   stage(name, fraction);
               });
    if (!unfolded) return unfolded.error();
    const auto& [cut, layout, extrema, square, map] = *unfolded;
    out.cutNodes = cut.nodeCount();
    out.cutPaths = static_cast<int>(cut.paths.size());
    out.layout = layout;
    out.cutExtrema = extrema;
    out.grid = square.grid;
    out.lowest = square.lowest;
    if (options.grid == 0 && options.lowest == 0 && out.grid > BorderOptions::kDefaultGrid)
        out.warnings.push_back("the cut has " + std::to_string(out.cutPaths) + " paths: the grid grew to " +
                               std::to_string(out.grid) + " samples a side");
    out.param = options.param;
    out.stretchEfficiency = map.efficiency;
    out.seconds.cut = cutSeconds;
    out.seconds.parameterize = watch.lap();

    stage("sample", 0);
    Result<FloatImage> normals = FloatImage{};
    if (options.normals != 0) normals = sampleNormals(square, map, options.normals);
    if (!normals) return normals.error();
    out.normals = options.normals;
    auto encoders = std::make_unique<GridEncoders>(std::move(*unfolded), std::move(*normals), options.fit,
                                                   options.features);
    out.seconds.sample = watch.lap();
    measured();
    out.seconds.code = watch.lap();
    return MeshEncoder(std::make_unique<const Prepared>(
        Prepared{std::move(out), options.features, options.grid == 0, std::move(encoders),
                 std::move(*measure), options.progress, options.threads}));
}

Result<EncodedMesh> MeshEncoder::encode(const EncodeGoal& goal) const
{
    const ThreadLimit limit(prepared_->threads);
    if (prepared_->progress) prepared_->progress("code", 0);
    if (prepared_->anyGrid && goal.target == EncodeTarget::Bytes) return encodeAtBestGrid(goal);
    if (prepared_->anyGrid && goal.target == EncodeTarget::Psnr) return encodeAtAmpleGrid(goal);
    const bool lossy = goal.target == EncodeTarget::Bytes || goal.target == EncodeTarget::Psnr;
    return encodeAt(prepared_->report.grid, goal, lossy);
}

Result<EncodedMesh> MeshEncoder::encodeAtBestGrid(const EncodeGoal& goal) const
{
    constexpr double kWorth = 0.5; // dB
    int grid = std::max(kSmallestGrid, prepared_->report.lowest);
    Result<EncodedMesh> best = encodeAt(grid, goal, true);
    while (grid < kLargestGrid) {
        grid = 2 * grid - 1;
        Result<EncodedMesh> finer = encodeAt(grid, goal, true);
        if (best && (!finer || finer->psnr < best->psnr + kWorth)) break;
        best = std::move(finer);
    }
    return best;
}

// Near the most that a grid can hold, decibels are bought dearly: the quantisation has to make up for the
// spacing.
Result<EncodedMesh> MeshEncoder::encodeAtAmpleGrid(const EncodeGoal& goal) const
{
    constexpr double kAmple = 6; // dB
    int grid = std::max(kSmallestGrid, prepared_->report.lowest);
    for (; grid < kLargestGrid; grid = 2 * grid - 1) {
        const Result<EncodedMesh> whole = encodeAt(grid, {EncodeTarget::RawFloat}, true);
        if (!whole) return whole.error();
        if (whole->psnr >= goal.psnr + kAmple) break;
    }
    Result<EncodedMesh> encoded = encodeAt(grid, goal, true);
    if (grid == kLargestGrid && !encoded && encoded.error().kind == ErrorKind::TargetUnreachable)
        return encodeAt(2 * grid - 1, goal, true);
    return encoded;
}

Result<LossyFile> MeshEncoder::Prepared::codeRaw(const GridEncoders::Sampled& sampled,
                                                 const EncodeGoal& goal) const
{
    codec::Settings settings;
    settings.coding = goal.target == EncodeTarget::Raw12 ? GIM_CODING_RAW12 : GIM_CODING_FLOAT;
    return judged(resultOf(sampled.encoder.encode(settings)), measure);
}

// The samples slide for the step that reaches the goal without.
Result<LossyFile> MeshEncoder::Prepared::codeSliding(const GridEncoders::Sampled& sampled,
                                                     const EncodeGoal& goal) const
{
    Result<LossyFile> still = codeFor(goal, sampled.encoder, measure, progress);
    if (!still || goal.coding != LossyCoding::Surface) return still;
    const Result<codec::Encoder> moved = encoders->slid(sampled, still->step);
    if (!moved) return moved.error();
    Result<LossyFile> slid = codeFor(goal, *moved, measure, progress);
    if (!slid) return still;
    const bool better =
        goal.target == EncodeTarget::Psnr ? slid->file.size() < still->file.size() : slid->psnr > still->psnr;
    return better ? std::move(slid) : std::move(still);
}

Result<EncodedMesh> MeshEncoder::encodeAt(int grid, const EncodeGoal& goal, bool lossy) const
{
    Stopwatch watch;
    const auto sampled = prepared_->encoders->at(grid, lossy, prepared_->measure);
    if (!sampled) return sampled.error();
    watch.lap();
    Result<LossyFile> coded = goal.target == EncodeTarget::Raw12 || goal.target == EncodeTarget::RawFloat
                                  ? prepared_->codeRaw(**sampled, goal)
                                  : prepared_->codeSliding(**sampled, goal);
    if (!coded) return coded.error();

    EncodedMesh out = prepared_->report;
    out.grid = grid;
    out.cutLength = (*sampled)->seamLength;
    if ((*sampled)->fit) {
        out.fit = (*sampled)->fit->gain;
        out.features = (*sampled)->fit->features;
    }
    out.seconds.sample += (*sampled)->sampleSeconds;
    out.seconds.fit = (*sampled)->fitSeconds;
    out.file = std::move(coded->file);
    out.psnr = coded->psnr;
    if (prepared_->features)
        if (std::string what = objectionToFeatures(out); !what.empty())
            out.warnings.push_back(std::move(what));
    if (out.psnr == 0)
        out.warnings.emplace_back("the decoded surface has hardly any area: its PSNR counts as 0 dB");
    out.seconds.code += watch.lap();
    return out;
}

Result<EncodedMesh> encodeMesh(const Mesh& mesh, const EncodeOptions& options)
{
    const Result<MeshEncoder> encoder = MeshEncoder::prepare(mesh, options);
    if (!encoder) return encoder.error();
    return encoder->encode(options);
}

} // namespace gimg

#include "gimg/encode.h"

#include "gimg/conformal_image.h"
#include "gimg/decode.h"
#include "gimg/sample.h"
#include "gimg/stretch.h"
#include "gimg/unfold.h"
#include "prepared.h"
#include "rate_search.h"
#include "sliding_coder.h"
#include "stopwatch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string_view>

namespace gimg {
namespace {

bool isImageSize(int n) { return n >= 3 && n <= BorderOptions::kLargestGrid && ((n - 1) & (n - 2)) == 0; }

GridSeam seamOf(const SquareDisk& square) { return {square.lowest, square.start, square.seam()}; }

// The PSNR of what `encode` makes of an unfolding; -1 if there is no such file.
template <class Encode> double codedPsnr(const Unfolded& unfolded, Encode encode)
{
    const Result<FloatImage> geometry = sampleGeometry(unfolded.square, unfolded.map, unfolded.square.grid);
    if (!geometry) return -1;
    const Result<codec::Encoder> encoder = encoderOf(seamOf(unfolded.square), *geometry, {});
    if (!encoder) return -1;
    const Result<CodedFile> file = encode(*encoder);
    return file ? file->psnr : -1;
}

// What an unfolding is worth. (The bare grid says little about it: seams cost bytes, and a few dB either
// way.)
double smallFilePsnr(const Unfolded& unfolded, const SurfaceMeasure& measure)
{
    const EncodeGoal goal{EncodeTarget::Bytes, 6000};
    return codedPsnr(unfolded, [&](const codec::Encoder& encoder) {
        return codeFor(goal, Precision::Step, encoder, measure, {});
    });
}

double barePsnr(const Unfolded& unfolded, const SurfaceMeasure& measure)
{
    return codedPsnr(unfolded, [&](const codec::Encoder& encoder) {
        return codeRaw(EncodeTarget::RawFloat, encoder, measure);
    });
}

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

// What to say where the largest error is well below the one asked for.
std::string objectionToError(const CodedFile& coded, const EncodeGoal& goal)
{
    if (goal.target != EncodeTarget::MaxError || coded.maxError >= 0.98 * goal.maxError) return {};
    return "no file was found nearer to " + describeQuality(askedQuality(goal), EncodeTarget::MaxError) +
           " than one of " + describeQuality(quality(coded, EncodeTarget::MaxError), EncodeTarget::MaxError);
}

bool isSearched(EncodeTarget target)
{
    return target == EncodeTarget::Psnr || target == EncodeTarget::MaxError;
}

constexpr int kSmallestGrid = 129, kLargestGrid = 513; // that are chosen where the grid is left open

using Stage = std::function<void(const char* name, double fraction)>;

// A surface on the square by way of a cut or a star, and what there is to report of it.
Result<GridSource> unfoldedSource(const Mesh& mesh, const EncodeOptions& options,
                                  const std::function<const SurfaceMeasure&()>& measured, const Stage& stage,
                                  EncodedMesh& out)
{
    Stopwatch watch;
    stage("cut", 0);
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
    out.stretchEfficiency = map.efficiency;
    out.seconds.cut = cutSeconds;
    out.seconds.parameterize = watch.lap();

    stage("sample", 0);
    GridSource source;
    if (options.normals != 0) {
        Result<FloatImage> normals = sampleNormals(square, map, options.normals);
        if (!normals) return normals.error();
        source.normals = std::move(*normals);
    }
    const auto shared = std::make_shared<const Unfolded>(std::move(*unfolded));
    source.surface = {shared, &shared->square.surface};
    source.seam = seamOf(shared->square);
    source.sample = [shared](int grid) { return sampleGeometry(shared->square, shared->map, grid); };
    out.seconds.sample = watch.lap();
    return source;
}

// That of the triangles that a grid spans.
double gridEfficiency(const FloatImage& geometry)
{
    std::vector<Vec2> st;
    for (int j = 0; j < geometry.height; ++j)
        for (int i = 0; i < geometry.width; ++i) st.push_back(Vec2(i, j) / (geometry.width - 1));
    return stretchEfficiency(gridMesh(geometry), st);
}

// A surface on the square by way of the sphere.
Result<GridSource> conformalSource(const Mesh& mesh, const EncodeOptions& options, const Stage& stage,
                                   EncodedMesh& out)
{
    constexpr int kLowest = 33, kSmallest = 5;
    if (options.layout == SquareLayout::Cut)
        return Error{ErrorKind::BadArgument, "the conformal map comes in the octahedral layout only"};
    out.layout = SquareLayout::Octahedral;
    out.grid = options.grid != 0 ? options.grid : BorderOptions::kDefaultGrid;
    out.lowest =
        options.lowest != 0 ? options.lowest : std::min(kLowest, std::max(kSmallest, (out.grid - 1) / 4 + 1));
    if (!isImageSize(out.grid) || !isImageSize(out.lowest) || out.lowest < kSmallest || out.lowest > out.grid)
        return Error{ErrorKind::BadArgument, "a grid of " + std::to_string(out.grid) +
                                                 " with a lowest level of " + std::to_string(out.lowest) +
                                                 ": both must be 2^k + 1, from 5 to " +
                                                 std::to_string(BorderOptions::kLargestGrid) +
                                                 ", and the level no larger than the grid"};
    Stopwatch watch;
    stage("parameterize", 0);
    Result<ConformalSquare> conformal =
        ConformalSquare::of(mesh, [&](double fraction) { stage("parameterize", fraction); });
    if (!conformal) return conformal.error();
    out.cutNodes = 5; // the centre of a star and its tips
    out.cutPaths = 4;
    const auto shared = std::make_shared<const ConformalSquare>(std::move(*conformal));
    out.seconds.parameterize = watch.lap();

    stage("sample", 0);
    GridSource source;
    source.surface = {shared, &shared->surface()};
    source.seam = foldedSquareSeam(out.lowest);
    source.sample = [shared](int grid) { return shared->geometry(grid); };
    const Result<FloatImage> geometry = shared->geometry(BorderOptions::kDefaultGrid);
    if (!geometry) return geometry.error();
    out.stretchEfficiency = gridEfficiency(*geometry);
    if (options.normals != 0) {
        Result<FloatImage> normals = shared->normals(options.normals);
        if (!normals) return normals.error();
        source.normals = std::move(*normals);
    }
    out.seconds.sample = watch.lap();
    return source;
}

} // namespace

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

std::optional<Error> objectionTo(const EncodeOptions& options)
{
    const auto bad = [](std::string why) { return Error{ErrorKind::BadArgument, std::move(why)}; };
    if (options.threads < 0) return bad("the number of threads is negative");
    if (options.effort < EncodeOptions::kLeastEffort || options.effort > EncodeOptions::kMostEffort)
        return bad("effort " + std::to_string(options.effort) + " is not from 1 to 9");
    if (options.smoothLevels < 0 || (options.grid != 0 && (options.grid - 1) >> options.smoothLevels < 2))
        return bad(std::to_string(options.smoothLevels) + " smooth levels are more than the grid has");
    if (options.smoothLevels > 0 &&
        (options.coding != LossyCoding::Surface || options.target == EncodeTarget::Raw12 ||
         options.target == EncodeTarget::RawFloat))
        return bad("smooth levels are for the surface coding");
    if (options.features && !options.fit) return bad("grid lines along sharp edges need the fit");
    if (options.normals != 0 && !isImageSize(options.normals))
        return bad("normal image of " + std::to_string(options.normals) + " is not 2^k + 1 between 3 and " +
                   std::to_string(BorderOptions::kLargestGrid));
    return std::nullopt;
}

MeshEncoder::MeshEncoder(std::unique_ptr<const Prepared> prepared) : prepared_(std::move(prepared)) {}
MeshEncoder::~MeshEncoder() = default;
MeshEncoder::MeshEncoder(MeshEncoder&&) noexcept = default;
MeshEncoder& MeshEncoder::operator=(MeshEncoder&&) noexcept = default;

Result<MeshEncoder> MeshEncoder::prepare(const Mesh& mesh, const EncodeOptions& options)
{
    if (const std::optional<Error> error = objectionTo(options)) return *error;
    const ThreadLimit limit(options.threads);
    const auto stage = [&](const char* name, double fraction) {
        if (options.progress) options.progress(name, fraction);
    };

    std::shared_ptr<const AttributeSampler> attributes;
    if (!options.attributes.empty()) {
        Result<AttributeSampler> sampler = AttributeSampler::of(
            options.attributed ? *options.attributed : AttributedSurface{}, options.attributes);
        if (!sampler) return sampler.error();
        attributes = std::make_shared<const AttributeSampler>(std::move(*sampler));
    }
    EncodedMesh out;
    if (const Status scale = checkScale(mesh, out.warnings); !scale) return scale.error();
    out.topology = topology(mesh);
    out.param = options.param;
    out.normals = options.normals;

    std::optional<SurfaceMeasure> measure; // built when needed: it takes as much memory as the mesh
    std::once_flag isBuilt;
    const auto measured = [&]() -> const SurfaceMeasure& {
        std::call_once(isBuilt, [&] { measure.emplace(options.reference ? *options.reference : mesh); });
        return *measure;
    };
    const bool torus = out.topology.genus == 1 && out.topology.boundaries == 0;
    Result<GridSource> source = options.param == MapKind::Conformal && !torus
                                    ? conformalSource(mesh, options, stage, out)
                                    : unfoldedSource(mesh, options, measured, stage, out);
    if (!source) return source.error();
    const Effort effort = Effort::of(options);
    source->attributes = std::move(attributes);
    source->fitRounds = options.fit ? effort.fitRounds : 0;
    source->refits = options.fit;
    source->features = options.features;
    source->smoothLevels = options.smoothLevels;
    Stopwatch watch;
    measured();
    out.seconds.code = watch.lap();
    return MeshEncoder(
        std::make_unique<const Prepared>(Prepared{std::move(out), options.features, options.grid == 0, effort,
                                                  std::make_unique<GridEncoders>(std::move(*source)),
                                                  std::move(*measure), options.progress, options.threads}));
}

Result<EncodedMesh> MeshEncoder::encode(const EncodeGoal& goal) const
{
    if (goal.target == EncodeTarget::MaxError && !(goal.maxError > 0 && goal.maxError < 1))
        return Error{ErrorKind::BadArgument,
                     "the largest error is a fraction of the diagonal, above 0 and below 1"};
    const ThreadLimit limit(prepared_->threads);
    if (prepared_->progress) prepared_->progress("code", 0);
    if (prepared_->anyGrid && goal.target == EncodeTarget::Bytes) return encodeAtBestGrid(goal);
    if (prepared_->anyGrid && isSearched(goal.target)) return encodeAtAmpleGrid(goal);
    return encodeAt(prepared_->report.grid, goal,
                    goal.target == EncodeTarget::Bytes || isSearched(goal.target));
}

Result<EncodedMesh> MeshEncoder::encodeAtBestGrid(const EncodeGoal& goal) const
{
    int grid = std::max(kSmallestGrid, prepared_->report.lowest);
    Result<EncodedMesh> best = encodeAt(grid, goal, true, true);
    while (grid < kLargestGrid) {
        grid = 2 * grid - 1;
        Result<EncodedMesh> finer = encodeAt(grid, goal, true, true);
        if (best && (!finer || finer->psnr < best->psnr + prepared_->effort.gridWorth)) break;
        best = std::move(finer);
    }
    const Effort& effort = prepared_->effort;
    const bool isMore = effort.refits > 0 || !effort.slidesForPrefixes.empty();
    return best && isMore ? encodeAt(best->grid, goal, true) : std::move(best);
}

// Near the most that a grid can hold, decibels are bought dearly: the quantisation has to make up for the
// spacing. Where finer grids hold no more, it is not the spacing.
Result<EncodedMesh> MeshEncoder::encodeAtAmpleGrid(const EncodeGoal& goal) const
{
    constexpr double kAmple = 6, kMore = 0.5; // dB
    const double asked = askedQuality(goal);
    const auto held = [&](int grid) -> Result<double> {
        const auto sampled = prepared_->encoders->at(grid, true, prepared_->measure);
        if (!sampled) return sampled.error();
        const Result<CodedFile> whole =
            codeRaw(EncodeTarget::RawFloat, (*sampled)->encoder, prepared_->measure);
        if (!whole) return whole.error();
        return quality(*whole, goal.target);
    };
    int grid = std::max(kSmallestGrid, prepared_->report.lowest);
    double before = 0;
    for (; grid < kLargestGrid; grid = 2 * grid - 1) {
        const Result<double> now = held(grid);
        if (!now) return now.error();
        if (before >= asked && *now < before + kMore) {
            grid = (grid + 1) / 2;
            break;
        }
        if (*now >= asked + kAmple) break;
        before = *now;
    }
    Result<EncodedMesh> encoded = encodeAt(grid, goal, true);
    if (grid == kLargestGrid && !encoded && encoded.error().kind == ErrorKind::TargetUnreachable)
        return encodeAt(2 * grid - 1, goal, true);
    return encoded;
}

Result<EncodedMesh> MeshEncoder::encodeAt(int grid, const EncodeGoal& goal, bool lossy) const
{
    return encodeAt(grid, goal, lossy, false);
}

Result<EncodedMesh> MeshEncoder::encodeAt(int grid, const EncodeGoal& goal, bool lossy, bool isTrial) const
{
    Effort effort = prepared_->effort;
    if (isTrial) {
        effort.refits = 0;
        effort.slidesForPrefixes.clear();
    }
    Stopwatch watch;
    const auto sampled = prepared_->encoders->at(grid, lossy, prepared_->measure);
    if (!sampled) return sampled.error();
    watch.lap();
    Result<CodedFile> coded = lossy ? codeSliding(effort, *prepared_->encoders, **sampled, prepared_->measure,
                                                  goal, prepared_->progress)
                                    : codeRaw(goal.target, (*sampled)->encoder, prepared_->measure);
    if (!coded) return coded.error();
    if (prepared_->encoders->hasFields()) {
        Result<std::vector<uint8_t>> file =
            prepared_->encoders->withFields(std::move(coded->bytes), **sampled, goal);
        if (!file) return file.error();
        coded->bytes = std::move(*file);
    }

    EncodedMesh out = prepared_->report;
    out.grid = grid;
    out.cutLength = (*sampled)->seamLength;
    out.fit = (*sampled)->fit;
    out.features = (*sampled)->features;
    out.seconds.sample += (*sampled)->sampleSeconds;
    out.seconds.fit = (*sampled)->fitSeconds;
    out.psnr = coded->psnr;
    out.maxError = coded->maxError;
    const std::string objections[] = {prepared_->features ? objectionToFeatures(out) : "",
                                      objectionToError(*coded, goal)};
    for (const std::string& what : objections)
        if (!what.empty()) out.warnings.push_back(what);
    if (out.psnr == 0)
        out.warnings.emplace_back("the decoded surface has hardly any area: its PSNR counts as 0 dB");
    out.file = std::move(coded->bytes);
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

#include "grid_encoders.h"

#include "codec/field_set.h"
#include "gimg/decode.h"
#include "gimg/fit.h"
#include "gimg/sample.h"
#include "rate_search.h"
#include "stopwatch.h"

#include <exception>

namespace gimg {

Status GridEncoders::fit(bool lossy, const SurfaceMeasure& measure, FloatImage& geometry, FloatImage& normals,
                         std::optional<FitGain>& gain, std::optional<FeatureReport>& features) const
{
    const Mesh& mesh = *source_.surface;
    FitOptions options;
    options.rounds = source_.fitRounds;
    Result<FittedGeometry> fitted = fitGeometry(mesh, measure, geometry, source_.seam, options);
    if (!fitted) return fitted.error();
    geometry = std::move(fitted->image);
    gain = {fitted->psnrBefore, fitted->psnrAfter};
    if (source_.features) {
        FeatureOptions follow;
        follow.ease = !lossy;
        Result<FeatureGeometry> followed = followFeatures(mesh, measure, geometry, source_.seam, follow);
        if (!followed) return followed.error();
        geometry = std::move(followed->image);
        features = followed->report;
    }
    if (normals.width > 0) {
        Result<FloatImage> follow = fitNormals(mesh, geometry, source_.seam, normals);
        if (!follow) return follow.error();
        normals = std::move(*follow);
    }
    return Done{};
}

Result<std::shared_ptr<const GridEncoders::Sampled>> GridEncoders::at(int grid, bool lossy,
                                                                      const SurfaceMeasure& measure)
{
    const std::lock_guard lock(mutex_);
    std::shared_ptr<const Sampled>& made = made_[{grid, source_.features && lossy}];
    if (made) return made;
    Stopwatch watch;
    Result<FloatImage> geometry = source_.sample(grid);
    if (!geometry) return geometry.error();
    const double sampleSeconds = watch.lap();
    FloatImage normals = source_.normals;
    std::optional<FitGain> gain;
    std::optional<FeatureReport> features;
    if (source_.fitRounds > 0 && grid <= EncodeOptions::kLargestFit)
        if (const Status fitted = fit(lossy, measure, *geometry, normals, gain, features); !fitted)
            return fitted.error();
    const double fitSeconds = watch.lap();
    Result<std::vector<SampledAttribute>> attributes = attributesAt(*geometry);
    if (!attributes) return attributes.error();
    Result<codec::Encoder> encoder =
        encoderOf(source_.seam, *geometry, normals, *attributes, source_.smoothLevels);
    if (!encoder) return encoder.error();
    const double length = seamLength(source_.seam, *geometry);
    made =
        std::make_shared<const Sampled>(Sampled{std::move(*encoder), std::move(*geometry), std::move(normals),
                                                length, gain, features, sampleSeconds, fitSeconds});
    return made;
}

Result<std::vector<SampledAttribute>> GridEncoders::attributesAt(const FloatImage& geometry) const
{
    if (!source_.attributes) return std::vector<SampledAttribute>{};
    return source_.attributes->at(geometry, source_.seam);
}

Result<std::vector<uint8_t>> GridEncoders::withFields(std::vector<uint8_t> file, const Sampled& sampled,
                                                      const EncodeGoal& goal) const
{
    const Result<DecodedImages> images = decodeImages(file);
    if (!images) return images.error();
    const bool lossy = goal.target != EncodeTarget::Raw12 && goal.target != EncodeTarget::RawFloat;
    Result<FloatImage> normals = sampled.normals;
    if (normals->width > 0 && lossy)
        normals = fitNormals(*source_.surface, images->geometry, source_.seam, sampled.normals);
    if (!normals) return normals.error();
    const Result<std::vector<SampledAttribute>> attributes = attributesAt(images->geometry);
    if (!attributes) return attributes.error();
    const Result<codec::FieldSet> fields =
        resultOf(codec::FieldSet::prepare(sourceOf(source_.seam, images->geometry, *normals, *attributes)));
    if (!fields) return fields.error();
    Result<codec::EncodedFile> made = resultOf(
        codec::withFields(file, *fields, fieldSettings(goal),
                          goal.target == EncodeTarget::Bytes ? std::optional(goal.bytes) : std::nullopt));
    if (made) return std::move(made->bytes);
    // So few bytes that only what was coded first fits.
    if (made.error().kind == ErrorKind::TargetUnreachable) return file;
    return made.error();
}

Result<GridEncoders::Slide> GridEncoders::slide(const Sampled& sampled)
{
    const std::lock_guard lock(mutex_);
    if (!slideSurface_) {
        Result<SlideSurface> made = SlideSurface::of(*source_.surface);
        if (!made) return made.error();
        slideSurface_ = std::make_shared<const SlideSurface>(std::move(*made));
    }
    Result<SampleSlide> slide = SampleSlide::of(slideSurface_, source_.seam, sampled.geometry);
    if (!slide) return slide.error();
    return Slide(*this, sampled, std::move(*slide));
}

Status GridEncoders::Slide::move(float step, const codec::Slides& slides)
{
    Result<codec::Encoder> moved = resultOf(
        encoder_.slid(step, slides, [this](std::span<const float> decoded, std::span<float> targets) {
            slide_(decoded, targets);
        }));
    if (!moved) return moved.error();
    encoder_ = std::move(*moved);
    return Done{};
}

bool GridEncoders::Slide::mayRefit() const
{
    return encoders_->source_.refits && sampled_->geometry.width <= EncodeOptions::kLargestFit;
}

Status GridEncoders::Slide::refit(const FloatImage& decoded)
try {
    constexpr int kRounds = 2;
    constexpr double kSmoothing = 0; // decoded samples lie where they cost little: they stay there
    const GridSource& source = encoders_->source_;
    const Result<GluedGrid> grid = gridOf(decoded, source.seam);
    if (!grid) return grid.error();
    if (!rounds_) rounds_ = std::make_shared<FitRounds>(*source.surface, decoded.width * decoded.height);
    const FloatImage fitted = rounds_->run(*grid, decoded, kRounds, kSmoothing);
    Result<codec::Encoder> encoder = encoderOf(source.seam, fitted, {}, {}, source.smoothLevels);
    if (!encoder) return encoder.error();
    Result<SampleSlide> slide = SampleSlide::of(encoders_->slideSurface_, source.seam, fitted);
    if (!slide) return slide.error();
    encoder_ = std::move(*encoder);
    slide_ = std::move(*slide);
    return Done{};
} catch (const std::exception& failure) {
    return Error{ErrorKind::BadArgument, failure.what()};
}

} // namespace gimg

#include "grid_encoders.h"

#include "gimg/fit.h"
#include "gimg/sample.h"
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
    Result<codec::Encoder> encoder = encoderOf(source_.seam, *geometry, normals);
    if (!encoder) return encoder.error();
    const double length = seamLength(source_.seam, *geometry);
    made =
        std::make_shared<const Sampled>(Sampled{std::move(*encoder), std::move(*geometry), std::move(normals),
                                                length, gain, features, sampleSeconds, fitSeconds});
    return made;
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

Status GridEncoders::Slide::move(float step, int rounds, double octaves)
{
    Result<codec::Encoder> moved = resultOf(encoder_.slid(
        step, rounds, octaves,
        [this](std::span<const float> decoded, std::span<float> targets) { slide_(decoded, targets); }));
    if (!moved) return moved.error();
    encoder_ = std::move(*moved);
    return Done{};
}

bool GridEncoders::Slide::mayRefit() const
{
    return encoders_.source_.refits && sampled_.geometry.width <= EncodeOptions::kLargestFit;
}

Status GridEncoders::Slide::refit(const FloatImage& decoded)
try {
    constexpr int kRounds = 2;
    constexpr double kSmoothing = 0; // decoded samples lie where they cost little: they stay there
    const GridSource& source = encoders_.source_;
    const Result<GluedGrid> grid = gridOf(decoded, source.seam);
    if (!grid) return grid.error();
    if (!rounds_) rounds_ = std::make_shared<FitRounds>(*source.surface, decoded.width * decoded.height);
    const FloatImage fitted = rounds_->run(*grid, decoded, kRounds, kSmoothing);
    Result<codec::Encoder> encoder = encoderOf(source.seam, fitted, {});
    if (!encoder) return encoder.error();
    Result<SampleSlide> slide = SampleSlide::of(encoders_.slideSurface_, source.seam, fitted);
    if (!slide) return slide.error();
    encoder_ = std::move(*encoder);
    slide_ = std::move(*slide);
    return Done{};
} catch (const std::exception& failure) {
    return Error{ErrorKind::BadArgument, failure.what()};
}

Result<codec::Encoder> GridEncoders::Slide::finished() const
{
    if (sampled_.normals.width == 0) return encoder_;
    // Normals belong to where the samples are now.
    const GridSource& source = encoders_.source_;
    FloatImage moved = sampled_.geometry;
    moved.samples.assign(encoder_.samples().begin(), encoder_.samples().end());
    const Result<FloatImage> normals = fitNormals(*source.surface, moved, source.seam, sampled_.normals);
    if (!normals) return normals.error();
    return encoderOf(source.seam, moved, *normals);
}

} // namespace gimg

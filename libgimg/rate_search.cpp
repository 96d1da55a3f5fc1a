#include "rate_search.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace gimg {
namespace {

// Normals are judged by eye, not by distance: their step is the same at any quality of the surface.
constexpr float kNormalStep = 1.0f / 32;

constexpr double kFinest = 0x1p-20, kCoarsest = 0x1p8; // steps, of the diagonal
constexpr double kSlope = 5;                           // dB that doubling the step costs, about
constexpr double kLooseWindow = 1;                     // dB

// Above the target, in dB: the largest error within 2 %.
double windowOf(EncodeTarget target, Precision precision)
{
    if (precision == Precision::Step) return kLooseWindow;
    return target == EncodeTarget::Psnr ? 0.2 : -20 * std::log10(0.98);
}

// Finds a step whose quality lies in a window above the target. Quality falls with the step, on the whole:
// the largest error is one sample's, and jumps up and down by some percent between steps that hardly differ.
// So the step is closed in on, and where the two sides of a jump are left, steps around them are tried.
class StepSearch
{
public:
    StepSearch(const EncodeGoal& goal, Precision precision, const codec::Encoder& encoder,
               const SurfaceMeasure& measure, const EncodeProgress& progress)
        : target_(goal.target), asked_(askedQuality(goal)), window_(windowOf(goal.target, precision)),
          encoder_(encoder), measure_(measure), progress_(progress)
    {
        settings_ = fieldSettings(goal);
    }

    Result<CodedFile> run()
    {
        if (const Status found = closeIn(); !found) return found.error();
        if (!isMet() && !atCoarsest_ && (!best_ || quality(*best_, target_) - asked_ < kHopeless))
            if (const Status found = scan(); !found) return found.error();
        if (!best_)
            return Error{ErrorKind::TargetUnreachable,
                         "no file was found that reaches " + describeQuality(asked_, target_)};
        if (!isMet() && target_ == EncodeTarget::Psnr && window_ < kLooseWindow)
            return Error{ErrorKind::TargetUnreachable,
                         "no file is within 0.2 dB of " + describeQuality(asked_, target_) +
                             "; the nearest above has " + describeQuality(quality(*best_, target_), target_)};
        return std::move(*best_);
    }

private:
    static constexpr double kHopeless = 2; // dB: a jump so high is no accident of the step
    static constexpr int kDoubtful = 3, kMostClosing = 24, kMostTrials = 48;

    struct End
    {
        double logStep, excess = 0;
        bool tried = false;
    };

    bool isMet() const { return best_ && quality(*best_, target_) - asked_ <= window_; }

    Error unreachable(double reached) const
    {
        return {ErrorKind::TargetUnreachable,
                describeQuality(asked_, target_) + " cannot be reached: this grid holds the surface to " +
                    describeQuality(reached, target_) + "; use a larger --grid"};
    }

    Status closeIn()
    {
        const double finest = fine_.logStep, coarsest = coarse_.logStep;
        double next = std::clamp(-asked_ / 20 * std::log(10.0), finest, coarsest);
        while (!isMet() && trials_ < kMostClosing && coarse_.logStep - fine_.logStep > 1e-4) {
            const Result<double> excess = attempt(next);
            if (!excess) return excess.error();
            (*excess >= 0 ? fine_ : coarse_) = {next, *excess, true};
            if (next == finest && *excess < 0) return unreachable(*excess + asked_);
            atCoarsest_ = next == coarsest && *excess >= 0;
            if (atCoarsest_) break;
            if (!best_ && trials_ == kDoubtful)
                if (const Status possible = checkSamples(); !possible) return possible.error();
            next = proposal(next, *excess);
        }
        return Done{};
    }

    // Whether it would do not to quantise at all.
    Status checkSamples() const
    {
        const Result<CodedFile> exact = codeRaw(EncodeTarget::RawFloat, encoder_, measure_);
        if (!exact) return exact.error();
        if (quality(*exact, target_) < asked_) return unreachable(quality(*exact, target_));
        return Done{};
    }

    double proposal(double last, double excess) const
    {
        const double aim = window_ / 2;
        if (!fine_.tried || !coarse_.tried) {
            // From one side, until there is another.
            const double by = (excess - aim) / kSlope * std::log(2.0);
            const double least = 0.1 * (1 + trials_);
            const double next = last + (excess >= 0 ? std::max(by, least) : std::min(by, -least));
            return std::clamp(next, fine_.logStep, coarse_.logStep);
        }
        double part = (fine_.excess - aim) / (fine_.excess - coarse_.excess);
        if (trials_ % 3 == 2 || !std::isfinite(part)) part = 0.5;
        part = std::clamp(part, 0.05, 0.95);
        return fine_.logStep + part * (coarse_.logStep - fine_.logStep);
    }

    Status scan()
    {
        constexpr double kApart = 0.003;
        const double middle = 0.5 * (fine_.logStep + coarse_.logStep);
        for (int k = 2; !isMet() && trials_ < kMostTrials; ++k) {
            const int away = k / 2; // farther and farther: few coefficients change slowly
            const Result<double> excess =
                attempt(middle + (k % 2 == 0 ? -1 : 1) * away * (1 + 0.1 * away) * kApart);
            if (!excess) return excess.error();
        }
        return Done{};
    }

    // Returns the quality above what is asked for; keeps the file if it is the best yet.
    Result<double> attempt(double logStep)
    {
        settings_.step = static_cast<float>(std::exp(logStep) * encoder_.diagonal());
        Result<CodedFile> trial = judged(resultOf(encoder_.encode(settings_)), measure_);
        if (!trial) return trial.error();
        ++trials_;
        if (progress_) progress_("code", std::min(1.0, static_cast<double>(trials_) / kMostClosing));
        const double reached = quality(*trial, target_);
        if (reached >= asked_ && (!best_ || reached < quality(*best_, target_))) best_ = std::move(*trial);
        return reached - asked_;
    }

    EncodeTarget target_;
    double asked_, window_;
    const codec::Encoder& encoder_;
    const SurfaceMeasure& measure_;
    const EncodeProgress& progress_;
    codec::Settings settings_;
    End fine_{std::log(kFinest)}, coarse_{std::log(kCoarsest)};
    std::optional<CodedFile> best_;
    int trials_ = 0;
    bool atCoarsest_ = false; ///< not even the coarsest step is too coarse
};

} // namespace

codec::Settings fieldSettings(const EncodeGoal& goal)
{
    codec::Settings settings;
    settings.coding = goal.target == EncodeTarget::Raw12      ? GIM_CODING_RAW12
                      : goal.target == EncodeTarget::RawFloat ? GIM_CODING_FLOAT
                      : goal.coding == LossyCoding::Surface   ? GIM_CODING_SURFACE
                                                              : GIM_CODING_WAVELET;
    settings.normalStep = kNormalStep;
    return settings;
}

double quality(const CodedFile& file, EncodeTarget target)
{
    return target == EncodeTarget::MaxError ? -20 * std::log10(file.maxError) : file.psnr;
}

double askedQuality(const EncodeGoal& goal)
{
    return goal.target == EncodeTarget::MaxError ? -20 * std::log10(goal.maxError) : goal.psnr;
}

float stepToMeet(const EncodeGoal& goal, const CodedFile& file)
{
    if (goal.target == EncodeTarget::Bytes) return file.step;
    const double excess = std::clamp(quality(file, goal.target) - askedQuality(goal), 0.0, kLooseWindow);
    return static_cast<float>(file.step * std::exp2(excess / kSlope));
}

std::string describeQuality(double quality, EncodeTarget target)
{
    char text[48];
    if (target == EncodeTarget::MaxError)
        std::snprintf(text, sizeof text, "a largest error of %.4g", std::pow(10, -quality / 20));
    else
        std::snprintf(text, sizeof text, "%.2f dB", quality);
    return text;
}

Result<CodedFile> codeFor(const EncodeGoal& goal, Precision precision, const codec::Encoder& encoder,
                          const SurfaceMeasure& measure, const EncodeProgress& progress)
{
    const gim_coding coding = goal.coding == LossyCoding::Surface ? GIM_CODING_SURFACE : GIM_CODING_WAVELET;
    if (goal.target == EncodeTarget::Bytes)
        return judged(resultOf(encoder.encodeToBytes(goal.bytes, coding)), measure);
    return StepSearch(goal, precision, encoder, measure, progress).run();
}

Result<CodedFile> codeRaw(EncodeTarget target, const codec::Encoder& encoder, const SurfaceMeasure& measure)
{
    codec::Settings settings;
    settings.coding = target == EncodeTarget::Raw12 ? GIM_CODING_RAW12 : GIM_CODING_FLOAT;
    return judged(resultOf(encoder.encode(settings)), measure);
}

} // namespace gimg

#include "sliding_coder.h"

#include "rate_search.h"

#include "gimg/decode.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

namespace gimg {

namespace {

/// Codes for a goal in one set of ways.
class SlidingCoder
{
public:
    /// @param ways      not empty
    /// @param prefixes  whether files are compared by their prefixes, too
    SlidingCoder(std::span<const codec::Slides> ways, bool prefixes, GridEncoders& encoders,
                 const GridEncoders::Sampled& sampled, const SurfaceMeasure& measure, const EncodeGoal& goal,
                 EncodeProgress progress)
        : ways_(ways), prefixes_(prefixes), encoders_(&encoders), sampled_(&sampled), measure_(&measure),
          goal_(goal), progress_(std::move(progress))
    {
    }

    Result<CodedFile> code(int refits) const;

private:
    struct Candidate
    {
        CodedFile file;
        double worth; ///< what files for the goal are compared by
    };

    Result<double> worthOf(const CodedFile& file) const;
    Result<Candidate> codeFor(Precision precision, const codec::Encoder& encoder,
                              const EncodeProgress& told) const;
    Result<std::optional<Candidate>> codeSlid(const GridEncoders::Slide& slide,
                                              const EncodeProgress& told) const;
    Result<std::optional<Candidate>> codeSlides(GridEncoders::Slide& slide, float step) const;
    Result<Candidate> codeOnceSlid(GridEncoders::Slide& slide) const;

    std::span<const codec::Slides> ways_;
    bool prefixes_;
    GridEncoders* encoders_;
    const GridEncoders::Sampled* sampled_;
    const SurfaceMeasure* measure_;
    EncodeGoal goal_;
    EncodeProgress progress_;
};

// Of prefixes the shortest counts most: it is what sliding for the whole takes most from.
Result<double> SlidingCoder::worthOf(const CodedFile& file) const
{
    if (goal_.target != EncodeTarget::Bytes) return -static_cast<double>(file.bytes.size());
    if (!prefixes_) return file.psnr;
    constexpr PrefixPsnr kWeights = {0.2, 0.2, 0.6};
    const Result<PrefixPsnr> psnr = prefixPsnrOf(file, *measure_);
    if (!psnr) return psnr.error();
    return std::inner_product(psnr->begin(), psnr->end(), kWeights.begin(), 0.0);
}

Result<SlidingCoder::Candidate> SlidingCoder::codeFor(Precision precision, const codec::Encoder& encoder,
                                                      const EncodeProgress& told) const
{
    Result<CodedFile> file = gimg::codeFor(goal_, precision, encoder, *measure_, told);
    if (!file) return file.error();
    const Result<double> worth = worthOf(*file);
    if (!worth) return worth.error();
    return Candidate{std::move(*file), *worth};
}

// Codes the samples as they have slid. None where they cannot be coded for the goal: that is no loss.
Result<std::optional<SlidingCoder::Candidate>> SlidingCoder::codeSlid(const GridEncoders::Slide& slide,
                                                                      const EncodeProgress& told) const
{
    Result<Candidate> slid = codeFor(Precision::File, slide.finished(), told);
    return slid ? std::optional(std::move(*slid)) : std::nullopt;
}

// Slides in all ways, side by side, and keeps the best.
Result<std::optional<SlidingCoder::Candidate>> SlidingCoder::codeSlides(GridEncoders::Slide& slide,
                                                                        float step) const
{
    const size_t ways = ways_.size();
    std::vector<GridEncoders::Slide> slides(ways, slide);
    std::vector<Result<std::optional<Candidate>>> coded(ways, std::optional<Candidate>());
    tbb::parallel_for(size_t{0}, ways, [&](size_t way) {
        if (const Status moved = slides[way].move(step, ways_[way]); !moved)
            coded[way] = moved.error();
        else
            coded[way] = codeSlid(slides[way], way == 0 ? progress_ : EncodeProgress());
    });
    size_t best = 0;
    for (size_t way = 0; way < ways; ++way) {
        if (!coded[way]) return coded[way].error();
        if (*coded[way] && (!*coded[best] || (**coded[way]).worth > (**coded[best]).worth)) best = way;
    }
    slide = std::move(slides[best]);
    return std::move(coded[best]);
}

// The samples slide for the step that reaches the goal without. For a quality that step need not be exact,
// and nor need the file, if it turns out to be much larger.
Result<SlidingCoder::Candidate> SlidingCoder::codeOnceSlid(GridEncoders::Slide& slide) const
{
    constexpr double kMuchLarger = 1.05;
    const codec::Encoder& still = sampled_->encoder;
    const bool exact = goal_.target == EncodeTarget::Bytes;
    Result<Candidate> unslid = codeFor(exact ? Precision::File : Precision::Step, still, progress_);
    if (!unslid) return unslid;
    Result<std::optional<Candidate>> slid = codeSlides(slide, stepToMeet(goal_, unslid->file));
    if (!slid) return slid.error();
    if (!exact) {
        const auto size = static_cast<double>(unslid->file.bytes.size());
        if (*slid && static_cast<double>((**slid).file.bytes.size()) * kMuchLarger < size)
            return std::move(**slid);
        unslid = codeFor(Precision::File, still, progress_);
        if (!unslid) return *slid ? Result<Candidate>(std::move(**slid)) : unslid;
    }
    return *slid && (**slid).worth > unslid->worth ? std::move(**slid) : std::move(*unslid);
}

// What the decoder makes of the best file is where the next round begins.
Result<CodedFile> SlidingCoder::code(int refits) const
{
    Result<GridEncoders::Slide> slide = encoders_->slide(*sampled_);
    if (!slide) return slide.error();
    Result<Candidate> best = codeOnceSlid(*slide);
    if (!best) return best.error();
    for (int round = 0; round < refits && slide->mayRefit(); ++round) {
        const Result<DecodedImages> images = decodeImages(best->file.bytes);
        if (!images) return images.error();
        if (const Status fitted = slide->refit(images->geometry); !fitted) return fitted.error();
        GridEncoders::Slide refitted = *slide; // sharp edges fare better without sliding
        const codec::Slides still = {{}, ways_.front().prefixCare};
        if (const Status careful = refitted.move(best->file.step, still); !careful) return careful.error();
        std::optional<Result<std::optional<Candidate>>> coded[2];
        tbb::parallel_invoke([&] { coded[0] = codeSlid(refitted, {}); },
                             [&] { coded[1] = codeSlides(*slide, best->file.step); });
        for (auto& made : coded) {
            if (!*made) return made->error();
            if (**made && (***made).worth > best->worth) best = std::move(***made);
        }
    }
    return std::move(best->file);
}

// Of files made for the whole's bytes, half of them and a quarter.
Result<PrefixPsnr> psnrMadeFor(const Effort& effort, GridEncoders& encoders,
                               const GridEncoders::Sampled& sampled, const SurfaceMeasure& measure,
                               EncodeGoal goal)
{
    PrefixPsnr psnr = {};
    for (double& part : psnr) {
        const Result<CodedFile> made =
            SlidingCoder(effort.slides, false, encoders, sampled, measure, goal, {}).code(effort.refits);
        if (!made && made.error().kind != ErrorKind::TargetUnreachable) return made.error();
        part = made ? made->psnr : 0;
        goal.bytes /= 2;
    }
    return psnr;
}

} // namespace

Result<CodedFile> codeSliding(const Effort& effort, GridEncoders& encoders,
                              const GridEncoders::Sampled& sampled, const SurfaceMeasure& measure,
                              const EncodeGoal& goal, const EncodeProgress& progress)
{
    if (goal.coding != LossyCoding::Surface || effort.slides.empty())
        return codeFor(goal, Precision::File, sampled.encoder, measure, progress);
    const auto& sets = effort.slidesForPrefixes;
    if (sets.empty() || goal.target != EncodeTarget::Bytes)
        return SlidingCoder(effort.slides, false, encoders, sampled, measure, goal, progress)
            .code(effort.refits);

    Result<PrefixPsnr> madeFor = PrefixPsnr();
    std::vector<Result<CodedFile>> coded(sets.size(), CodedFile());
    tbb::parallel_for(size_t{0}, sets.size() + 1, [&](size_t set) {
        if (set == sets.size())
            madeFor = psnrMadeFor(effort, encoders, sampled, measure, goal);
        else
            coded[set] = SlidingCoder(sets[set], true, encoders, sampled, measure, goal,
                                      set == 0 ? progress : EncodeProgress())
                             .code(effort.refits);
    });
    if (!madeFor) return madeFor.error();
    size_t best = 0;
    double bestLag = std::numeric_limits<double>::infinity();
    for (size_t set = 0; set < sets.size(); ++set) {
        if (!coded[set]) return coded[set].error();
        const Result<PrefixPsnr> psnr = prefixPsnrOf(*coded[set], measure);
        if (!psnr) return psnr.error();
        double lag = 0;
        for (size_t k = 0; k < psnr->size(); ++k) lag = std::max(lag, (*madeFor)[k] - (*psnr)[k]);
        if (lag < bestLag) bestLag = lag, best = set;
    }
    return std::move(coded[best]);
}

} // namespace gimg

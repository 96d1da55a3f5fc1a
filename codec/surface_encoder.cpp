#include "surface_encoder.h"

#include "bit_counter.h"
#include "forward.h"
#include "range_encoder.h"
#include "surface_code.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace gimg::codec {

namespace {

/// What one bit is allowed to mend, in squared steps.
constexpr double kWorthOfBit = 0.11;
/// What a detail that is not 0 takes, in bits: that of one step, and what an octave adds.
constexpr double kBitsOfDetail = 6, kBitsOfOctave = 2;

struct EncoderMemory
{
    explicit EncoderMemory(std::uint32_t grid)
    {
        const std::size_t samples = std::size_t{grid} * grid,
                          coarser = std::size_t{grid / 2 + 1} * (grid / 2 + 1);
        for (unsigned c = 0; c < kComponents; ++c) {
            work.surface[c] = numbers(samples);
            work.detail[c] = numbers(samples);
            work.coarse[c] = numbers(coarser);
            work.coded[c] = integers(codedSize(grid));
            work.parents[c] = integers(codedSize(grid));
        }
        work.border = numbers(2 * std::size_t{borderSize(grid)});
        blocks_.resize(BlockMap::memory(grid));
        work.blocks = BlockMap(blocks_.data());
    }

    SurfaceWork work;

private:
    double* numbers(std::size_t count) { return numbers_.emplace_back(count).data(); }
    std::int32_t* integers(std::size_t count) { return integers_.emplace_back(count).data(); }

    std::vector<std::vector<double>> numbers_;
    std::vector<std::vector<std::int32_t>> integers_;
    std::vector<std::uint8_t> blocks_;
};

/// Chooses and codes one detail after the other.
/// @param Frames  SurfaceFrames or FieldFrames
template <class Frames> class ThriftyDetails
{
public:
    ThriftyDetails(const TransformedSurface& surface, const Frames& frames)
        : surface_(surface), frames_(frames)
    {
    }

    void begin(const SurfaceLevel& level, const double* const (&prediction)[kComponents])
    {
        exact_ = &surface_.levels[level.index];
        const std::uint32_t n = level.size;
        side_ = BlockMap::side(n);
        worth_.assign(std::size_t{2} * side_ * side_, 0);
        for (unsigned orientation = 0; orientation < 3; ++orientation)
            for (std::uint32_t j = firstRow(orientation); j < n; j += 2)
                for (std::uint32_t i = firstColumn(orientation); i < n; i += 2) {
                    if (!sharedDetail(level, orientation, i, j).isFirst) continue;
                    const auto frame = frames_.at(prediction, level, orientation, i, j);
                    double* worths =
                        &worth_[2 * (std::min(j / BlockMap::kBlock, side_ - 1) * std::size_t{side_} +
                                     std::min(i / BlockMap::kBlock, side_ - 1))];
                    for (unsigned c = 0; c < frames_.components(); ++c) {
                        const double size = std::abs(exactIn(frame, c, j * std::size_t{n} + i));
                        const double nearest = std::floor(size + 0.5);
                        if (nearest == 0) continue;
                        const double mended = size * size - (size - nearest) * (size - nearest);
                        worths[c == 0 ? 0 : 1] += std::max(
                            0.0, mended - kWorthOfBit * (kBitsOfDetail + kBitsOfOctave * std::log2(nearest)));
                    }
                }
    }

    bool isFilled(std::uint32_t bi, std::uint32_t bj, unsigned direction) const
    {
        return worth_[2 * (bj * std::size_t{side_} + bi) + direction] > 0;
    }

    bool isEmpty() const
    {
        return std::none_of(worth_.begin(), worth_.end(), [](double worth) { return worth > 0; });
    }

    template <class AnyFrame>
    std::int32_t operator()(RangeEncoder& coder, const DetailContext& context, unsigned component,
                            std::size_t index, const AnyFrame& frame) const
    {
        const double exact = exactIn(frame, component, index);
        const double size = std::min(std::abs(exact), static_cast<double>(kMaxDetail - 1));
        const std::int32_t sign = exact < 0 ? -1 : 1;
        const std::int32_t magnitude = thriftyMagnitude(size, kWorthOfBit, [&](std::int32_t candidate) {
            BitCounter counter;
            codeSurfaceDetail(counter, context, sign * candidate);
            return counter.bits();
        });
        return codeSurfaceDetail(coder, context, sign * magnitude);
    }

private:
    // A detail's component, in steps.
    template <class AnyFrame>
    double exactIn(const AnyFrame& frame, unsigned component, std::size_t index) const
    {
        const Vector detail = {exact_->detail[0][index], exact_->detail[1][index], exact_->detail[2][index]};
        return dot(frame.axis[component], detail) / frame.step[component];
    }

    const TransformedSurface& surface_;
    const Frames& frames_;
    std::vector<double> worth_; // of the level's blocks
    std::uint32_t side_ = 0;
    const TransformedSurface::Level* exact_ = nullptr;
};

} // namespace

SurfaceEncoder::SurfaceEncoder(const Seam& seam, std::uint32_t grid)
    : seam_(seam), grid_(grid), classes_(borderClasses(seam, grid))
{
}

SeamView SurfaceEncoder::view() const
{
    return {seam_.sides.data(), static_cast<std::uint32_t>(seam_.sides.size()), seam_.start, seam_.lowest};
}

TransformedSurface SurfaceEncoder::transform(std::span<const float> samples) const
{
    std::vector<std::uint32_t> mates(classes_.size());
    return transform(samples, kComponents, 0, GluedBorder(view(), grid_, classes_.data(), mates.data()));
}

// Channels beyond the last are zeros.
TransformedSurface SurfaceEncoder::transform(std::span<const float> samples, unsigned channels,
                                             unsigned first, const GluedBorder& border) const
{
    std::vector<double> work(2 * classes_.size());
    TransformedSurface out;
    out.grid = grid_;
    for (std::uint32_t m = kCoarsest; m < grid_; m = 2 * m - 1) out.levels.emplace_back();
    const std::size_t count = std::size_t{grid_} * grid_;
    double squaredDiagonal = 0;
    std::vector<double> image(count), coarse;
    for (unsigned c = 0; c < kComponents; ++c) {
        image.resize(count);
        for (std::size_t k = 0; k < count; ++k)
            image[k] = first + c < channels ? static_cast<double>(samples[channels * k + first + c]) : 0.0;
        if (border.isGluedAt(grid_)) border.average(image.data(), grid_, work.data());
        const auto [least, most] = std::minmax_element(image.begin(), image.end());
        squaredDiagonal += (*most - *least) * (*most - *least);
        auto level = out.levels.rbegin();
        for (std::uint32_t size = grid_; size > kCoarsest; size = size / 2 + 1, ++level) {
            const std::uint32_t m = size / 2 + 1;
            forwardLifting(image.data(), size, border.isGluedAt(m) ? &border : nullptr, work.data());
            coarse.resize(std::size_t{m} * m);
            for (std::uint32_t j = 0; j < size; ++j)
                for (std::uint32_t i = 0; i < size; ++i) {
                    double& value = image[j * std::size_t{size} + i];
                    if (i % 2 == 1 && j % 2 == 1) value *= kInverseAreaScale;
                    if (i % 2 == 1 || j % 2 == 1) continue;
                    coarse[j / 2 * std::size_t{m} + i / 2] = value * kAreaScale;
                    value = 0;
                }
            level->detail[c].assign(image.begin(), image.begin() + static_cast<std::ptrdiff_t>(size) * size);
            image.swap(coarse);
        }
        for (unsigned k = 0; k < kCoarsest * kCoarsest; ++k) {
            out.coarse[c][k] = image[k];
            out.largest = std::max(out.largest, std::abs(image[k]));
        }
    }
    out.diagonal = std::sqrt(squaredDiagonal);
    std::uint32_t size = kCoarsest;
    for (TransformedSurface::Level& level : out.levels) {
        size = 2 * size - 1;
        for (std::uint32_t j = 0; j < size; ++j)
            for (std::uint32_t i = 0; i < size; ++i) {
                if (i % 2 == 0 && j % 2 == 0) continue;
                const std::size_t k = j * std::size_t{size} + i;
                const Vector detail = {level.detail[0][k], level.detail[1][k], level.detail[2][k]};
                double& largest = level.largest[i % 2 == 0 ? Vertical : j % 2 == 0 ? Horizontal : Diagonal];
                largest = std::max(largest, std::sqrt(dot(detail, detail)));
            }
        for (const double value : level.largest) out.largest = std::max(out.largest, value);
    }
    return out;
}

CodedSurface SurfaceEncoder::encode(const TransformedSurface& surface,
                                    const SurfaceParameters& parameters) const
{
    std::vector<std::uint32_t> mates(classes_.size());
    const GluedBorder border(view(), grid_, classes_.data(), mates.data());
    EncoderMemory memory(grid_);
    QuantizedImage coarse;
    for (unsigned c = 0; c < kComponents; ++c)
        for (unsigned k = 0; k < kCoarsest * kCoarsest; ++k)
            coarse.coarse[c][k] = std::llround(surface.coarse[c][k] / parameters.step);
    const auto models = std::make_unique<SurfaceModels>();
    RangeEncoder encoder;
    const SurfaceFrames frames(parameters);
    ThriftyDetails pick(surface, frames);
    codeSurface(encoder, *models, frames, border, coarse, memory.work, pick);

    CodedSurface out{encoder.finish(), {}};
    const std::size_t count = std::size_t{grid_} * grid_;
    out.decoded.resize(kComponents * count);
    for (unsigned c = 0; c < kComponents; ++c)
        for (std::size_t k = 0; k < count; ++k)
            out.decoded[kComponents * k + c] = static_cast<float>(memory.work.surface[c][k]);
    return out;
}

TransformedField SurfaceEncoder::transformField(std::span<const float> samples, unsigned channels,
                                                bool glued) const
{
    std::vector<std::uint32_t> mates(classes_.size());
    const GluedBorder border =
        glued ? GluedBorder(view(), grid_, classes_.data(), mates.data()) : GluedBorder(grid_);
    TransformedField out;
    out.channels = channels;
    out.glued = glued;
    out.grid = grid_;
    double squaredDiagonal = 0;
    for (unsigned first = 0; first < channels; first += kComponents) {
        const TransformedSurface& group =
            out.groups.emplace_back(transform(samples, channels, first, border));
        out.largest = std::max(out.largest, group.largest);
        squaredDiagonal += group.diagonal * group.diagonal;
    }
    out.diagonal = std::sqrt(squaredDiagonal);
    return out;
}

CodedField SurfaceEncoder::encodeField(const TransformedField& field, const FieldParameters& parameters) const
{
    std::vector<std::uint32_t> mates(classes_.size());
    const GluedBorder border =
        field.glued ? GluedBorder(view(), grid_, classes_.data(), mates.data()) : GluedBorder(grid_);
    EncoderMemory memory(grid_);
    const auto models = std::make_unique<SurfaceModels>();
    RangeEncoder encoder;
    const std::size_t count = std::size_t{grid_} * grid_;
    CodedField out;
    out.decoded.resize(field.channels * count);
    unsigned first = 0;
    for (const TransformedSurface& group : field.groups) {
        const unsigned channels = std::min(kComponents, field.channels - first);
        QuantizedImage coarse;
        for (unsigned c = 0; c < channels; ++c)
            for (unsigned k = 0; k < kCoarsest * kCoarsest; ++k)
                coarse.coarse[c][k] = std::llround(group.coarse[c][k] / parameters.step);
        const FieldFrames frames(parameters, channels);
        ThriftyDetails pick(group, frames);
        codeSurface(encoder, *models, frames, border, coarse, memory.work, pick);
        for (unsigned c = 0; c < channels; ++c)
            for (std::size_t k = 0; k < count; ++k)
                out.decoded[field.channels * k + first + c] = static_cast<float>(memory.work.surface[c][k]);
        first += channels;
    }
    out.payload = encoder.finish();
    return out;
}

float smallestStep(const TransformedField& field)
{
    float least = field.finest;
    for (const TransformedSurface& group : field.groups) least = std::max(least, smallestStep(group));
    return least;
}

float smallestStep(const TransformedSurface& surface)
{
    // Steps shrink by at most SurfaceParameters::areaLimit, below 5.
    double detail = 0;
    for (const TransformedSurface::Level& level : surface.levels)
        for (const double value : level.largest) detail = std::max(detail, value);
    return smallestStep(8 * detail, surface.largest);
}

} // namespace gimg::codec

#include "surface_encoder.h"

#include "bit_counter.h"
#include "detail_passes.h"
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

/// Zeros for what is laid out in the decoder's arena.
class Memory
{
public:
    template <class T> void operator()(T*& piece, std::size_t count)
    {
        static_assert(alignof(T) <= alignof(std::max_align_t));
        pieces_.emplace_back(count * sizeof(T));
        piece = reinterpret_cast<T*>(pieces_.back().data());
    }

private:
    std::vector<std::vector<std::byte>> pieces_;
};

struct SurfaceMemory
{
    explicit SurfaceMemory(std::uint32_t grid)
    {
        work.layOut(grid, memory_);
        chosen.layOut(grid, memory_);
        coded.layOut(grid, memory_);
    }

    SurfaceWork work;
    DetailLevels chosen, coded;

private:
    Memory memory_;
};

/// About what a detail will cost, from those chosen before it in its own level and the coarser one.
class DetailCost
{
public:
    void begin(const DetailLevel& level, const DetailLevel* coarser)
    {
        level_ = &level;
        coarser_ = coarser;
    }

    /// What of the place and the components chosen there tells most.
    unsigned classOf(unsigned orientation, std::uint32_t i, std::uint32_t j,
                     const std::int32_t (&here)[kComponents], unsigned component) const
    {
        const std::uint32_t n = level_->size, m = n / 2 + 1;
        const auto row = static_cast<std::ptrdiff_t>(codedPitch(n));
        const std::size_t index = codedIndex(n, i, j);
        const auto at = [&](unsigned c, std::ptrdiff_t offset) {
            return magnitudeOf(level_->q[c][static_cast<std::ptrdiff_t>(index) + offset]);
        };
        std::uint64_t sum = 4 * (at(component, -2) + at(component, -2 * row));
        for (const std::ptrdiff_t offset : {-2 * row - 2, -2 * row + 2, std::ptrdiff_t{-4}, -4 * row})
            sum += 2 * at(component, offset);
        if (orientation == Vertical)
            for (const std::ptrdiff_t offset : {-1 - row, 1 - row, row - 1, row + 1})
                sum += 2 * at(component, offset);
        if (orientation == Diagonal)
            for (const std::ptrdiff_t offset : {-row, row, std::ptrdiff_t{-1}, std::ptrdiff_t{1}})
                sum += 2 * at(component, offset);
        if (coarser_ != nullptr) {
            const std::int32_t* p =
                coarser_->q[component] + codedIndex(m, i / 4 * 2 + i % 2, j / 4 * 2 + j % 2);
            const auto up = 2 * static_cast<std::ptrdiff_t>(codedPitch(m));
            sum += 2 * magnitudeOf(*p) + magnitudeOf(p[-2]) + magnitudeOf(p[2]) + magnitudeOf(p[-up]) +
                   magnitudeOf(p[up]);
        }
        for (unsigned c = 0; c < kComponents; ++c)
            sum += c < component   ? 6 * magnitudeOf(here[c])
                   : c > component ? 3 * (at(c, -2) + at(c, -2 * row) + 1) / 2
                                   : 0;
        return quickClass<23>(sum);
    }

    /// @param coder  a BitCounter, or a BitLearner to remember what was chosen
    template <class Coder>
    void code(Coder& coder, unsigned classOfPlace, unsigned component, std::uint32_t magnitude)
    {
        BitModel* above = above_[classOfPlace][component];
        for (unsigned k = 0; k < kSteps; ++k)
            if (!coder.bit(above[k], magnitude > k)) {
                if (k > 0) coder.raw(1, 0);
                return;
            }
        // The sign, and an octave's two bits.
        const unsigned octaves = log2Floor(magnitude - kSteps + 1);
        coder.raw(2 + 2 * octaves, 0);
    }

private:
    static constexpr unsigned kSteps = 4;
    BitModel above_[24][kComponents][kSteps];
    const DetailLevel *level_ = nullptr, *coarser_ = nullptr;
};

constexpr std::int32_t kLargestDetail = (1 << kDetailBits) - 2;

/// How far a magnitude is from what prefixes make of it that lack its lowest one, two or three bits, in units
/// of those: the sum of squares.
double missedByPrefixes(std::int32_t magnitude)
{
    double sum = 0;
    for (int bits = 1; bits <= 3; ++bits) {
        const std::int32_t known = magnitude >> bits << bits;
        const double unit = 1 << bits, middle = known == 0 ? 0 : known + 0.5 * (unit - 1);
        sum += (magnitude - middle) * (magnitude - middle) / (unit * unit);
    }
    return sum;
}

/// thriftyMagnitude() with what prefixes miss counted in, `care` times.
template <class BitsOf> std::int32_t magnitudeForPrefixes(double size, double care, const BitsOf& bitsOf)
{
    constexpr std::int32_t kAround = 6;
    const auto nearest = static_cast<std::int32_t>(size + 0.5);
    if (nearest == 0) return 0;
    const auto cost = [&](std::int32_t magnitude) {
        const double error = size - magnitude;
        return error * error + care * missedByPrefixes(magnitude) + kWorthOfBit * bitsOf(magnitude);
    };
    std::int32_t best = 0;
    double bestCost = cost(0);
    const std::int32_t most = std::min(nearest + kAround - 1, kLargestDetail);
    for (std::int32_t magnitude = std::max(1, nearest - kAround); magnitude <= most; ++magnitude) {
        const double candidate = cost(magnitude);
        if (candidate < bestCost) bestCost = candidate, best = magnitude;
    }
    return best;
}

struct BitLearner
{
    bool bit(BitModel& model, bool one) const { return model.update(one), one; }
    void raw(unsigned, std::uint32_t) const {}
};

/// Chooses one detail after the other, by what it costs and what it mends.
template <class Frames> class ThriftyDetails
{
public:
    ThriftyDetails(const TransformedSurface& surface, const Frames& frames, DetailLevels& levels)
        : surface_(surface), frames_(frames), levels_(levels)
    {
    }

    bool begin(const SurfaceLevel& level, const double* const (&prediction)[kComponents])
    {
        if (level.index + surface_.smoothLevels >= surface_.levels.size()) return false;
        exact_ = &surface_.levels[level.index];
        // The finest levels' details along the surface are small, and nothing lies on them.
        const bool isFine = level.index + surface_.smoothLevels + 2 >= surface_.levels.size();
        care_ = isFine ? surface_.prefixCare / 4 : surface_.prefixCare;
        here_ = &levels_.level[level.index];
        cost_.begin(*here_, level.index == 0 ? nullptr : &levels_.level[level.index - 1]);
        const std::uint32_t n = level.size;
        side_ = BlockMap::side(n);
        worth_.assign(std::size_t{2} * side_ * side_, 0);
        visitDetails(
            level.border, n, [](std::uint32_t, std::uint32_t) { return true; },
            [&](unsigned, std::uint32_t i, std::uint32_t j, const SharedDetail&, std::uint32_t bi,
                std::uint32_t bj) {
                const Frame frame = frames_.at(prediction, level, i, j);
                double* worths = &worth_[2 * (bj * std::size_t{side_} + bi)];
                for (unsigned c = 0; c < frames_.components(); ++c) {
                    const double size = std::abs(exactIn(frame, c, j * std::size_t{n} + i));
                    const double nearest = std::floor(size + 0.5);
                    if (nearest == 0) continue;
                    const double mended = size * size - (size - nearest) * (size - nearest);
                    worths[c == 0 ? 0 : 1] += std::max(
                        0.0, mended - kWorthOfBit * (kBitsOfDetail + kBitsOfOctave * std::log2(nearest)));
                }
                return true;
            });
        here_->isFilled = std::any_of(worth_.begin(), worth_.end(), [](double worth) { return worth > 0; });
        return here_->isFilled;
    }

    bool isWanted(std::uint32_t bi, std::uint32_t bj) const
    {
        return isWorth(bi, bj, 0) || isWorth(bi, bj, 1);
    }

    Vector operator()(const SurfaceLevel& level, const double* const (&prediction)[kComponents],
                      unsigned orientation, std::uint32_t i, std::uint32_t j, const SharedDetail& shared)
    {
        const std::uint32_t n = level.size;
        const std::size_t index = codedIndex(n, i, j);
        const std::uint32_t bi = BlockMap::blockOf(i, side_), bj = BlockMap::blockOf(j, side_);
        const Frame frame = frames_.at(prediction, level, i, j);
        std::int32_t here[kComponents] = {};
        Vector detail = {0, 0, 0};
        for (unsigned c = 0; c < frames_.components(); ++c) {
            if (!isWorth(bi, bj, c == 0 ? 0 : 1)) continue;
            const double exact = exactIn(frame, c, j * std::size_t{n} + i);
            const double size = std::min(std::abs(exact), static_cast<double>(kLargestDetail));
            const unsigned place = cost_.classOf(orientation, i, j, here, c);
            const auto bitsOf = [&](std::int32_t candidate) {
                BitCounter counter;
                cost_.code(counter, place, c, static_cast<std::uint32_t>(candidate));
                return counter.bits();
            };
            const double care = c == 0 ? 0 : care_;
            const std::int32_t magnitude = care > 0 ? magnitudeForPrefixes(size, care, bitsOf)
                                                    : thriftyMagnitude(size, kWorthOfBit, bitsOf);
            BitLearner learner;
            cost_.code(learner, place, c, static_cast<std::uint32_t>(magnitude));
            if (magnitude == 0) continue;
            here[c] = exact < 0 ? -magnitude : magnitude;
            here_->q[c][index] = here[c];
            here_->blocks.fill(bi, bj, c == 0 ? 0 : 1);
            detail = detail + (here[c] * frame.step[c]) * frame.axis[c];
        }
        if (shared.mate != GluedBorder::kNoMate) {
            const GridPoint other = borderPoint(n, shared.mate);
            for (unsigned c = 0; c < kComponents; ++c) here_->q[c][codedIndex(n, other.i, other.j)] = here[c];
        }
        return detail;
    }

private:
    bool isWorth(std::uint32_t bi, std::uint32_t bj, unsigned direction) const
    {
        return worth_[2 * (bj * std::size_t{side_} + bi) + direction] > 0;
    }

    // A detail's component, in steps.
    double exactIn(const Frame& frame, unsigned component, std::size_t index) const
    {
        const Vector detail = {exact_->detail[0][index], exact_->detail[1][index], exact_->detail[2][index]};
        return dot(frame.axis[component], detail) / frame.step[component];
    }

    const TransformedSurface& surface_;
    const Frames& frames_;
    DetailLevels& levels_;
    std::vector<double> worth_; // of the level's blocks
    std::uint32_t side_ = 0;
    double care_ = 0; // of the level
    const TransformedSurface::Level* exact_ = nullptr;
    DetailLevel* here_ = nullptr;
    DetailCost cost_;
};

/// Details that have been chosen, for codeSurface().
class WholeDetails
{
public:
    WholeDetails(const DetailLevels& levels, const GluedBorder& border) : levels_(levels)
    {
        for (unsigned l = 0; l < levels.count; ++l) {
            const DetailLevel& level = levels.level[l];
            const std::uint32_t n = level.size, side = BlockMap::side(n);
            auto& tops = tops_.emplace_back(std::size_t{kDirections} * side * side, 0u);
            visitDetails(
                border.isGluedAt(n / 2 + 1) ? &border : nullptr, n,
                [&](std::uint32_t bi, std::uint32_t bj) {
                    return level.blocks.isFilled(bi, bj, 0) || level.blocks.isFilled(bi, bj, 1);
                },
                [&](unsigned, std::uint32_t i, std::uint32_t j, const SharedDetail&, std::uint32_t bi,
                    std::uint32_t bj) {
                    for (unsigned c = 0; c < kComponents; ++c) {
                        std::uint32_t& top =
                            tops[kDirections * (bj * std::size_t{side} + bi) + (c == 0 ? 0 : 1)];
                        top |= static_cast<std::uint32_t>(magnitudeOf(level.q[c][codedIndex(n, i, j)]));
                    }
                    return true;
                });
            topOfLevel_.push_back(0);
            for (const std::uint32_t top : tops) topOfLevel_.back() |= top;
        }
    }

    /// Bits of the largest magnitude.
    unsigned passes() const
    {
        std::uint32_t all = 0;
        for (const std::uint32_t top : topOfLevel_) all |= top;
        return all == 0 ? 0 : log2Floor(all) + 1;
    }

    bool isEmpty(unsigned l, unsigned pass) const { return topOfLevel_[l] >> pass == 0; }
    bool isFilled(unsigned l, std::uint32_t bi, std::uint32_t bj, unsigned direction, unsigned pass) const
    {
        const std::size_t side = BlockMap::side(levels_.level[l].size);
        return tops_[l][kDirections * (bj * side + bi) + direction] >> pass != 0;
    }
    std::int32_t operator()(unsigned l, unsigned component, std::size_t index) const
    {
        return levels_.level[l].q[component][index];
    }

private:
    const DetailLevels& levels_;
    std::vector<std::vector<std::uint32_t>> tops_; // bits of the magnitudes in a block
    std::vector<std::uint32_t> topOfLevel_;
};

/// Chooses details, builds the surface that they make, and codes them unless `encoder` is null.
template <class Frames>
void code(RangeEncoder* encoder, DetailModels& models, const Frames& frames, const GluedBorder& border,
          const TransformedSurface& surface, SurfaceMemory& memory)
{
    const unsigned components = frames.components();
    QuantizedImage coarse;
    for (unsigned c = 0; c < components; ++c)
        for (unsigned k = 0; k < kCoarsest * kCoarsest; ++k)
            coarse.coarse[c][k] = std::llround(surface.coarse[c][k] / frames.coarseStep());
    memory.chosen.clear();
    ThriftyDetails details(surface, frames, memory.chosen);
    buildSurface(frames, border, coarse.coarse, memory.work, details);
    if (encoder == nullptr) return;
    memory.coded.clear();
    const WholeDetails whole(memory.chosen, border);
    codeDetails(*encoder, models, border, components, coarse, memory.coded, whole.passes(), whole);
}

} // namespace

SurfaceEncoder::SurfaceEncoder(const Seam& seam, std::uint32_t grid, unsigned smoothLevels)
    : seam_(seam), grid_(grid), smoothLevels_(smoothLevels), classes_(borderClasses(seam, grid))
{
}

SeamView SurfaceEncoder::view() const
{
    return {seam_.sides.data(), static_cast<std::uint32_t>(seam_.sides.size()), seam_.start, seam_.lowest};
}

TransformedSurface SurfaceEncoder::transform(std::span<const float> samples) const
{
    std::vector<std::uint32_t> mates(classes_.size());
    TransformedSurface surface =
        transform(samples, kComponents, 0, GluedBorder(view(), grid_, classes_.data(), mates.data()));
    surface.smoothLevels = smoothLevels_;
    return surface;
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

CodedSurface SurfaceEncoder::encode(const TransformedSurface& surface, const SurfaceParameters& parameters,
                                    bool withPayload) const
{
    std::vector<std::uint32_t> mates(classes_.size());
    const GluedBorder border(view(), grid_, classes_.data(), mates.data());
    SurfaceMemory memory(grid_);
    const auto models = std::make_unique<DetailModels>();
    RangeEncoder encoder;
    code(withPayload ? &encoder : nullptr, *models, SurfaceFrames(parameters), border, surface, memory);

    CodedSurface out;
    const std::size_t count = std::size_t{grid_} * grid_;
    out.decoded.resize(kComponents * count);
    for (unsigned c = 0; c < kComponents; ++c)
        for (std::size_t k = 0; k < count; ++k)
            out.decoded[kComponents * k + c] = static_cast<float>(memory.work.surface[c][k]);
    if (withPayload) out.payload = encoder.finish();
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
    SurfaceMemory memory(grid_);
    const auto models = std::make_unique<DetailModels>();
    RangeEncoder encoder;
    const std::size_t count = std::size_t{grid_} * grid_;
    CodedField out;
    out.decoded.resize(field.channels * count);
    unsigned first = 0;
    for (const TransformedSurface& group : field.groups) {
        const unsigned channels = std::min(kComponents, field.channels - first);
        code(&encoder, *models, FieldFrames(parameters, channels), border, group, memory);
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

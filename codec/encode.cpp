#include "encode.h"

#include "border.h"
#include "exact_encoder.h"
#include "format/container.h"
#include "format/writer.h"
#include "image_header.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace gimg::codec {

namespace {

using Bytes = std::vector<std::uint8_t>;

/// Steps finer than this part of the diagonal spend bytes on the noise of float32 samples.
constexpr double kFinestPart = 0x1p-21;
constexpr double kNormalShare = 0.25;
constexpr double kLargestCoefficient = static_cast<double>(kLargestStep) / 4;

EncodeError badSource(std::string message) { return {EncodeError::Kind::BadSource, std::move(message), 0}; }

unsigned exponentOf(std::uint32_t grid) { return log2Floor(grid - 1); }

bool isGridSize(std::uint32_t n)
{
    return n >= 3 && n <= (1u << kLargestExponent) + 1 && ((n - 1) & (n - 2)) == 0;
}

std::string imageFault(const char* name, std::span<const float> samples, std::uint32_t grid,
                       std::uint32_t lowest)
{
    const std::string what = name;
    if (!isGridSize(grid)) return what + ": the grid is not 2^j + 1 samples a side with j in 1..12";
    if (grid < lowest) return what + ": the grid is smaller than the lowest level";
    if (samples.size() != std::size_t{grid} * grid * kComponents)
        return what + ": the number of samples does not fit the grid";
    const auto bad =
        std::find_if(samples.begin(), samples.end(), [](float value) { return !std::isfinite(value); });
    if (bad != samples.end())
        return what + ": sample " + std::to_string((bad - samples.begin()) / 3) + " is not finite";
    return {};
}

Bytes imageContent(std::uint32_t grid, gim_coding coding)
{
    return {static_cast<std::uint8_t>(exponentOf(grid) | static_cast<unsigned>(coding) << 4)};
}

Bytes waveletContent(const TransformedImage& image, float step)
{
    const CodedImage coded = encodeCoefficients(image, step);
    Bytes content = imageContent(image.grid, GIM_CODING_WAVELET);
    format::appendF32(content, step);
    content.push_back(coded.shifts);
    for (const std::uint8_t byte : coded.payload) content.push_back(byte);
    return content;
}

// Tangential steps grow by three quarters of an octave a level where the surface is flat enough, to eight
// times the normal ones; those of small and large cells differ by at most 1.25. Found by trial on scanned and
// designed surfaces.
constexpr std::uint8_t kRatios = 3 | 6 << 4;
constexpr std::uint8_t kLimits = 1 | 4 << 4;

SurfaceParameters parametersOf(float step)
{
    ImageHeader header;
    header.step = step;
    header.ratios = kRatios;
    header.limits = kLimits;
    return surfaceParameters(header);
}

Bytes surfaceContent(const SurfaceEncoder& encoder, const TransformedSurface& surface, float step)
{
    Bytes content = imageContent(surface.grid, GIM_CODING_SURFACE);
    format::appendF32(content, step);
    content.push_back(kRatios);
    content.push_back(kLimits);
    for (const std::uint8_t byte : encoder.encode(surface, parametersOf(step)).payload)
        content.push_back(byte);
    return content;
}

Bytes exactContent(std::span<const float> samples, std::uint32_t grid, gim_coding coding,
                   std::span<const float> fields, const Seam& seam)
{
    Bytes content = imageContent(grid, coding);
    for (const float field : fields) format::appendF32(content, field);
    const ExactFormat format = {grid, kComponents, coding == GIM_CODING_RAW12 ? kCubeBits : 0};
    for (const std::uint8_t byte : encodeExact(samples, format, borderClasses(seam, grid)))
        content.push_back(byte);
    return content;
}

struct IntegerContent
{
    Bytes content; ///< empty if the samples are too far apart
    float step = 0;
};

IntegerContent integerContent(std::span<const float> samples, std::uint32_t grid, const Seam& seam)
{
    float least[kComponents], most[kComponents];
    for (unsigned c = 0; c < kComponents; ++c) least[c] = most[c] = samples[c];
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const std::size_t c = k % kComponents;
        least[c] = std::min(least[c], samples[k]);
        most[c] = std::max(most[c], samples[k]);
    }
    double side = 0;
    for (unsigned c = 0; c < kComponents; ++c)
        side = std::max(side, static_cast<double>(most[c]) - static_cast<double>(least[c]));
    constexpr long kMost = (1l << kCubeBits) - 1;
    const float step = std::max(static_cast<float>(side / static_cast<double>(kMost)), kSmallestStep);
    if (step > kLargestStep) return {};
    std::vector<float> integers(samples.size());
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const double offset = static_cast<double>(samples[k]) - static_cast<double>(least[k % kComponents]);
        integers[k] =
            static_cast<float>(std::clamp(std::lround(offset / static_cast<double>(step)), 0l, kMost));
    }
    const float fields[] = {least[0], least[1], least[2], step};
    return {exactContent(integers, grid, GIM_CODING_RAW12, fields, seam), step};
}

Bytes assemble(std::uint32_t lowest, const Bytes& word, const Bytes& geometry, const Bytes* normals)
{
    Bytes seam(1 + word.size(), static_cast<std::uint8_t>(exponentOf(lowest)));
    std::copy(word.begin(), word.end(), seam.begin() + 1);
    format::Writer writer;
    writer.addChunk(format::kSeamChunk, seam);
    writer.addChunk(format::kGeometryChunk, geometry);
    if (normals != nullptr) writer.addChunk(format::kNormalChunk, *normals);
    return writer.finish();
}

struct Candidate
{
    Bytes content;
    float step = 0;
};

/// TransformedImage or TransformedSurface.
template <class Image> std::string stepFault(const Image& image, float step, const char* name)
{
    if (image.largest > kLargestCoefficient) return "the samples are too large for wavelet coding";
    if (!(step > 0) || step > kLargestStep) return std::string(name) + " is not a positive number in range";
    if (step < smallestStep(image)) return std::string(name) + " is too small for these samples";
    return {};
}

struct StepRange
{
    float finest = 0, coarsest = 0;
};

template <class Image> StepRange sensibleSteps(const Image& image)
{
    const float least = smallestStep(image);
    const float finest = std::max(least, static_cast<float>(image.diagonal * kFinestPart));
    // A step twice as large as any coefficient leaves nothing to code.
    const float coarsest = std::clamp(static_cast<float>(2.1 * image.largest), finest, kLargestStep);
    return {finest, coarsest};
}

/// The finest coding whose chunk takes at most `target` bytes, found by closing in on the step.
/// @param contentAt  the chunk's content for a step
/// Size falls nearly linearly with the logarithm of the step over small ranges, so secants are tried
/// first, and halving where they are slow.
template <class Image, class ContentAt>
std::variant<Candidate, EncodeError> searchStep(const Image& image, const ContentAt& contentAt,
                                                std::size_t target)
{
    const auto attempt = [&](float step) { return Candidate{contentAt(step), step}; };
    const auto sizeOf = [](const Candidate& candidate) {
        return format::chunkSize(candidate.content.size());
    };
    const StepRange range = sensibleSteps(image);
    if (image.largest > kLargestCoefficient)
        return EncodeError{EncodeError::Kind::BadSettings, "the samples are too large for wavelet coding", 0};

    Candidate best = attempt(range.coarsest);
    std::size_t bestSize = sizeOf(best);
    if (bestSize > target) return EncodeError{EncodeError::Kind::TooSmall, {}, bestSize};

    // Halve from a likely step until the target is bracketed: `high` is too many bytes, `low` is not.
    double lowStep = std::log2(static_cast<double>(range.coarsest)), highStep = 0;
    std::size_t lowSize = bestSize, highSize = 0;
    double guess = std::log2(static_cast<double>(range.coarsest)) - 4;
    const double floor = std::log2(static_cast<double>(range.finest));
    for (double stride = 2; highSize == 0;) {
        const bool atFloor = guess <= floor;
        Candidate candidate = attempt(atFloor ? range.finest : static_cast<float>(std::exp2(guess)));
        const std::size_t size = sizeOf(candidate);
        if (size > target) {
            highStep = std::log2(static_cast<double>(candidate.step));
            highSize = size;
            break;
        }
        lowStep = std::log2(static_cast<double>(candidate.step));
        lowSize = size;
        best = std::move(candidate);
        bestSize = size;
        if (atFloor) return EncodeError{EncodeError::Kind::TooLarge, {}, size};
        guess -= stride;
    }

    const std::size_t close = target / 1000 + 1;
    for (int round = 0; round < 40 && target - bestSize > close; ++round) {
        double part = 0.5;
        if (round % 3 != 2) {
            const double wanted = static_cast<double>(target) - 0.4 * static_cast<double>(close);
            // In logarithms of the sizes the curve is straighter still.
            part = (std::log(wanted) - std::log(static_cast<double>(lowSize))) /
                   (std::log(static_cast<double>(highSize)) - std::log(static_cast<double>(lowSize)));
            part = std::clamp(part, 0.02, 0.98);
        }
        const auto step = static_cast<float>(std::exp2(lowStep + part * (highStep - lowStep)));
        Candidate candidate = attempt(step);
        const double exactStep = std::log2(static_cast<double>(step));
        if (exactStep >= lowStep || exactStep <= highStep) break;
        const std::size_t size = sizeOf(candidate);
        if (size > target) {
            highStep = exactStep;
            highSize = size;
            continue;
        }
        lowStep = exactStep;
        lowSize = size;
        if (size >= bestSize) {
            best = std::move(candidate);
            bestSize = size;
        }
    }
    return best;
}

} // namespace

Encoder::Encoder(const Source& source)
    : seam_(source.seam), word_(encodeSeam(source.seam)), xyz_(source.xyz.begin(), source.xyz.end()),
      normals_(source.normals.begin(), source.normals.end()),
      surfaceEncoder_(std::make_shared<SurfaceEncoder>(source.seam, source.grid)),
      surface_(surfaceEncoder_->transform(xyz_))
{
    if (source.normalGrid != 0) normalImage_ = codec::transform(source.normals, source.normalGrid);
}

Outcome<Encoder> Encoder::prepare(const Source& source)
{
    if (std::string fault = seamFault(source.seam); !fault.empty()) return badSource("seam: " + fault);
    if (std::string fault = imageFault("geometry", source.xyz, source.grid, source.seam.lowest);
        !fault.empty())
        return badSource(fault);
    if (source.normalGrid != 0)
        if (std::string fault = imageFault("normals", source.normals, source.normalGrid, source.seam.lowest);
            !fault.empty())
            return badSource(fault);
    return Encoder(source);
}

Outcome<Encoder> Encoder::slid(float step, int rounds, const Retarget& retarget) const
{
    if (const std::string fault = stepFault(surface_, step, "the step"); !fault.empty())
        return EncodeError{EncodeError::Kind::BadSettings, fault, 0};
    Encoder moved = *this;
    for (int round = 0; round < rounds; ++round) {
        const CodedSurface coded = surfaceEncoder_->encode(moved.surface_, parametersOf(step));
        retarget(coded.decoded, moved.xyz_);
        moved.surface_ = surfaceEncoder_->transform(moved.xyz_);
        step = std::max(step, smallestStep(moved.surface_));
    }
    return moved;
}

Outcome<EncodedFile> Encoder::encode(const Settings& settings) const
{
    const auto failed = [](std::string message) {
        return EncodeError{EncodeError::Kind::BadSettings, std::move(message), 0};
    };
    EncodedFile file;
    Bytes content[2];
    float written[2] = {settings.step, settings.normalStep};
    const std::vector<float>* samples[2] = {&xyz_, &normals_};
    const std::uint32_t grids[2] = {surface_.grid, normalImage_ ? normalImage_->grid : 0};
    for (int k = 0; k < 2 && grids[k] != 0; ++k) {
        const char* name = k == 0 ? "the step" : "the normals' step";
        switch (settings.coding) {
        case GIM_CODING_SURFACE:
            if (k == 0) {
                if (std::string fault = stepFault(surface_, settings.step, name); !fault.empty())
                    return failed(fault);
                content[0] = surfaceContent(*surfaceEncoder_, surface_, settings.step);
                break;
            }
            [[fallthrough]];
        case GIM_CODING_WAVELET: {
            const TransformedImage image = k == 0 ? codec::transform(xyz_, surface_.grid) : *normalImage_;
            if (std::string fault = stepFault(image, written[k], name); !fault.empty()) return failed(fault);
            content[k] = waveletContent(image, written[k]);
            break;
        }
        case GIM_CODING_RAW12: {
            IntegerContent integers = integerContent(*samples[k], grids[k], seam_);
            if (integers.content.empty()) return failed("the samples are too large for 12-bit coding");
            content[k] = std::move(integers.content);
            written[k] = integers.step;
            break;
        }
        case GIM_CODING_FLOAT:
            content[k] = exactContent(*samples[k], grids[k], GIM_CODING_FLOAT, {}, seam_);
            written[k] = 0;
            break;
        default:
            return failed("no such coding");
        }
    }
    file.step = written[0];
    file.normalStep = normalImage_ ? written[1] : 0;
    file.bytes = assemble(seam_.lowest, word_, content[0], normalImage_ ? &content[1] : nullptr);
    return file;
}

Outcome<EncodedFile> Encoder::encodeToBytes(std::size_t target, gim_coding coding) const
{
    if (coding != GIM_CODING_SURFACE && coding != GIM_CODING_WAVELET)
        return EncodeError{EncodeError::Kind::BadSettings, "this coding has one size only", 0};
    const std::size_t fixed = format::kHeaderSize + format::chunkSize(1 + word_.size());
    const auto unreachable = [&](EncodeError error, std::size_t others) {
        if (error.kind == EncodeError::Kind::BadSettings) return error;
        error.reachable += fixed + others;
        error.message = std::string("the ") +
                        (error.kind == EncodeError::Kind::TooSmall ? "smallest" : "largest sensible") +
                        " file takes " + std::to_string(error.reachable) + " bytes";
        return error;
    };
    const std::size_t room = target > fixed ? target - fixed : 0;

    std::optional<Candidate> normals;
    std::size_t normalSize = 0;
    if (normalImage_) {
        const auto share = static_cast<std::size_t>(static_cast<double>(room) * kNormalShare);
        const auto contentAt = [&](float step) { return waveletContent(*normalImage_, step); };
        auto found = searchStep(*normalImage_, contentAt, share);
        if (EncodeError* error = std::get_if<EncodeError>(&found)) {
            // A share that even the extreme steps do not meet is met as nearly as can be.
            const StepRange range = sensibleSteps(*normalImage_);
            const float step = error->kind == EncodeError::Kind::TooSmall ? range.coarsest : range.finest;
            normals = Candidate{waveletContent(*normalImage_, step), step};
        } else {
            normals = std::move(std::get<Candidate>(found));
        }
        normalSize = format::chunkSize(normals->content.size());
    }

    const std::size_t left = room > normalSize ? room - normalSize : 0;
    auto found = [&] {
        if (coding == GIM_CODING_SURFACE)
            return searchStep(
                surface_, [&](float step) { return surfaceContent(*surfaceEncoder_, surface_, step); }, left);
        const TransformedImage image = codec::transform(xyz_, surface_.grid);
        return searchStep(
            image, [&](float step) { return waveletContent(image, step); }, left);
    }();
    if (EncodeError* error = std::get_if<EncodeError>(&found)) return unreachable(*error, normalSize);
    Candidate& geometry = std::get<Candidate>(found);
    EncodedFile file;
    file.bytes = assemble(seam_.lowest, word_, geometry.content, normals ? &normals->content : nullptr);
    file.step = geometry.step;
    file.normalStep = normals ? normals->step : 0.0f;
    return file;
}

} // namespace gimg::codec

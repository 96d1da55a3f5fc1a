#include "arena.h"
#include "attribute_header.h"
#include "detail_passes.h"
#include "exact_decoder.h"
#include "fuse.h"
#include "image_header.h"
#include "range_decoder.h"
#include "surface_code.h"

#include <cmath>
#include <cstring>
#include <new>
#include <type_traits>

namespace gimg::codec {

namespace {

constexpr double kLargestFloat = 3.4028234663852886e38;

bool isFinite(float value) { return value - value == 0.0f; }

// Whether an image of this kind may have this coding.
bool isCodingOf(ImageKind image, unsigned coding)
{
    switch (coding) {
    case GIM_CODING_WAVELET:
    case GIM_CODING_RAW12:
        return image != ImageKind::Attribute;
    case GIM_CODING_FLOAT:
        return true;
    case GIM_CODING_SURFACE:
        return image == ImageKind::Geometry;
    case GIM_CODING_FIELD:
        return image != ImageKind::Geometry;
    default:
        return false;
    }
}

bool stepInRange(float step) { return step >= kSmallestStep && step <= kLargestStep; }

std::size_t samplesOf(std::uint32_t grid) { return std::size_t{grid} * grid; }

std::size_t coarseSamplesOf(std::uint32_t grid) { return samplesOf((grid + 1) / 2); }

std::size_t rowScratchOf(std::uint32_t grid)
{
    return kComponents * NeighbourRows::scratchSize(grid / 2 + 1);
}

struct PlainPick
{
    std::int32_t operator()(RangeDecoder& decoder, const CoefficientContext& context, unsigned,
                            std::size_t) const
    {
        return codeDetail(decoder, context, 0);
    }
};

struct NothingKnown
{
    bool operator()(unsigned, const Subband&) const { return false; }
};

ReadStatus decodeWavelet(const ImageHeader& header, const std::uint32_t* classes, bool diffuse, Arena& arena,
                         float* out)
{
    const std::uint32_t grid = header.grid;
    const std::size_t samples = samplesOf(grid);
    QuantizedImage image;
    const ReadStatus status = decodeCoefficients(header, arena, &image);
    if (status != ReadStatus::Ok) return status;
    auto* workA = arena.take<double>(samples);
    auto* workB = arena.take<double>(coarseSamplesOf(grid));
    auto* ring = arena.take<double>(2 * std::size_t{borderSize(grid)});
    if (workA == nullptr || workB == nullptr || ring == nullptr) return ReadStatus::Misuse;

    const Dequantizer dequantize = Dequantizer::fromByte(header.step, header.shifts);
    for (unsigned c = 0; c < kComponents; ++c) {
        reconstructComponent(image, c, dequantize, workA, workB);
        if (classes != nullptr) fuseBorder(workA, grid, classes, diffuse, ring);
        for (std::size_t k = 0; k < samples; ++k) {
            const double value = workA[k];
            if (!(value <= kLargestFloat && value >= -kLargestFloat)) return ReadStatus::Corrupt;
            out[kComponents * k + c] = static_cast<float>(value);
        }
    }
    return ReadStatus::Ok;
}

// The memory a surface is decoded in.
struct SurfaceMemory
{
    SurfaceWork work;
    DetailLevels levels;
    std::uint32_t* mates;
    DetailModels* models;

    /// @param take    take(pointer, count) sets a pointer to so many elements
    /// @param zeroed  the same, of zeros
    template <class Take, class Zeroed> void layOut(std::uint32_t grid, Take&& take, Zeroed&& zeroed)
    {
        work.layOut(grid, take);
        levels.layOut(grid, zeroed);
        take(mates, borderSize(grid));
        take(models, 1);
    }

    static std::uint64_t size(std::uint32_t grid)
    {
        std::uint64_t sum = 0;
        SurfaceMemory memory;
        const auto add = [&](auto*& piece, std::size_t count) {
            piece = nullptr;
            sum += Arena::sizeOf<std::remove_reference_t<decltype(*piece)>>(count);
        };
        memory.layOut(grid, add, add);
        return sum;
    }

    bool take(Arena& arena, std::uint32_t grid)
    {
        bool all = true;
        const auto take = [&](auto*& piece, std::size_t count) {
            piece = arena.take<std::remove_reference_t<decltype(*piece)>>(count);
            if (piece == nullptr) all = false;
        };
        layOut(grid, take, [&](auto*& piece, std::size_t count) {
            take(piece, count);
            if (piece != nullptr) std::memset(static_cast<void*>(piece), 0, count * sizeof *piece);
        });
        return all;
    }
};

/// Details that were coded, as vectors.
template <class Frames> class CodedDetails
{
public:
    CodedDetails(const Frames& frames, const DetailLevels& levels) : frames_(frames), levels_(levels) {}

    bool begin(const SurfaceLevel& level, const double* const (&)[kComponents])
    {
        here_ = &levels_.level[level.index];
        // The middle of what the bits that are missing may hold.
        middle_ = 0.5 * static_cast<double>((1u << here_->missing) - 1);
        return here_->isFilled;
    }

    bool isWanted(std::uint32_t bi, std::uint32_t bj) const
    {
        return here_->blocks.isFilled(bi, bj, 0) || here_->blocks.isFilled(bi, bj, 1);
    }

    Vector operator()(const SurfaceLevel& level, const double* const (&prediction)[kComponents], unsigned,
                      std::uint32_t i, std::uint32_t j, const SharedDetail&) const
    {
        const std::size_t index = codedIndex(level.size, i, j);
        const std::int32_t q[kComponents] = {here_->q[0][index], here_->q[1][index], here_->q[2][index]};
        Vector detail = {0, 0, 0};
        if (q[0] == 0 && q[1] == 0 && q[2] == 0) return detail;
        const Frame frame = frames_.at(prediction, level, i, j);
        for (unsigned c = 0; c < kComponents; ++c) {
            if (q[c] == 0) continue;
            const double steps = q[c] < 0 ? q[c] - middle_ : q[c] + middle_;
            detail = detail + (steps * frame.step[c]) * frame.axis[c];
        }
        return detail;
    }

private:
    const Frames& frames_;
    const DetailLevels& levels_;
    const DetailLevel* here_ = nullptr;
    double middle_ = 0;
};

/// What is asked of encoders.
struct NoDetails
{
    bool isEmpty(unsigned, unsigned) const { return false; }
    bool isFilled(unsigned, std::uint32_t, std::uint32_t, unsigned, unsigned) const { return false; }
    std::int32_t operator()(unsigned, unsigned, std::size_t) const { return 0; }
};

/// @return false: not all are finite floats
bool storeFloats(const double* const (&planes)[kComponents], std::size_t samples, float* out)
{
    bool allFit = true;
    for (std::size_t k = 0; k < samples; ++k)
        for (unsigned c = 0; c < kComponents; ++c) {
            const double value = planes[c][k];
            const bool fits = (value <= kLargestFloat) & (value >= -kLargestFloat);
            allFit &= fits;
            out[kComponents * k + c] = static_cast<float>(fits ? value : 0.0);
        }
    return allFit;
}

ReadStatus decodeSurface(const ImageHeader& header, const SeamView& seam, const std::uint32_t* classes,
                         Arena& arena, float* out)
{
    SurfaceMemory memory;
    if (!memory.take(arena, header.grid)) return ReadStatus::Misuse;
    const GluedBorder border(seam, header.grid, classes, memory.mates);
    new (memory.models) DetailModels();
    RangeDecoder decoder(header.samples, header.isPrefix);
    QuantizedImage coarse;
    codeDetails(decoder, *memory.models, border, kComponents, coarse, memory.levels, 0, NoDetails());
    if (!header.isPrefix && !decoder.finished()) return ReadStatus::Corrupt;
    if (header.isPrefix && decoder.failed() && !decoder.hasEnded()) return ReadStatus::Corrupt;
    const SurfaceFrames frames(surfaceParameters(header));
    CodedDetails details(frames, memory.levels);
    buildSurface(frames, border, coarse.coarse, memory.work, details);
    return storeFloats(memory.work.surface, samplesOf(header.grid), out) ? ReadStatus::Ok
                                                                         : ReadStatus::Corrupt;
}

// Decodes a field's channels by threes.
/// @param store  store(number of a sample's channel, value)
template <class Store>
ReadStatus decodeField(const ImageHeader& header, unsigned channels, bool glued, const SeamView& seam,
                       const std::uint32_t* classes, Arena& arena, const Store& store)
{
    SurfaceMemory memory;
    if (!memory.take(arena, header.grid)) return ReadStatus::Misuse;
    const GluedBorder border =
        glued ? GluedBorder(seam, header.grid, classes, memory.mates) : GluedBorder(header.grid);
    new (memory.models) DetailModels();
    RangeDecoder decoder(header.samples);
    const FieldParameters parameters = fieldParameters(header);
    const std::size_t samples = samplesOf(header.grid);
    for (unsigned first = 0; first < channels; first += kComponents) {
        const unsigned count = channels - first < kComponents ? channels - first : kComponents;
        QuantizedImage coarse;
        if (first > 0) memory.levels.clear();
        codeDetails(decoder, *memory.models, border, count, coarse, memory.levels, 0, NoDetails());
        if (decoder.failed()) return ReadStatus::Corrupt;
        const FieldFrames frames(parameters, count);
        CodedDetails details(frames, memory.levels);
        buildSurface(frames, border, coarse.coarse, memory.work, details);
        for (unsigned c = 0; c < count; ++c)
            for (std::size_t k = 0; k < samples; ++k) {
                const double value = memory.work.surface[c][k];
                if (!(value <= kLargestFloat && value >= -kLargestFloat)) return ReadStatus::Corrupt;
                store(channels * k + first + c, value);
            }
    }
    return decoder.finished() ? ReadStatus::Ok : ReadStatus::Corrupt;
}

/// The integer nearest to a number, halves upwards, of those that the type holds.
template <class Integer> Integer nearestOf(double value)
{
    constexpr Integer most = static_cast<Integer>(~Integer{0});
    if (!(value > 0)) return 0;
    if (value >= most) return most;
    return static_cast<Integer>(static_cast<std::uint32_t>(value + 0.5));
}

ExactFormat exactFormatOf(const ImageHeader& header)
{
    return {header.grid, kComponents, header.coding == GIM_CODING_RAW12 ? kCubeBits : 0};
}

ExactFormat exactFormatOf(const AttributeHeader& header)
{
    return {header.image.grid, header.channels,
            header.type == GIM_U8    ? 8u
            : header.type == GIM_U16 ? 16u
                                     : 0u};
}

template <class Integer>
ReadStatus decodeIntegers(const AttributeHeader& header, const SeamView& seam, const std::uint32_t* classes,
                          Arena& arena, Integer* out)
{
    if (header.image.coding == GIM_CODING_FIELD)
        return decodeField(header.image, header.channels, header.glued, seam, classes, arena,
                           [out](std::size_t k, double value) { out[k] = nearestOf<Integer>(value); });
    const std::size_t count = header.channels * samplesOf(header.image.grid);
    auto* floats = arena.take<float>(count);
    if (floats == nullptr) return ReadStatus::Misuse;
    const ReadStatus status = decodeExact(header.image.samples, exactFormatOf(header),
                                          header.glued ? classes : nullptr, arena, floats);
    if (status != ReadStatus::Ok) return status;
    for (std::size_t k = 0; k < count; ++k) out[k] = static_cast<Integer>(floats[k]);
    return ReadStatus::Ok;
}

// Gives 12-bit integers their place in space.
ReadStatus placeInCube(const ImageHeader& header, float* out)
{
    const std::size_t count = kComponents * samplesOf(header.grid);
    for (std::size_t k = 0; k < count; ++k) {
        const double value = static_cast<double>(header.least[k % kComponents]) +
                             static_cast<double>(out[k]) * static_cast<double>(header.step);
        if (!(value <= kLargestFloat && value >= -kLargestFloat)) return ReadStatus::Corrupt;
        out[k] = static_cast<float>(value);
    }
    return ReadStatus::Ok;
}

} // namespace

SurfaceParameters surfaceParameters(const ImageHeader& header)
{
    SurfaceParameters parameters;
    parameters.step = static_cast<double>(header.step);
    parameters.rise = header.ratios & 0x0Fu;
    parameters.most = 2 * (header.ratios >> 4);
    parameters.areaLimit = 1 + (header.limits & 0x0Fu) / 4.0;
    parameters.flatness = powerOfQuarters(2 * (header.limits >> 4));
    return parameters;
}

FieldParameters fieldParameters(const ImageHeader& header)
{
    FieldParameters parameters;
    parameters.step = static_cast<double>(header.step);
    parameters.axes = static_cast<FieldAxes>(header.axes & 0x0Fu);
    parameters.ratio = powerOfQuarters(2 * (header.axes >> 4));
    return parameters;
}

ReadStatus readImageHeader(format::ByteSpan content, ImageKind image, ImageHeader* header)
{
    // The chunk is known to be complete: what is missing inside it is an error of its own.
    format::Reader in(content);
    const std::uint8_t kind = in.u8();
    if (in.failed()) return ReadStatus::Corrupt;
    const unsigned exponent = kind & 0x0Fu, coding = kind >> 4 & 0x07u;
    if (kind >> 7 != 0 || !isCodingOf(image, coding)) return ReadStatus::Unsupported;
    if (exponent == 0 || exponent > kLargestExponent) return ReadStatus::Unsupported;
    header->grid = (1u << exponent) + 1;
    header->coding = static_cast<gim_coding>(coding);
    if (header->coding == GIM_CODING_WAVELET) {
        header->step = in.f32();
        header->shifts = in.u8();
    } else if (header->coding == GIM_CODING_SURFACE) {
        header->step = in.f32();
        header->ratios = in.u8();
        header->limits = in.u8();
    } else if (header->coding == GIM_CODING_FIELD) {
        header->step = in.f32();
        header->axes = in.u8();
        if (!in.failed() && (header->axes & 0x0Fu) > static_cast<unsigned>(FieldAxes::Radial))
            return ReadStatus::Unsupported;
    } else if (header->coding == GIM_CODING_RAW12) {
        for (float& least : header->least) least = in.f32();
        header->step = in.f32();
    }
    if (in.failed()) return ReadStatus::Corrupt;
    if (header->coding != GIM_CODING_FLOAT && !stepInRange(header->step)) return ReadStatus::Corrupt;
    for (const float least : header->least)
        if (!isFinite(least)) return ReadStatus::Corrupt;
    header->fixedBytes = in.offset();
    header->samples = in.span(in.remaining());
    return ReadStatus::Ok;
}

ReadStatus decodeCoefficients(const ImageHeader& header, Arena& arena, QuantizedImage* image)
{
    const std::size_t samples = samplesOf(header.grid);
    image->grid = header.grid;
    for (auto& plane : image->detail) {
        plane = arena.take<std::int32_t>(samples);
        if (plane == nullptr) return ReadStatus::Misuse;
        std::memset(plane, 0, samples * sizeof *plane);
    }
    auto* rows = arena.take<std::int32_t>(rowScratchOf(header.grid));
    auto* models = arena.take<CoefficientModels>(1);
    if (rows == nullptr || models == nullptr) return ReadStatus::Misuse;

    RangeDecoder decoder(header.samples);
    new (models) CoefficientModels();
    const PlainPick pick;
    const NothingKnown nothing;
    codeImage(decoder, *models, *image, pick, nothing, rows);
    return decoder.finished() ? ReadStatus::Ok : ReadStatus::Corrupt;
}

std::uint64_t imageWorkspace(const ImageHeader& header)
{
    const std::size_t samples = samplesOf(header.grid);
    if (header.coding == GIM_CODING_RAW12 || header.coding == GIM_CODING_FLOAT)
        return exactWorkspace(exactFormatOf(header));
    if (header.coding == GIM_CODING_SURFACE || header.coding == GIM_CODING_FIELD)
        return SurfaceMemory::size(header.grid);
    return kComponents * Arena::sizeOf<std::int32_t>(samples) +
           Arena::sizeOf<std::int32_t>(rowScratchOf(header.grid)) + Arena::sizeOf<CoefficientModels>(1) +
           Arena::sizeOf<double>(samples) + Arena::sizeOf<double>(coarseSamplesOf(header.grid)) +
           Arena::sizeOf<double>(2 * std::size_t{borderSize(header.grid)});
}

ReadStatus decodeImage(const ImageHeader& header, const SeamView& seam, const std::uint32_t* classes,
                       std::uint32_t flags, Arena& arena, float* out)
{
    if (header.coding == GIM_CODING_SURFACE) return decodeSurface(header, seam, classes, arena, out);
    if (header.coding == GIM_CODING_FIELD)
        return decodeField(header, kComponents, true, seam, classes, arena,
                           [out](std::size_t k, double value) { out[k] = static_cast<float>(value); });
    if (header.coding == GIM_CODING_WAVELET) {
        if ((flags & GIM_NO_FUSE) != 0) classes = nullptr;
        return decodeWavelet(header, classes, (flags & GIM_NO_DIFFUSE) == 0, arena, out);
    }
    const ReadStatus status = decodeExact(header.samples, exactFormatOf(header), classes, arena, out);
    if (status != ReadStatus::Ok || header.coding == GIM_CODING_FLOAT) return status;
    return placeInCube(header, out);
}

std::uint64_t attributeWorkspace(const AttributeHeader& header)
{
    if (header.image.coding == GIM_CODING_FIELD) return imageWorkspace(header.image);
    const std::uint64_t floats =
        header.type == GIM_F32 ? 0 : Arena::sizeOf<float>(header.channels * samplesOf(header.image.grid));
    return exactWorkspace(exactFormatOf(header)) + floats;
}

ReadStatus decodeAttribute(const AttributeHeader& header, const SeamView& seam, const std::uint32_t* classes,
                           Arena& arena, void* out)
{
    switch (header.type) {
    case GIM_U8:
        return decodeIntegers(header, seam, classes, arena, static_cast<std::uint8_t*>(out));
    case GIM_U16:
        return decodeIntegers(header, seam, classes, arena, static_cast<std::uint16_t*>(out));
    default:
        break;
    }
    auto* floats = static_cast<float*>(out);
    if (header.image.coding == GIM_CODING_FIELD)
        return decodeField(header.image, header.channels, header.glued, seam, classes, arena,
                           [floats](std::size_t k, double value) { floats[k] = static_cast<float>(value); });
    return decodeExact(header.image.samples, exactFormatOf(header), header.glued ? classes : nullptr, arena,
                       floats);
}

void normalize(float* vectors, std::size_t count)
{
    for (std::size_t k = 0; k < count; ++k) {
        float* v = vectors + 3 * k;
        const double x = v[0], y = v[1], z = v[2];
        // Twice, because the square of a very small component is less than any number.
        const double largest = [](double a, double b, double c) {
            a = a < 0 ? -a : a;
            b = b < 0 ? -b : b;
            c = c < 0 ? -c : c;
            const double ab = a < b ? b : a;
            return ab < c ? c : ab;
        }(x, y, z);
        if (largest == 0) {
            v[0] = v[1] = 0;
            v[2] = 1;
            continue;
        }
        const double sx = x / largest, sy = y / largest, sz = z / largest;
        const double length = std::sqrt(sx * sx + sy * sy + sz * sz);
        v[0] = static_cast<float>(sx / length);
        v[1] = static_cast<float>(sy / length);
        v[2] = static_cast<float>(sz / length);
    }
}

} // namespace gimg::codec

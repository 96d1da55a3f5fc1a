#include "arena.h"
#include "detail_passes.h"
#include "fuse.h"
#include "image_header.h"
#include "range_decoder.h"
#include "surface_code.h"

#include <cmath>
#include <cstring>
#include <new>
#include <type_traits>
#include <zlib.h>

namespace gimg::codec {

namespace {

constexpr double kLargestFloat = 3.4028234663852886e38;
// zlib's inflate asks for its state and a 32 KiB window; variants of zlib for a little more.
constexpr std::size_t kInflateMemory = std::size_t{1} << 17;

bool isFinite(float value) { return value - value == 0.0f; }

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

    template <class Take> void layOut(std::uint32_t grid, Take&& take)
    {
        work.layOut(grid, take);
        levels.layOut(grid, take);
        take(mates, borderSize(grid));
        take(models, 1);
    }

    static std::uint64_t size(std::uint32_t grid)
    {
        std::uint64_t sum = 0;
        SurfaceMemory memory;
        memory.layOut(grid, [&](auto*& piece, std::size_t count) {
            piece = nullptr;
            sum += Arena::sizeOf<std::remove_reference_t<decltype(*piece)>>(count);
        });
        return sum;
    }

    bool take(Arena& arena, std::uint32_t grid)
    {
        bool all = true;
        layOut(grid, [&](auto*& piece, std::size_t count) {
            piece = arena.take<std::remove_reference_t<decltype(*piece)>>(count);
            if (piece == nullptr)
                all = false;
            else
                std::memset(static_cast<void*>(piece), 0, count * sizeof *piece);
        });
        return all;
    }
};

/// Details that were coded, as vectors.
class CodedDetails
{
public:
    CodedDetails(const SurfaceParameters& parameters, const DetailLevels& levels)
        : parameters_(parameters), levels_(levels)
    {
    }

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
        const Frame frame = frameAt(prediction, level, parameters_, i, j);
        for (unsigned c = 0; c < kComponents; ++c) {
            if (q[c] == 0) continue;
            const double steps = q[c] < 0 ? q[c] - middle_ : q[c] + middle_;
            detail = detail + (steps * frame.step[c]) * frame.axis[c];
        }
        return detail;
    }

private:
    const SurfaceParameters& parameters_;
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

ReadStatus decodeSurface(const ImageHeader& header, const SeamView& seam, const std::uint32_t* classes,
                         Arena& arena, float* out)
{
    SurfaceMemory memory;
    if (!memory.take(arena, header.grid)) return ReadStatus::Misuse;
    const GluedBorder border(seam, header.grid, classes, memory.mates);
    new (memory.models) DetailModels();
    RangeDecoder decoder(header.samples, header.isPrefix);
    QuantizedImage coarse;
    codeSurface(decoder, *memory.models, border, coarse, memory.levels, 0, NoDetails());
    if (!header.isPrefix && !decoder.finished()) return ReadStatus::Corrupt;
    if (header.isPrefix && decoder.failed() && !decoder.hasEnded()) return ReadStatus::Corrupt;
    const SurfaceParameters parameters = surfaceParameters(header);
    CodedDetails details(parameters, memory.levels);
    buildSurface(parameters, border, coarse.coarse, memory.work, details);
    const std::size_t samples = samplesOf(header.grid);
    for (unsigned c = 0; c < kComponents; ++c)
        for (std::size_t k = 0; k < samples; ++k) {
            const double value = memory.work.surface[c][k];
            if (!(value <= kLargestFloat && value >= -kLargestFloat)) return ReadStatus::Corrupt;
            out[kComponents * k + c] = static_cast<float>(value);
        }
    return ReadStatus::Ok;
}

ReadStatus decodeRaw12(const ImageHeader& header, float* out)
{
    const std::uint8_t* bytes = header.samples.data;
    const std::size_t count = kComponents * samplesOf(header.grid);
    for (std::size_t k = 0; k < count; ++k) {
        const std::uint8_t* pair = bytes + k / 2 * 3;
        const std::uint32_t q = k % 2 == 0 ? pair[0] | (pair[1] & 0x0Fu) << 8 : pair[1] >> 4 | pair[2] << 4;
        const double value =
            static_cast<double>(header.least[k % kComponents]) + q * static_cast<double>(header.step);
        if (!(value <= kLargestFloat && value >= -kLargestFloat)) return ReadStatus::Corrupt;
        out[k] = static_cast<float>(value);
    }
    // The count is odd, so half a byte is left over.
    if (bytes[header.samples.size - 1] >> 4 != 0) return ReadStatus::Corrupt;
    return ReadStatus::Ok;
}

void* takeForZlib(void* arena, unsigned items, unsigned size)
{
    return static_cast<Arena*>(arena)->take<unsigned char>(std::size_t{items} * size);
}

void leaveToArena(void*, void*) {}

// Inflates into exactly `size` bytes.
ReadStatus inflateExactly(format::ByteSpan packed, std::uint8_t* out, std::size_t size, Arena& arena)
{
    void* memory = arena.take<unsigned char>(kInflateMemory);
    if (memory == nullptr) return ReadStatus::Misuse;
    Arena pool(memory, kInflateMemory);
    z_stream stream;
    std::memset(&stream, 0, sizeof stream);
    stream.zalloc = takeForZlib;
    stream.zfree = leaveToArena;
    stream.opaque = &pool;
    if (inflateInit(&stream) != Z_OK) return ReadStatus::Misuse;
    stream.next_in = const_cast<Bytef*>(packed.data);
    stream.avail_in = static_cast<uInt>(packed.size);
    stream.next_out = out;
    stream.avail_out = static_cast<uInt>(size);
    const int status = inflate(&stream, Z_FINISH);
    const bool exact = status == Z_STREAM_END && stream.avail_out == 0 && stream.avail_in == 0;
    inflateEnd(&stream);
    return exact ? ReadStatus::Ok : ReadStatus::Corrupt;
}

// A float's bits are coded as the difference from the sample before in the row (or, at its beginning,
// from the row below), the sign moved to the lowest bit; then bytes of equal rank lie together.
ReadStatus decodeFloat(const ImageHeader& header, Arena& arena, float* out)
{
    const std::uint32_t grid = header.grid;
    const std::size_t samples = samplesOf(grid);
    auto* planes = arena.take<std::uint8_t>(4 * kComponents * samples);
    if (planes == nullptr) return ReadStatus::Misuse;
    const ReadStatus status = inflateExactly(header.samples, planes, 4 * kComponents * samples, arena);
    if (status != ReadStatus::Ok) return status;
    for (unsigned c = 0; c < kComponents; ++c) {
        const std::uint8_t* plane = planes + 4 * c * samples;
        for (std::size_t k = 0; k < samples; ++k) {
            const std::uint32_t coded = plane[k] | std::uint32_t{plane[samples + k]} << 8 |
                                        std::uint32_t{plane[2 * samples + k]} << 16 |
                                        std::uint32_t{plane[3 * samples + k]} << 24;
            const std::uint32_t difference = coded >> 1 ^ (~(coded & 1u) + 1u);
            std::uint32_t bits = 0;
            if (k > 0)
                std::memcpy(&bits, &out[kComponents * (k % grid == 0 ? k - grid : k - 1) + c], sizeof bits);
            bits += difference;
            std::memcpy(&out[kComponents * k + c], &bits, sizeof bits);
            if ((bits >> 23 & 0xFFu) == 0xFFu) return ReadStatus::Corrupt;
        }
    }
    return ReadStatus::Ok;
}

// In the raw codings glued samples agree already if the encoder was given a closed surface; taking the
// first of each class leaves such samples alone to the bit, and closes the others.
void copyFirstOfClass(float* out, std::uint32_t grid, const std::uint32_t* classes)
{
    for (std::uint32_t k = 0; k < borderSize(grid); ++k) {
        if (classes[k] == k) continue;
        std::memcpy(&out[kComponents * std::size_t{borderSample(grid, k)}],
                    &out[kComponents * std::size_t{borderSample(grid, classes[k])}],
                    kComponents * sizeof *out);
    }
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

ReadStatus readImageHeader(format::ByteSpan content, ImageKind image, ImageHeader* header)
{
    // The chunk is known to be complete: what is missing inside it is an error of its own.
    format::Reader in(content);
    const std::uint8_t kind = in.u8();
    if (in.failed()) return ReadStatus::Corrupt;
    const unsigned exponent = kind & 0x0Fu, coding = kind >> 4 & 0x07u;
    if (kind >> 7 != 0 || coding > GIM_CODING_SURFACE) return ReadStatus::Unsupported;
    if (coding == GIM_CODING_SURFACE && image != ImageKind::Geometry) return ReadStatus::Unsupported;
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
    if (header->coding == GIM_CODING_RAW12 && header->samples.size != raw12Size(header->grid))
        return ReadStatus::Corrupt;
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
    if (header.coding == GIM_CODING_RAW12) return 0;
    if (header.coding == GIM_CODING_FLOAT)
        return Arena::sizeOf<std::uint8_t>(4 * kComponents * samples) +
               Arena::sizeOf<std::uint8_t>(kInflateMemory);
    if (header.coding == GIM_CODING_SURFACE) return SurfaceMemory::size(header.grid);
    return kComponents * Arena::sizeOf<std::int32_t>(samples) +
           Arena::sizeOf<std::int32_t>(rowScratchOf(header.grid)) + Arena::sizeOf<CoefficientModels>(1) +
           Arena::sizeOf<double>(samples) + Arena::sizeOf<double>(coarseSamplesOf(header.grid)) +
           Arena::sizeOf<double>(2 * std::size_t{borderSize(header.grid)});
}

ReadStatus decodeImage(const ImageHeader& header, const SeamView& seam, const std::uint32_t* classes,
                       std::uint32_t flags, Arena& arena, float* out)
{
    if (header.coding == GIM_CODING_SURFACE) return decodeSurface(header, seam, classes, arena, out);
    if ((flags & GIM_NO_FUSE) != 0) classes = nullptr;
    if (header.coding == GIM_CODING_WAVELET)
        return decodeWavelet(header, classes, (flags & GIM_NO_DIFFUSE) == 0, arena, out);
    const ReadStatus status =
        header.coding == GIM_CODING_RAW12 ? decodeRaw12(header, out) : decodeFloat(header, arena, out);
    if (status == ReadStatus::Ok && classes != nullptr) copyFirstOfClass(out, header.grid, classes);
    return status;
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

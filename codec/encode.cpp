#include "encode.h"

#include "field_set.h"
#include "format/container.h"
#include "format/writer.h"
#include "image_content.h"
#include "image_header.h"
#include "step_search.h"

namespace gimg::codec {

namespace {

using Bytes = std::vector<std::uint8_t>;

EncodeError badSource(std::string message) { return {EncodeError::Kind::BadSource, std::move(message), 0}; }

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

Bytes assemble(std::uint32_t lowest, const Bytes& word, const Bytes& geometry,
               const std::vector<FieldSet::Chunk>& fields)
{
    Bytes seam(1 + word.size(), static_cast<std::uint8_t>(log2Floor(lowest - 1)));
    std::copy(word.begin(), word.end(), seam.begin() + 1);
    format::Writer writer;
    writer.addChunk(format::kSeamChunk, seam);
    writer.addChunk(format::kGeometryChunk, geometry);
    for (const FieldSet::Chunk& field : fields) writer.addChunk(field.type, field.content);
    return writer.finish();
}

// Of the normals, which come first; 0 without.
float normalStepOf(const std::vector<FieldSet::Chunk>& fields)
{
    return !fields.empty() && fields.front().type == format::kNormalChunk ? fields.front().step : 0;
}

} // namespace

Encoder::Encoder(const Source& source, std::shared_ptr<const FieldSet> fields)
    : seam_(source.seam), word_(encodeSeam(source.seam)), xyz_(source.xyz.begin(), source.xyz.end()),
      surfaceEncoder_(std::make_shared<SurfaceEncoder>(source.seam, source.grid, source.smoothLevels)),
      surface_(surfaceEncoder_->transform(xyz_)), fields_(std::move(fields))
{
}

Outcome<Encoder> Encoder::prepare(const Source& source)
{
    if (std::string fault = seamFault(source.seam); !fault.empty()) return badSource("seam: " + fault);
    if (std::string fault = imageFault("geometry", source.xyz, source.grid, source.seam.lowest, kComponents);
        !fault.empty())
        return badSource(fault);
    Outcome<FieldSet> fields = FieldSet::prepare(source);
    if (EncodeError* error = std::get_if<EncodeError>(&fields)) return *error;
    return Encoder(source, std::make_shared<const FieldSet>(std::move(std::get<FieldSet>(fields))));
}

Encoder Encoder::withFieldsOf(const Encoder& other) const
{
    Encoder out = *this;
    out.fields_ = other.fields_;
    return out;
}

Outcome<Encoder> Encoder::slid(float step, const Slides& slides, const Retarget& retarget) const
{
    if (const std::string fault = stepFault(surface_, step, "the step"); !fault.empty())
        return EncodeError{EncodeError::Kind::BadSettings, fault, 0};
    Encoder moved = *this;
    moved.surface_.prefixCare = slides.prefixCare;
    for (const int octave : slides.octaves) {
        const float coarser = std::min(std::ldexp(step, octave), kLargestStep);
        const CodedSurface coded = surfaceEncoder_->encode(moved.surface_, parametersOf(coarser), false);
        retarget(coded.decoded, moved.xyz_);
        moved.surface_ = surfaceEncoder_->transform(moved.xyz_);
        moved.surface_.prefixCare = slides.prefixCare;
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
    file.step = settings.step;
    Bytes geometry;
    switch (settings.coding) {
    case GIM_CODING_SURFACE:
        if (std::string fault = stepFault(surface_, settings.step, "the step"); !fault.empty())
            return failed(fault);
        geometry = surfaceContent(*surfaceEncoder_, surface_, settings.step);
        break;
    case GIM_CODING_WAVELET: {
        const TransformedImage image = codec::transform(xyz_, surface_.grid);
        if (std::string fault = stepFault(image, settings.step, "the step"); !fault.empty())
            return failed(fault);
        geometry = waveletContent(image, settings.step);
        break;
    }
    case GIM_CODING_RAW12: {
        IntegerContent integers = integerContent(xyz_, surface_.grid, seam_);
        if (integers.content.empty()) return failed("the samples are too large for 12-bit coding");
        geometry = std::move(integers.content);
        file.step = integers.step;
        break;
    }
    case GIM_CODING_FLOAT:
        geometry = exactContent(xyz_, surface_.grid, GIM_CODING_FLOAT, {}, seam_);
        file.step = 0;
        break;
    default:
        return failed("no such coding");
    }
    const auto fields = fields_->encode(settings);
    if (const EncodeError* error = std::get_if<EncodeError>(&fields)) return *error;
    const auto& chunks = std::get<std::vector<FieldSet::Chunk>>(fields);
    file.normalStep = normalStepOf(chunks);
    file.bytes = assemble(seam_.lowest, word_, geometry, chunks);
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
    const auto fields = fields_->encodeShares(room, coding);
    if (const EncodeError* error = std::get_if<EncodeError>(&fields)) return *error;
    const auto& chunks = std::get<std::vector<FieldSet::Chunk>>(fields);
    const std::size_t fieldSize = FieldSet::sizeOf(chunks);

    const std::size_t left = room > fieldSize ? room - fieldSize : 0;
    auto found = [&] {
        if (coding == GIM_CODING_SURFACE)
            return searchStep(
                surface_, [&](float step) { return surfaceContent(*surfaceEncoder_, surface_, step); }, left);
        const TransformedImage image = codec::transform(xyz_, surface_.grid);
        return searchStep(
            image, [&](float step) { return waveletContent(image, step); }, left);
    }();
    if (EncodeError* error = std::get_if<EncodeError>(&found)) return unreachable(*error, fieldSize);
    Candidate& geometry = std::get<Candidate>(found);
    EncodedFile file;
    file.bytes = assemble(seam_.lowest, word_, geometry.content, chunks);
    file.step = geometry.step;
    file.normalStep = normalStepOf(chunks);
    return file;
}

} // namespace gimg::codec

#include "field_set.h"

#include "attribute_header.h"
#include "exact_encoder.h"
#include "format/container.h"
#include "format/writer.h"
#include "image_content.h"
#include "seam_code.h"
#include "step_search.h"

namespace gimg::codec {

namespace {

using Bytes = std::vector<std::uint8_t>;
using Chunks = std::vector<FieldSet::Chunk>;

/// Of unit vectors, the length may err by twice as much as the direction: it is restored. Found by trial.
constexpr unsigned kRadialRatio = 2;
/// Integers come back as they were long before this step, in units of theirs.
constexpr float kFinestOfIntegers = 1.0f / 8;
/// The step at which axes are compared, as a fraction of the span.
constexpr double kTrialStep = 1.0 / 64;

EncodeError badSource(std::string message) { return {EncodeError::Kind::BadSource, std::move(message), 0}; }

double largestOf(gim_sample_type type) { return type == GIM_U8 ? 255 : 65535; }

std::string attributeFault(const AttributeSource& source, std::uint32_t lowest)
{
    const format::ByteSpan name{reinterpret_cast<const std::uint8_t*>(source.name.data()),
                                source.name.size()};
    if (!isAttributeName(name)) return "an attribute's name is not 1 to 63 bytes of plain UTF-8";
    const std::string what = "attribute " + source.name;
    if (source.channels < 1 || source.channels > kMaxChannels) return what + ": not 1 to 16 channels";
    if (std::string fault = imageFault(what, source.samples, source.grid, lowest, source.channels);
        !fault.empty())
        return fault;
    if (source.type == GIM_F32) return source.normalized ? what + ": floats are not normalized" : "";
    for (const float value : source.samples)
        if (!(value >= 0 && value <= largestOf(source.type)) || value != std::floor(value))
            return what + ": a sample is no integer of its type";
    return {};
}

// Of the channel whose values differ most; of one value, its magnitude.
double spanOf(std::span<const float> samples, unsigned channels)
{
    double span = 0, largest = 0;
    for (unsigned c = 0; c < channels; ++c) {
        double least = static_cast<double>(samples[c]), most = least;
        for (std::size_t k = c; k < samples.size(); k += channels) {
            least = std::min(least, static_cast<double>(samples[k]));
            most = std::max(most, static_cast<double>(samples[k]));
        }
        span = std::max(span, most - least);
        largest = std::max({largest, std::abs(least), std::abs(most)});
    }
    return span > 0 ? span : largest > 0 ? largest : 1;
}

} // namespace

FieldParameters FieldSet::Image::parameters(float step) const
{
    ImageHeader header;
    header.step = step;
    header.axes = static_cast<std::uint8_t>(static_cast<unsigned>(axes) | halfOctaves << 4);
    return fieldParameters(header);
}

Bytes FieldSet::Image::contentAt(float step) const
{
    Bytes content = head;
    content.push_back(imageContent(field.grid, GIM_CODING_FIELD).front());
    format::appendF32(content, step);
    content.push_back(static_cast<std::uint8_t>(static_cast<unsigned>(axes) | halfOctaves << 4));
    for (const std::uint8_t byte : encoder->encodeField(field, parameters(step)).payload)
        content.push_back(byte);
    return content;
}

Outcome<FieldSet> FieldSet::prepare(const Source& source)
{
    FieldSet set;
    set.seam_ = source.seam;
    const auto encoderOf = [&](std::uint32_t grid) {
        return std::make_shared<const SurfaceEncoder>(source.seam, grid);
    };
    if (source.normalGrid != 0) {
        if (std::string fault =
                imageFault("normals", source.normals, source.normalGrid, source.seam.lowest, kComponents);
            !fault.empty())
            return badSource(fault);
        Image image{encoderOf(source.normalGrid), {}, FieldAxes::Radial, kRadialRatio, {}, 2};
        image.field = image.encoder->transformField(source.normals, kComponents, true);
        set.normals_.emplace(
            Normals{source.normalGrid, {source.normals.begin(), source.normals.end()}, std::move(image)});
    }
    if (source.attributes.size() > format::kMaxAttributes) return badSource("more than 16 attributes");
    for (const AttributeSource& given : source.attributes) {
        if (std::string fault = attributeFault(given, source.seam.lowest); !fault.empty())
            return badSource(fault);
        for (const Attribute& before : set.attributes_)
            if (before.source.name == given.name) return badSource("two attributes named " + given.name);
        Image image{encoderOf(given.grid), {}, FieldAxes::Channels, 0, {}, 0};
        image.field = image.encoder->transformField(given.samples, given.channels, given.glued);
        image.span = spanOf(given.samples, given.channels);
        if (given.type != GIM_F32) image.field.finest = kFinestOfIntegers;
        image.head.push_back(static_cast<std::uint8_t>(given.name.size()));
        image.head.insert(image.head.end(), given.name.begin(), given.name.end());
        image.head.push_back(static_cast<std::uint8_t>(given.channels));
        image.head.push_back(static_cast<std::uint8_t>(given.type | (given.glued ? kGluedFlag : 0) |
                                                       (given.normalized ? kNormalizedFlag : 0)));
        if (given.channels >= kComponents && image.field.largest <= kLargestCoefficient) {
            const float step =
                std::max(static_cast<float>(image.span * kTrialStep), smallestStep(image.field));
            const std::size_t apart = image.contentAt(step).size();
            image.axes = FieldAxes::Mean;
            if (image.contentAt(step).size() >= apart) image.axes = FieldAxes::Channels;
        }
        set.attributes_.push_back({given, {given.samples.begin(), given.samples.end()}, std::move(image)});
        set.attributes_.back().source.samples = {};
    }
    return set;
}

std::size_t FieldSet::sizeOf(const Chunks& chunks)
{
    std::size_t size = 0;
    for (const Chunk& chunk : chunks) size += format::chunkSize(chunk.content.size());
    return size;
}

Outcome<Chunks> FieldSet::encode(const Settings& settings) const
{
    const auto failed = [](std::string message) {
        return EncodeError{EncodeError::Kind::BadSettings, std::move(message), 0};
    };
    Chunks chunks;
    if (normals_) {
        Chunk chunk{format::kNormalChunk, {}, settings.normalStep};
        switch (settings.coding) {
        case GIM_CODING_WAVELET: {
            const TransformedImage image = codec::transform(normals_->samples, normals_->grid);
            if (std::string fault = stepFault(image, chunk.step, "the normals' step"); !fault.empty())
                return failed(fault);
            chunk.content = waveletContent(image, chunk.step);
            break;
        }
        case GIM_CODING_RAW12: {
            IntegerContent integers = integerContent(normals_->samples, normals_->grid, seam_);
            chunk.content = std::move(integers.content);
            chunk.step = integers.step;
            break;
        }
        case GIM_CODING_FLOAT:
            chunk.content = exactContent(normals_->samples, normals_->grid, GIM_CODING_FLOAT, {}, seam_);
            chunk.step = 0;
            break;
        default:
            if (std::string fault = stepFault(normals_->image.field, chunk.step, "the normals' step");
                !fault.empty())
                return failed(fault);
            chunk.content = normals_->image.contentAt(chunk.step);
        }
        chunks.push_back(std::move(chunk));
    }
    const bool exactly = settings.coding == GIM_CODING_RAW12 || settings.coding == GIM_CODING_FLOAT;
    for (const Attribute& attribute : attributes_) {
        if (exactly || attribute.source.lossless) {
            chunks.push_back({format::kAttributeChunk, exactContentOf(attribute), 0});
            continue;
        }
        const auto step = std::max(static_cast<float>(attribute.image.span * settings.attributeStep),
                                   smallestStep(attribute.image.field));
        const std::string name = "the step of " + attribute.source.name;
        if (std::string fault = stepFault(attribute.image.field, step, name.c_str()); !fault.empty())
            return failed(fault);
        chunks.push_back({format::kAttributeChunk, attribute.image.contentAt(step), step});
    }
    return chunks;
}

Bytes FieldSet::exactContentOf(const Attribute& attribute) const
{
    const AttributeSource& source = attribute.source;
    Bytes content = attribute.image.head;
    content.push_back(imageContent(source.grid, GIM_CODING_FLOAT).front());
    const ExactFormat format = {source.grid, source.channels,
                                source.type == GIM_U8    ? 8u
                                : source.type == GIM_U16 ? 16u
                                                         : 0u};
    const std::vector<std::uint32_t> classes =
        source.glued ? borderClasses(seam_, source.grid) : std::vector<std::uint32_t>();
    for (const std::uint8_t byte : encodeExact(attribute.samples, format, classes)) content.push_back(byte);
    return content;
}

/// An image that is to have a share.
struct FieldSet::Part
{
    double weight = 0;
    std::function<std::variant<Candidate, EncodeError>(std::size_t)> search;
    std::function<Candidate(bool finest)> extreme;
};

Outcome<Chunks> FieldSet::encodeParts(std::size_t room, double total, gim_coding coding,
                                      bool redistributes) const
{
    std::vector<Part> parts;
    Chunks chunks;
    const auto add = [&](std::uint8_t type, double weight, const auto& image, auto contentAt) {
        chunks.push_back({type, {}, 0});
        parts.push_back({weight,
                         [&image, contentAt](std::size_t size) { return searchStep(image, contentAt, size); },
                         [&image, contentAt](bool finest) {
                             const StepRange range = sensibleSteps(image);
                             const float step = finest ? range.finest : range.coarsest;
                             return Candidate{contentAt(step), step};
                         }});
    };
    const auto addField = [&](std::uint8_t type, double weight, const Image& image) {
        add(type, weight, image.field, [&image](float step) { return image.contentAt(step); });
    };
    std::optional<TransformedImage> wavelet;
    if (normals_ && coding == GIM_CODING_WAVELET) {
        wavelet = codec::transform(normals_->samples, normals_->grid);
        add(format::kNormalChunk, kNormalShare, *wavelet,
            [&wavelet](float step) { return waveletContent(*wavelet, step); });
    } else if (normals_) {
        addField(format::kNormalChunk, kNormalShare, normals_->image);
    }
    auto left = static_cast<double>(room);
    std::vector<bool> done(parts.size(), false); // lossless ones from the start
    for (const Attribute& attribute : attributes_) {
        if (!attribute.source.lossless) {
            addField(format::kAttributeChunk, kAttributeShare, attribute.image);
        } else {
            parts.emplace_back();
            chunks.push_back({format::kAttributeChunk, exactContentOf(attribute), 0});
            left -= static_cast<double>(format::chunkSize(chunks.back().content.size()));
        }
        done.resize(parts.size(), attribute.source.lossless);
    }

    double weights = 0;
    for (const Part& part : parts) weights += part.weight;
    left = std::max(left, 0.0);
    if (!redistributes) left *= std::min(total, weights);
    // Parts that cannot use their share are settled first, and what they leave may go to the others.
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t k = 0; k < parts.size(); ++k) {
            if (done[k]) continue;
            const double share = weights > 0 ? std::max(left, 0.0) * parts[k].weight / weights : 0;
            auto found = parts[k].search(static_cast<std::size_t>(share));
            Candidate best;
            if (EncodeError* error = std::get_if<EncodeError>(&found)) {
                if (error->kind == EncodeError::Kind::BadSettings) return *error;
                best = parts[k].extreme(error->kind == EncodeError::Kind::TooLarge);
                done[k] = true;
            } else {
                best = std::move(std::get<Candidate>(found));
            }
            chunks[k].content = std::move(best.content);
            chunks[k].step = best.step;
            if (!done[k] || !redistributes) continue;
            left -= static_cast<double>(format::chunkSize(chunks[k].content.size()));
            weights -= parts[k].weight;
            changed = true;
            break;
        }
    }
    return chunks;
}

Outcome<Chunks> FieldSet::encodeShares(std::size_t room, gim_coding coding) const
{
    return encodeParts(room, kMostShare, coding, false);
}

Outcome<Chunks> FieldSet::encodeInto(std::size_t room, gim_coding coding) const
{
    return encodeParts(room, 1, coding, true);
}

Outcome<EncodedFile> withFields(std::span<const std::uint8_t> file, const FieldSet& fields,
                                const Settings& settings, std::optional<std::size_t> target)
{
    format::Contents contents;
    if (format::readContents({file.data(), file.size()}, false, &contents) != ReadStatus::Ok)
        return badSource("the bytes are no file");
    const auto bytesOf = [](format::ByteSpan span) { return Bytes(span.data, span.data + span.size); };
    format::Writer writer;
    writer.addChunk(format::kSeamChunk, bytesOf(contents.seam.content));
    writer.addChunk(format::kGeometryChunk, bytesOf(contents.geometry.content));
    const std::size_t fixed = writer.finish().size();
    const std::size_t room = target && *target > fixed ? *target - fixed : 0;
    auto coded = target ? fields.encodeInto(room, settings.coding) : fields.encode(settings);
    if (EncodeError* error = std::get_if<EncodeError>(&coded)) return *error;
    const Chunks& chunks = std::get<Chunks>(coded);
    if (target && FieldSet::sizeOf(chunks) > room) {
        const std::size_t size = fixed + FieldSet::sizeOf(chunks);
        return EncodeError{EncodeError::Kind::TooSmall,
                           "the smallest file takes " + std::to_string(size) + " bytes", size};
    }
    EncodedFile out;
    for (const FieldSet::Chunk& chunk : chunks) {
        writer.addChunk(chunk.type, chunk.content);
        if (chunk.type == format::kNormalChunk) out.normalStep = chunk.step;
    }
    out.bytes = writer.finish();
    return out;
}

} // namespace gimg::codec

#pragma once

#include "encode.h"

namespace gimg::codec {

/// The images that go with a geometry: normals and attributes, after their forward transform.
///
/// Of a file's bytes that are neither container nor seam, normals get a quarter and each attribute that is
/// not lossless an eighth, all of them together at most a half; lossless ones take what they need first.
class FieldSet
{
public:
    static constexpr double kNormalShare = 0.25, kAttributeShare = 0.125, kMostShare = 0.5;

    /// Of a source's normals and attributes. BadSource: as Encoder::prepare.
    static Outcome<FieldSet> prepare(const Source& source);

    struct Chunk
    {
        std::uint8_t type = 0;
        std::vector<std::uint8_t> content;
        float step = 0;
    };

    bool isEmpty() const { return !normals_ && attributes_.empty(); }

    /// Errors: as Encoder::encode.
    Outcome<std::vector<Chunk>> encode(const Settings& settings) const;

    /// The shares of `room` bytes. What an image cannot use is left over; one that cannot be as small as its
    /// share is as small as it can.
    Outcome<std::vector<Chunk>> encodeShares(std::size_t room, gim_coding coding) const;

    /// Fills `room` bytes: what an image cannot use goes to the others.
    Outcome<std::vector<Chunk>> encodeInto(std::size_t room, gim_coding coding) const;

    static std::size_t sizeOf(const std::vector<Chunk>& chunks);

private:
    struct Image
    {
        std::shared_ptr<const SurfaceEncoder> encoder;
        TransformedField field;
        FieldAxes axes = FieldAxes::Channels;
        unsigned halfOctaves = 0;       ///< of FieldParameters::ratio
        std::vector<std::uint8_t> head; ///< of the chunk, up to the kind byte of its coding
        double span = 0;                ///< of the values

        std::vector<std::uint8_t> contentAt(float step) const;
        FieldParameters parameters(float step) const;
    };
    struct Normals
    {
        std::uint32_t grid;
        std::vector<float> samples;
        Image image;
    };
    struct Attribute
    {
        AttributeSource source; ///< its span is `samples`
        std::vector<float> samples;
        Image image;
    };
    struct Part;

    std::vector<std::uint8_t> exactContentOf(const Attribute& attribute) const;

    Outcome<std::vector<Chunk>> encodeParts(std::size_t room, double total, gim_coding coding,
                                            bool redistributes) const;

    Seam seam_;
    std::optional<Normals> normals_;
    std::vector<Attribute> attributes_;
};

/// A file with other normals and attributes, its geometry left as it is.
/// @param target  size of the whole file that they are to fill; none: by `settings`
/// Errors: as Encoder::encode; BadSource for bytes that are no file; TooSmall.
Outcome<EncodedFile> withFields(std::span<const std::uint8_t> file, const FieldSet& fields,
                                const Settings& settings, std::optional<std::size_t> target);

} // namespace gimg::codec

#pragma once

#include "forward.h"
#include "seam.h"
#include "surface_encoder.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>

namespace gimg::codec {

/// An image of what is spread over the surface.
struct AttributeSource
{
    std::string name; ///< 1 to 63 bytes of UTF-8 without control characters
    std::uint32_t grid = 0;
    unsigned channels = 0; ///< 1 to 16
    gim_sample_type type = GIM_F32;
    bool glued = true;       ///< whether glued samples agree; lossy coding averages them
    bool normalized = false; ///< integers stand for fractions of the largest
    bool lossless = false;
    std::span<const float>
        samples; ///< `channels` numbers for each sample; of integer types, integers in range
};

/// What is to be written. The spans must stay valid while an Encoder prepares them, no longer.
struct Source
{
    std::uint32_t grid = 0; ///< samples a side, 2^j + 1, 3 to 4097, at least seam.lowest
    Seam seam;
    std::span<const float> xyz;              ///< 3 grid^2 numbers
    std::uint32_t normalGrid = 0;            ///< 0: no normals; otherwise as grid
    std::span<const float> normals;          ///< 3 normalGrid^2 numbers, vectors of unit length
    std::vector<AttributeSource> attributes; ///< at most 16, no two of one name
    /// Of the geometry's levels so many of the finest hold no details: samples lie smoothly between the
    /// coarser ones. Of surface coding alone.
    unsigned smoothLevels = 0;
};

struct Settings
{
    gim_coding coding =
        GIM_CODING_SURFACE;          ///< of the geometry; normals that go with a surface are coded as a field
    float step = 0;                  ///< surface, wavelet: quantisation step, in the surface's units
    float normalStep = 0;            ///< the same for the normals, if there are any
    float attributeStep = 1.0f / 64; ///< of lossy attributes, as a fraction of the span of their values; with
                                     ///< raw geometry all attributes are lossless
};

/// Moves samples along the surface: it is given what a decoder will make of them, and changes the targets
/// that it was to come near, 3 grid^2 numbers each. Glued targets must stay equal.
using Retarget = std::function<void(std::span<const float> decoded, std::span<float> targets)>;

/// How samples are to slide.
struct Slides
{
    std::vector<int> octaves; ///< one a round: how much coarser than the file's its step is; for prefixes
    /// From then on details along the surface are chosen so that little is missing of them in prefixes
    /// either: what their lowest one, two and three bits are, in units of those bits squared, counts as much
    /// as the error of the whole file, times this. Samples slide to where both are small.
    double prefixCare = 0;
};

struct EncodedFile
{
    std::vector<std::uint8_t> bytes;
    float step = 0;       ///< as written
    float normalStep = 0; ///< as written; 0 without normals
};

struct EncodeError
{
    enum class Kind
    {
        BadSource,   ///< the samples or the seam cannot be written
        BadSettings, ///< a step is out of range
        TooSmall,    ///< no file is as small as the target
        TooLarge,    ///< no sensible step makes a file as large as the target
    };
    Kind kind = Kind::BadSource;
    std::string message;
    std::size_t reachable = 0; ///< TooSmall, TooLarge: the size in bytes that can be had
};

template <class T> using Outcome = std::variant<T, EncodeError>;

class FieldSet;

/// Holds a source after its forward transform, so that encoding at another step is quick.
class Encoder
{
public:
    /// BadSource: sizes that do not fit, numbers that are not finite, a faulty seam.
    static Outcome<Encoder> prepare(const Source& source);

    /// BadSettings: a step that is not positive, or too small for the coefficients' range.
    Outcome<EncodedFile> encode(const Settings& settings) const;

    /// The encoder of samples that have slid: once a round the surface is coded at a step and its targets
    /// are moved. What slides along the surface need not be coded, so that a file of the same size comes
    /// nearer.
    Outcome<Encoder> slid(float step, const Slides& slides, const Retarget& retarget) const;

    /// The best file of at most `target` bytes; at most max(1 %, 24 bytes) smaller.
    /// @param coding  of the geometry, surface or wavelet
    /// Normals and attributes get the shares that FieldSet tells.
    /// TooSmall, TooLarge: see EncodeError.
    Outcome<EncodedFile> encodeToBytes(std::size_t target, gim_coding coding = GIM_CODING_SURFACE) const;

    /// The same geometry with the normals and attributes of another encoder.
    Encoder withFieldsOf(const Encoder& other) const;

    /// The geometry's samples, as given or slid.
    std::span<const float> samples() const { return xyz_; }

    /// Diagonal of the geometry's bounding box; steps are best thought of as fractions of it.
    double diagonal() const { return surface_.diagonal; }

private:
    Encoder(const Source& source, std::shared_ptr<const FieldSet> fields);

    Seam seam_;
    std::vector<std::uint8_t> word_;
    std::vector<float> xyz_;
    std::shared_ptr<const SurfaceEncoder> surfaceEncoder_;
    TransformedSurface surface_;
    std::shared_ptr<const FieldSet> fields_;
};

} // namespace gimg::codec

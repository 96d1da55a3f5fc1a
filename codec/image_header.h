#pragma once

#include "field_frame.h"
#include "format/bytes.h"
#include "gim.h"
#include "quantizer.h"
#include "surface_frame.h"

namespace gimg::codec {

using format::ReadStatus;

enum class ImageKind
{
    Geometry,
    Normals,
    Attribute,
};

constexpr unsigned kLargestExponent = 12; ///< 4097 samples a side

/// The fixed fields at the beginning of an image's chunk, and what follows them.
struct ImageHeader
{
    std::uint32_t grid = 0;
    gim_coding coding = GIM_CODING_WAVELET;
    float step = 0;                ///< wavelet: quantisation step; 12-bit: distance of neighbouring integers
    std::uint8_t shifts = 0;       ///< wavelet: see Dequantizer
    std::uint8_t ratios = 0;       ///< surface: see surfaceParameters()
    std::uint8_t limits = 0;       ///< surface: likewise
    std::uint8_t axes = 0;         ///< field: see fieldParameters()
    float least[kComponents] = {}; ///< 12-bit: what integer 0 stands for
    format::ByteSpan samples;      ///< the coded samples
    std::size_t fixedBytes = 0;
    bool isPrefix = false; ///< `samples` are cut short
};

/// Reads and checks the fixed fields of a geometry or normal chunk, or those of an attribute's from the kind
/// byte on.
ReadStatus readImageHeader(format::ByteSpan content, ImageKind kind, ImageHeader* header);

constexpr unsigned kCubeBits = 12; ///< of the integers of 12-bit coding

/// What the fixed fields of a surface's chunk mean. The low nibble of `ratios` is SurfaceParameters::rise,
/// the high one half of SurfaceParameters::most; the low nibble of `limits` is the area limit in quarters
/// above 1, the high one the flatness in half octaves, 0 for 1.
SurfaceParameters surfaceParameters(const ImageHeader& header);

/// What the fixed fields of a field's chunk mean. The low nibble of `axes` is a FieldAxes, the high one the
/// ratio of steps in half octaves.
FieldParameters fieldParameters(const ImageHeader& header);

/// Bytes that decodeImage() takes from its arena.
std::uint64_t imageWorkspace(const ImageHeader& header);

class Arena;

/// The first half of decoding a wavelet image: its quantised coefficients, from what encodeCoefficients()
/// made. The planes lie in the arena.
ReadStatus decodeCoefficients(const ImageHeader& header, Arena& arena, QuantizedImage* image);

/// Decodes an image of three components into 3 grid^2 floats.
/// @param classes  borderClasses() of the grid
/// @param flags    GIM_NO_FUSE, GIM_NO_DIFFUSE: of wavelet coding alone
ReadStatus decodeImage(const ImageHeader& header, const SeamView& seam, const std::uint32_t* classes,
                       std::uint32_t flags, Arena& arena, float* out);

/// Makes vectors as long as 1; a zero vector becomes (0, 0, 1).
void normalize(float* vectors, std::size_t count);

} // namespace gimg::codec

#pragma once

#include "forward.h"
#include "seam.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>

namespace gimg::codec {

/// What is to be written. The spans must stay valid while an Encoder prepares them, no longer.
struct Source
{
    std::uint32_t grid = 0; ///< samples a side, 2^j + 1, 3 to 4097, at least seam.lowest
    Seam seam;
    std::span<const float> xyz;     ///< 3 grid^2 numbers
    std::uint32_t normalGrid = 0;   ///< 0: no normals; otherwise as grid
    std::span<const float> normals; ///< 3 normalGrid^2 numbers, vectors of unit length
};

struct Settings
{
    gim_coding coding = GIM_CODING_WAVELET;
    float step = 0;       ///< wavelet only: quantisation step, in the surface's units
    float normalStep = 0; ///< wavelet only, with normals: the same for them
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

/// Holds a source after its forward transform, so that encoding at another step is quick.
class Encoder
{
public:
    /// BadSource: sizes that do not fit, numbers that are not finite, a faulty seam.
    static Outcome<Encoder> prepare(const Source& source);

    /// BadSettings: a step that is not positive, or too small for the coefficients' range.
    Outcome<EncodedFile> encode(const Settings& settings) const;

    /// The best wavelet file of at most `target` bytes; at most max(1 %, 24 bytes) smaller.
    /// Normals get a quarter of the bytes that are neither container nor seam.
    /// TooSmall, TooLarge: see EncodeError.
    Outcome<EncodedFile> encodeToBytes(std::size_t target) const;

    /// Diagonal of the geometry's bounding box; steps are best thought of as fractions of it.
    double diagonal() const { return geometry_.diagonal; }

private:
    Seam seam_;
    std::vector<std::uint8_t> word_;
    std::vector<float> xyz_, normals_;
    TransformedImage geometry_;
    std::optional<TransformedImage> normalImage_;
};

} // namespace gimg::codec

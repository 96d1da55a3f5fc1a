#pragma once

#include "attribute_sampler.h"
#include "codec/encode.h"
#include "gimg/distance.h"
#include "gimg/fit.h"
#include "gimg/image_io.h"
#include "gimg/result.h"

#include <array>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

namespace gimg {

/// A file and what it is worth.
struct CodedFile
{
    std::vector<std::uint8_t> bytes;
    float step = 0;      ///< of the geometry
    double psnr = 0;     ///< of the decoded finest level; 0 where hardly any surface is left
    double maxError = 1; ///< SurfaceDistance::hausdorff() of it, as a fraction of the diagonal; then 1
};

/// PSNR of a file, of half of its bytes and of a quarter.
using PrefixPsnr = std::array<double, 3>;

Error fromCodec(const codec::EncodeError& error);

template <class T> Result<T> resultOf(codec::Outcome<T> outcome)
{
    if (auto* error = std::get_if<codec::EncodeError>(&outcome)) return fromCodec(*error);
    return std::move(std::get<T>(outcome));
}

/// Decodes a file and measures its finest level.
Result<CodedFile> judged(Result<codec::EncodedFile> encoded, const SurfaceMeasure& measure);

/// Measures what a decoder makes of the parts of a file.
Result<PrefixPsnr> prefixPsnrOf(const CodedFile& file, const SurfaceMeasure& measure);

/// The parts of a source, which must live as long as it is used.
/// @param normals  empty for none
codec::Source sourceOf(const GridSeam& seam, const FloatImage& geometry, const FloatImage& normals,
                       std::span<const SampledAttribute> attributes = {});

/// @param smoothLevels  see codec::Source
Result<codec::Encoder> encoderOf(const GridSeam& seam, const FloatImage& geometry, const FloatImage& normals,
                                 std::span<const SampledAttribute> attributes = {}, int smoothLevels = 0);

} // namespace gimg

#include "coded_file.h"

#include "gimg/decode.h"

#include <optional>
#include <span>

namespace gimg {

Error fromCodec(const codec::EncodeError& error)
{
    using Kind = codec::EncodeError::Kind;
    const bool target = error.kind == Kind::TooSmall || error.kind == Kind::TooLarge;
    return {target ? ErrorKind::TargetUnreachable : ErrorKind::BadArgument, error.message};
}

namespace {

// None if so few bytes leave hardly any surface.
Result<std::optional<SurfaceDistance>> distanceOf(std::span<const std::uint8_t> bytes, unsigned flags,
                                                  const SurfaceMeasure& measure)
{
    const Result<DecodedImages> images = decodeImages(bytes, flags);
    if (!images) return images.error();
    const Result<Mesh> mesh = levelMesh(bytes, *images, 0, flags);
    if (!mesh) return mesh.error();
    if (!(surfaceArea(*mesh) > 0)) return std::optional<SurfaceDistance>();
    const Result<SurfaceDistance> distance = measure.against(*mesh);
    if (!distance && distance.error().kind == ErrorKind::EmptyMesh) return std::optional<SurfaceDistance>();
    if (!distance) return distance.error();
    return std::optional(*distance);
}

} // namespace

Result<CodedFile> judged(Result<codec::EncodedFile> encoded, const SurfaceMeasure& measure)
{
    if (!encoded) return encoded.error();
    CodedFile coded;
    coded.bytes = std::move(encoded->bytes);
    coded.step = encoded->step;
    const Result<std::optional<SurfaceDistance>> distance = distanceOf(coded.bytes, 0, measure);
    if (!distance) return distance.error();
    if (!*distance) return coded;
    coded.psnr = (*distance)->psnr();
    coded.maxError = (*distance)->hausdorff() / (*distance)->diagonal;
    return coded;
}

Result<PrefixPsnr> prefixPsnrOf(const CodedFile& file, const SurfaceMeasure& measure)
{
    PrefixPsnr psnr = {file.psnr};
    for (const std::size_t k : {1, 2}) {
        const std::span<const std::uint8_t> prefix(file.bytes.data(), file.bytes.size() >> k);
        const Result<std::optional<SurfaceDistance>> distance = distanceOf(prefix, GIM_PREFIX, measure);
        if (!distance && distance.error().kind != ErrorKind::FileTruncated) return distance.error();
        psnr[k] = distance && *distance ? (*distance)->psnr() : 0;
    }
    return psnr;
}

codec::Source sourceOf(const GridSeam& seam, const FloatImage& geometry, const FloatImage& normals,
                       std::span<const SampledAttribute> attributes)
{
    codec::Source source;
    source.grid = static_cast<uint32_t>(geometry.width);
    source.seam = {static_cast<uint32_t>(seam.lowest), static_cast<uint32_t>(seam.start), seam.sides};
    source.xyz = geometry.samples;
    source.normalGrid = static_cast<uint32_t>(normals.width);
    source.normals = normals.samples;
    for (const SampledAttribute& attribute : attributes) {
        source.attributes.push_back(attribute.source);
        source.attributes.back().samples = attribute.samples;
    }
    return source;
}

Result<codec::Encoder> encoderOf(const GridSeam& seam, const FloatImage& geometry, const FloatImage& normals,
                                 std::span<const SampledAttribute> attributes, int smoothLevels)
{
    codec::Source source = sourceOf(seam, geometry, normals, attributes);
    source.smoothLevels = static_cast<unsigned>(smoothLevels);
    return resultOf(codec::Encoder::prepare(source));
}

} // namespace gimg

#include "coded_file.h"

#include "gimg/decode.h"

namespace gimg {

Error fromCodec(const codec::EncodeError& error)
{
    using Kind = codec::EncodeError::Kind;
    const bool target = error.kind == Kind::TooSmall || error.kind == Kind::TooLarge;
    return {target ? ErrorKind::TargetUnreachable : ErrorKind::BadArgument, error.message};
}

Result<CodedFile> judged(Result<codec::EncodedFile> encoded, const SurfaceMeasure& measure)
{
    if (!encoded) return encoded.error();
    CodedFile coded{std::move(encoded->bytes), encoded->step};
    const Result<DecodedImages> images = decodeImages(coded.bytes);
    if (!images) return images.error();
    const Result<Mesh> mesh = levelMesh(coded.bytes, *images, 0);
    if (!mesh) return mesh.error();
    if (!(surfaceArea(*mesh) > 0)) return coded; // so few bytes that nothing is left
    const Result<SurfaceDistance> distance = measure.against(*mesh);
    if (!distance && distance.error().kind == ErrorKind::EmptyMesh) return coded; // or next to nothing
    if (!distance) return distance.error();
    coded.psnr = distance->psnr();
    coded.maxError = distance->hausdorff() / distance->diagonal;
    return coded;
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
                                 std::span<const SampledAttribute> attributes)
{
    return resultOf(codec::Encoder::prepare(sourceOf(seam, geometry, normals, attributes)));
}

} // namespace gimg

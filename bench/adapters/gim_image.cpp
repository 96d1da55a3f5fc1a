// gimg's own wavelet coder on the geometry image that other image coders get: without its seam, so that the
// border is open, and without the search for samples that code well.
#include "adapter.h"

#include "codec/encode.h"
#include "gim.h"

namespace gimg::adapter {
namespace {

using Bytes = std::vector<uint8_t>;

constexpr uint32_t kLowest = 3; ///< samples a side of the lowest level of detail; costs no bytes

bool isGrid(int side) { return side >= 3 && side <= 4097 && ((side - 1) & (side - 2)) == 0; }

Result<codec::Encoder> prepared(const FloatImage& image)
{
    if (!isGrid(image.width))
        return Error{ErrorKind::BadArgument, "an image of " + std::to_string(image.width) +
                                                 " samples a side; gimg needs 2^j + 1, 3 to 4097"};
    codec::Source source;
    source.grid = static_cast<uint32_t>(image.width);
    source.seam = {kLowest, 0, {{0, 4 * (kLowest - 1), GIM_SIDE_BOUNDARY}}};
    source.xyz = image.samples;
    codec::Outcome<codec::Encoder> encoder = codec::Encoder::prepare(source);
    if (const auto* error = std::get_if<codec::EncodeError>(&encoder))
        return Error{ErrorKind::CodecFailure, error->message};
    return std::get<codec::Encoder>(std::move(encoder));
}

Result<Bytes> encoded(const codec::Encoder& encoder, size_t size)
{
    codec::Outcome<codec::EncodedFile> file = encoder.encodeToBytes(size);
    if (const auto* error = std::get_if<codec::EncodeError>(&file))
        return Error{ErrorKind::TargetUnreachable, error->message};
    return std::get<codec::EncodedFile>(std::move(file)).bytes;
}

Result<FloatImage> decoded(const Bytes& file)
{
    gim_info info{};
    info.size = sizeof info;
    gim_status status = gim_probe(file.data(), file.size(), nullptr, &info);
    const int side = static_cast<int>(info.grid);
    FloatImage image{side, side, std::vector<float>(size_t{3} * info.grid * info.grid)};
    Bytes work(gim_workspace_size(&info));
    if (status == GIM_OK)
        status = gim_decode_geometry(file.data(), file.size(), nullptr, 0, work.data(), work.size(),
                                     image.samples.data());
    if (status != GIM_OK) return Error{ErrorKind::CodecFailure, gim_status_text(status)};
    return image;
}

class GimImage : public Adapter
{
public:
    Description describe() const override
    {
        return {"gim-image", "gimg, image alone", Input::Image, Side::Ours, "gim", {}, {}, false};
    }

    Status encode(const Subject& subject, const std::vector<size_t>& sizes,
                  const std::function<void(size_t, Result<Coded>)>& done) override
    {
        const Result<codec::Encoder> encoder = prepared(subject.image);
        if (!encoder) return encoder.error();
        for (const size_t size : sizes) {
            Result<Bytes> file = encoded(*encoder, size);
            if (!file) {
                done(size, file.error());
                continue;
            }
            Result<FloatImage> image = decoded(*file);
            if (!image) return image.error();
            Coded coded;
            coded.extension = "gim";
            coded.file = std::move(*file);
            coded.image = std::move(*image);
            done(size, std::move(coded));
        }
        return Done{};
    }

    Result<Times> time(const Subject&, size_t, int) override
    {
        return Error{ErrorKind::BadArgument, "gimrd bench times gimg itself"};
    }
};

} // namespace

std::unique_ptr<Adapter> makeAdapter() { return std::make_unique<GimImage>(); }

} // namespace gimg::adapter

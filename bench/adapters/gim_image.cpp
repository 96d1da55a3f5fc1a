// gimg's own coder on the geometry image that other image coders get, as `gimenc --from-image` runs it: its
// seam is found by the border samples that coincide, and its samples slide along its own triangles.
#include "adapter.h"

#include "gimg/decode.h"
#include "gimg/encode.h"

namespace gimg::adapter {
namespace {

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
        EncodeOptions options;
        options.threads = subject.threads;
        const Result<MeshEncoder> encoder = MeshEncoder::prepareImage(subject.image, options);
        if (!encoder) return encoder.error();
        for (const size_t size : sizes) {
            Result<EncodedMesh> file = encoder->encode({EncodeTarget::Bytes, size});
            if (!file) {
                done(size, file.error());
                continue;
            }
            Result<DecodedImages> images = decodeImages(file->file);
            if (!images) return images.error();
            Coded coded;
            coded.extension = "gim";
            coded.file = std::move(file->file);
            coded.image = std::move(images->geometry);
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

// gimg's own wavelet coder, the whole road from the mesh.
#include "adapter.h"

#include "gimg/decode.h"
#include "gimg/encode.h"

#include <chrono>

namespace gimg::adapter {
namespace {

class GimWavelet : public Adapter
{
public:
    Description describe() const override
    {
        return {"gim", "gimg", Input::Mesh, Side::Ours, "gim", {}, {}, true};
    }

    Status encode(const Subject& subject, const std::vector<size_t>& sizes,
                  const std::function<void(size_t, Result<Coded>)>& done) override
    {
        EncodeOptions options;
        options.grid = subject.grid;
        options.threads = subject.threads;
        const Result<MeshEncoder> encoder = MeshEncoder::prepare(subject.mesh, options);
        if (!encoder) return encoder.error();
        for (const size_t size : sizes) {
            Result<EncodedMesh> encoded = encoder->encode({EncodeTarget::Bytes, size});
            if (!encoded && encoded.error().kind != ErrorKind::TargetUnreachable) return encoded.error();
            done(size, encoded ? decoded(std::move(*encoded)) : Result<Coded>(encoded.error()));
        }
        return Done{};
    }

    Result<Times> time(const Subject&, size_t, int) override
    {
        return Error{ErrorKind::BadArgument, "gimrd bench times gimg itself"};
    }

private:
    static Result<Coded> decoded(EncodedMesh encoded)
    {
        const Result<DecodedImages> images = decodeImages(encoded.file);
        if (!images) return images.error();
        Result<Mesh> mesh = levelMesh(encoded.file, *images, 0);
        if (!mesh) return mesh.error();
        Coded coded;
        coded.file = std::move(encoded.file);
        coded.extension = "gim";
        coded.mesh = std::move(*mesh);
        coded.settings = {{"grid", encoded.grid}, {"lowest", encoded.lowest}};
        return coded;
    }
};

} // namespace

std::unique_ptr<Adapter> makeAdapter() { return std::make_unique<GimWavelet>(); }

} // namespace gimg::adapter

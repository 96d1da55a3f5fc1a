// OpenJPEG's programs on the image's three planes: 9/7 wavelets, no transform over the planes.
#include "image_peer.h"

#include <cstring>

namespace gimg::adapter {
namespace {

using Bytes = std::vector<uint8_t>;

class OpenJpeg
{
public:
    /// @param ratio  of the samples' size to the file's
    Result<Bytes> encode(const ScaledImage& image, double ratio)
    {
        const Status written =
            writeScratch(path("in.rawl"), image.planes.data(), image.planes.size() * sizeof(uint16_t));
        if (!written) return written.error();
        const std::string side = std::to_string(image.side);
        const Result<std::string> printed =
            runTool({"opj_compress", "-i", path("in.rawl"), "-o", path("out.j2k"), "-F",
                     side + ',' + side + ",3," + std::to_string(image.bits) + ",u", "-I", "-mct", "0", "-r",
                     std::to_string(ratio)});
        if (!printed) return printed.error();
        printed_ = *printed;
        return readScratch(path("out.j2k"));
    }

    Result<ScaledImage> decode(const Bytes& file, const ScaledImage& like)
    {
        const Status written = writeScratch(path("in.j2k"), file.data(), file.size());
        if (!written) return written.error();
        const Result<std::string> printed =
            runTool({"opj_decompress", "-i", path("in.j2k"), "-o", path("out.rawl")});
        if (!printed) return printed.error();
        printed_ = *printed;
        const Result<Bytes> raw = readScratch(path("out.rawl"));
        if (!raw) return raw.error();
        ScaledImage image = like;
        if (raw->size() != image.planes.size() * sizeof(uint16_t))
            return Error{ErrorKind::CodecFailure,
                         "opj_decompress wrote " + std::to_string(raw->size()) + " bytes"};
        std::memcpy(image.planes.data(), raw->data(), raw->size());
        return image;
    }

    Result<Times> time(const ScaledImage& image, double ratio, int runs)
    {
        Times times;
        times.note = "as the programs print them, in whole milliseconds";
        for (int run = 0; run < runs; ++run) {
            const Result<Bytes> file = encode(image, ratio);
            if (!file) return file.error();
            const Result<double> encoding = numberAfter(printed_, "encode time:");
            if (!encoding) return encoding.error();
            const Result<ScaledImage> decoded = decode(*file, image);
            if (!decoded) return decoded.error();
            const Result<double> decoding = numberAfter(printed_, "decode time:");
            if (!decoding) return decoding.error();
            times.encode.push_back(*encoding);
            times.decode.push_back(*decoding);
        }
        return times;
    }

private:
    std::string path(const std::string& name) const { return scratch_.path(name); }

    Scratch scratch_;
    std::string printed_; ///< by the program that ran last
};

} // namespace

std::unique_ptr<Adapter> makeAdapter()
{
    const std::string package = "libopenjp2-tools";
    const auto coder = std::make_shared<OpenJpeg>();
    ImagePeer peer;
    peer.description = {"openjpeg",
                        "OpenJPEG 9/7",
                        Input::Image,
                        Side::Peer,
                        "openjpeg",
                        {package},
                        missingPrograms({"opj_compress", "opj_decompress"}, package),
                        false};
    peer.extension = "j2k";
    for (const int bits : {16, 12}) {
        const auto encode = [coder](const ScaledImage& image, double ratio) {
            return coder->encode(image, ratio);
        };
        peer.variants.push_back({{{"bits", bits}}, bits, 1, 10000, 100, -1, encode});
    }
    peer.decode = [coder](const Bytes& file, const ScaledImage& like) { return coder->decode(file, like); };
    peer.time = [coder](const ScaledImage& image, double ratio, int runs) {
        return coder->time(image, ratio, runs);
    };
    return makeImagePeer(std::move(peer));
}

} // namespace gimg::adapter

// libjxl's programs on one grey image, the three planes one below the other: as colours libjxl would weigh
// them by what eyes see, which costs 4 dB.
#include "image_peer.h"

#include <algorithm>

namespace gimg::adapter {
namespace {

using Bytes = std::vector<uint8_t>;

constexpr int kTimedRepeats = 5; ///< within one start of a program

// Three planes as a PGM file: big-endian.
Bytes toPgm(const ScaledImage& image)
{
    const std::string header =
        "P5\n" + std::to_string(image.side) + ' ' + std::to_string(3 * image.side) + "\n65535\n";
    Bytes file(header.begin(), header.end());
    for (const uint16_t sample : image.planes) {
        file.push_back(static_cast<uint8_t>(sample >> 8));
        file.push_back(static_cast<uint8_t>(sample & 0xff));
    }
    return file;
}

Result<ScaledImage> fromPgm(const Bytes& file, const ScaledImage& like)
{
    ScaledImage image = like;
    const size_t bytes = 2 * image.planes.size();
    // The header is what toPgm() wrote, or the same with other white space.
    if (file.size() < bytes || file.size() > bytes + 40 || file[0] != 'P' || file[1] != '5')
        return Error{ErrorKind::CodecFailure, "djxl wrote no grey image of 16 bits"};
    const uint8_t* samples = file.data() + (file.size() - bytes);
    for (size_t i = 0; i < image.planes.size(); ++i)
        image.planes[i] = static_cast<uint16_t>(samples[2 * i] << 8 | samples[2 * i + 1]);
    return image;
}

struct Mode
{
    bool modular;
    int effort;
};

class Jxl
{
public:
    Result<Bytes> encode(const ScaledImage& image, double distance, Mode mode, int repeats = 1)
    {
        const Bytes pgm = toPgm(image);
        const Status written = writeScratch(path("in.pgm"), pgm.data(), pgm.size());
        if (!written) return written.error();
        const Result<std::string> printed =
            runTool({"cjxl", path("in.pgm"), path("out.jxl"), "-d", std::to_string(distance), "-m",
                     mode.modular ? "1" : "0", "-e", std::to_string(mode.effort), "--num_threads=0",
                     "--num_reps=" + std::to_string(repeats)});
        if (!printed) return printed.error();
        printed_ = *printed;
        return readScratch(path("out.jxl"));
    }

    Result<ScaledImage> decode(const Bytes& file, const ScaledImage& like, int repeats = 1)
    {
        const Status written = writeScratch(path("in.jxl"), file.data(), file.size());
        if (!written) return written.error();
        const Result<std::string> printed =
            runTool({"djxl", path("in.jxl"), path("out.pgm"), "--num_threads=1",
                     "--num_reps=" + std::to_string(repeats)});
        if (!printed) return printed.error();
        printed_ = *printed;
        const Result<Bytes> pgm = readScratch(path("out.pgm"));
        if (!pgm) return pgm.error();
        return fromPgm(*pgm, like);
    }

    Result<Times> time(const ScaledImage& image, double distance, Mode mode, int runs)
    {
        Times times;
        times.note = "as the programs print them, means of " + std::to_string(kTimedRepeats) + " repeats";
        for (int run = 0; run < runs; ++run) {
            const Result<Bytes> file = encode(image, distance, mode, kTimedRepeats);
            if (!file) return file.error();
            const Result<double> encoding = milliseconds(image);
            if (!encoding) return encoding.error();
            const Result<ScaledImage> decoded = decode(*file, image, kTimedRepeats);
            if (!decoded) return decoded.error();
            const Result<double> decoding = milliseconds(image);
            if (!decoding) return decoding.error();
            times.encode.push_back(*encoding);
            times.decode.push_back(*decoding);
        }
        return times;
    }

private:
    std::string path(const std::string& name) const { return scratch_.path(name); }

    // The programs print megapixels a second.
    Result<double> milliseconds(const ScaledImage& image) const
    {
        const Result<double> speed = numberAfter(printed_, "geomean:");
        if (!speed) return speed.error();
        return static_cast<double>(image.planes.size()) / (*speed * 1000);
    }

    Scratch scratch_;
    std::string printed_; ///< by the program that ran last
};

} // namespace

std::unique_ptr<Adapter> makeAdapter()
{
    const std::string package = "libjxl-tools";
    const auto coder = std::make_shared<Jxl>();
    ImagePeer peer;
    peer.description = {"jxl",
                        "libjxl",
                        Input::Image,
                        Side::Peer,
                        "jxl",
                        {package},
                        missingPrograms({"cjxl", "djxl"}, package),
                        false};
    peer.extension = "jxl";
    constexpr Mode kModes[] = {{false, 7}, {false, 8}, {true, 7}};
    for (const Mode mode : kModes) {
        const auto encode = [coder, mode](const ScaledImage& image, double distance) {
            return coder->encode(image, distance, mode);
        };
        peer.variants.push_back(
            {{{"modular", mode.modular}, {"effort", mode.effort}}, 16, 0.01, 25, 0.5, -0.6, encode});
    }
    peer.decode = [coder](const Bytes& file, const ScaledImage& like) { return coder->decode(file, like); };
    peer.time = [coder, kModes](const ScaledImage& image, double distance, int runs) {
        return coder->time(image, distance, kModes[0], runs);
    };
    return makeImagePeer(std::move(peer));
}

} // namespace gimg::adapter

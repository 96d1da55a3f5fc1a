// libjxl's programs on grey images: the three planes one below the other, or each by itself. As the colours
// of one image libjxl would weigh them by what eyes see, which costs 4 dB.
#include "image_peer.h"

#include <algorithm>
#include <span>

namespace gimg::adapter {
namespace {

using Bytes = std::vector<uint8_t>;
using Samples = std::vector<uint16_t>;

constexpr int kTimedRepeats = 5;   ///< within one start of a program
constexpr size_t kLengthBytes = 3; ///< of the length before the file of a plane

/// VarDCT; lossy modular coding was behind at every size when it was tried.
struct Mode
{
    int effort;
    int images; ///< 1 or 3
};

// A PGM file of 16 bits, big-endian.
Bytes toPgm(std::span<const uint16_t> samples, int width)
{
    const size_t height = samples.size() / static_cast<size_t>(width);
    const std::string header = "P5\n" + std::to_string(width) + ' ' + std::to_string(height) + "\n65535\n";
    Bytes file(header.begin(), header.end());
    for (const uint16_t sample : samples) {
        file.push_back(static_cast<uint8_t>(sample >> 8));
        file.push_back(static_cast<uint8_t>(sample & 0xff));
    }
    return file;
}

Result<Samples> fromPgm(const Bytes& file, size_t count)
{
    // The header is what toPgm() wrote, or the same with other white space.
    if (file.size() < 2 * count || file.size() > 2 * count + 40 || file[0] != 'P' || file[1] != '5')
        return Error{ErrorKind::CodecFailure, "djxl wrote no grey image of 16 bits"};
    const uint8_t* bytes = file.data() + (file.size() - 2 * count);
    Samples samples(count);
    for (size_t i = 0; i < count; ++i)
        samples[i] = static_cast<uint16_t>(bytes[2 * i] << 8 | bytes[2 * i + 1]);
    return samples;
}

class Jxl
{
public:
    Result<Bytes> encode(const ScaledImage& image, double distance, Mode mode)
    {
        const size_t count = image.planes.size() / static_cast<size_t>(mode.images);
        Bytes file;
        for (int i = 0; i < mode.images; ++i) {
            const std::span<const uint16_t> samples(image.planes.data() + i * count, count);
            const Result<Bytes> coded = encodeGrey(toPgm(samples, image.side), distance, mode, 1);
            if (!coded) return coded.error();
            if (mode.images > 1)
                for (size_t k = 0; k < kLengthBytes; ++k)
                    file.push_back(static_cast<uint8_t>(coded->size() >> 8 * (kLengthBytes - 1 - k)));
            file.insert(file.end(), coded->begin(), coded->end());
        }
        return file;
    }

    // A file of libjxl begins with the byte ff, a length, highest byte first, never does.
    Result<ScaledImage> decode(const Bytes& file, const ScaledImage& like)
    {
        const bool single = !file.empty() && file[0] == 0xff;
        ScaledImage image = like;
        image.planes.clear();
        for (size_t at = 0; at < file.size();) {
            size_t length = file.size();
            if (!single) {
                if (file.size() - at < kLengthBytes) break;
                length = size_t{file[at]} << 16 | size_t{file[at + 1]} << 8 | file[at + 2];
                at += kLengthBytes;
            }
            if (length > file.size() - at) break;
            const Bytes part(file.begin() + static_cast<std::ptrdiff_t>(at),
                             file.begin() + static_cast<std::ptrdiff_t>(at + length));
            const Result<Samples> samples = decodeGrey(part, like.planes.size() / (single ? 1 : 3), 1);
            if (!samples) return samples.error();
            image.planes.insert(image.planes.end(), samples->begin(), samples->end());
            at += length;
        }
        if (image.planes.size() != like.planes.size())
            return Error{ErrorKind::CodecFailure, "a plane is missing"};
        return image;
    }

    Result<Times> time(const ScaledImage& image, double distance, Mode mode, int runs)
    {
        Times times;
        times.note = "as the programs print them, means of " + std::to_string(kTimedRepeats) + " repeats";
        for (int run = 0; run < runs; ++run) {
            const Result<Bytes> file =
                encodeGrey(toPgm(image.planes, image.side), distance, mode, kTimedRepeats);
            if (!file) return file.error();
            const Result<double> encoding = milliseconds(image);
            if (!encoding) return encoding.error();
            const Result<Samples> decoded = decodeGrey(*file, image.planes.size(), kTimedRepeats);
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

    Result<Bytes> encodeGrey(const Bytes& pgm, double distance, Mode mode, int repeats)
    {
        const Status written = writeScratch(path("in.pgm"), pgm.data(), pgm.size());
        if (!written) return written.error();
        const Result<std::string> printed = runTool(
            {"cjxl", path("in.pgm"), path("out.jxl"), "-d", std::to_string(distance), "-m", "0", "-e",
             std::to_string(mode.effort), "--num_threads=0", "--num_reps=" + std::to_string(repeats)});
        if (!printed) return printed.error();
        printed_ = *printed;
        return readScratch(path("out.jxl"));
    }

    Result<Samples> decodeGrey(const Bytes& file, size_t count, int repeats)
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
        return fromPgm(*pgm, count);
    }

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
    constexpr Mode kModes[] = {{7, 1}, {8, 1}, {7, 3}};
    for (const Mode mode : kModes) {
        const auto encode = [coder, mode](const ScaledImage& image, double distance) {
            return coder->encode(image, distance, mode);
        };
        peer.variants.push_back(
            {{{"effort", mode.effort}, {"images", mode.images}}, 16, 0.01, 25, 0.5, -0.6, encode});
    }
    peer.decode = [coder](const Bytes& file, const ScaledImage& like) { return coder->decode(file, like); };
    peer.time = [coder, kModes](const ScaledImage& image, double distance, int runs) {
        return coder->time(image, distance, kModes[0], runs);
    };
    return makeImagePeer(std::move(peer));
}

} // namespace gimg::adapter

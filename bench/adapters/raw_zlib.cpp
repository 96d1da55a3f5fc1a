// The geometry image as it is: as many bits a sample as fit, packed by zlib.
#include "adapter.h"
#include "best_for_size.h"

#include "gimg/decode.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

namespace gimg::adapter {
namespace {

using Bytes = std::vector<uint8_t>;

constexpr int kFewestBits = 1, kMostBits = 16, kTimedBits = 12;
constexpr int kSamples = 50000; ///< for the choice between resolutions

/// What a file begins with; the rest is one zlib stream of the samples: planar, each as the difference from
/// the one before, the low bytes of all, then, above 8 bits, the high bytes.
struct Header
{
    uint8_t bits;
    uint8_t side[2];         ///< low byte first
    float least[3], most[3]; ///< each axis has its own range
};
constexpr size_t kHeaderBytes = 3 + 6 * sizeof(float);

Error failure(const std::string& what) { return {ErrorKind::CodecFailure, "zlib: " + what}; }

Bytes headerBytes(const Header& header)
{
    Bytes bytes(kHeaderBytes);
    bytes[0] = header.bits;
    std::memcpy(&bytes[1], header.side, 2);
    std::memcpy(&bytes[3], header.least, sizeof header.least);
    std::memcpy(&bytes[15], header.most, sizeof header.most);
    return bytes;
}

Header readHeader(const Bytes& file)
{
    Header header{};
    header.bits = file[0];
    std::memcpy(header.side, &file[1], 2);
    std::memcpy(header.least, &file[3], sizeof header.least);
    std::memcpy(header.most, &file[15], sizeof header.most);
    return header;
}

// The unit of an axis.
double stepOf(const Header& header, size_t axis)
{
    return (double{header.most[axis]} - header.least[axis]) / (std::ldexp(1.0, header.bits) - 1);
}

Header headerOf(const FloatImage& image, int bits)
{
    Header header{};
    header.bits = static_cast<uint8_t>(bits);
    header.side[0] = static_cast<uint8_t>(image.width & 0xff);
    header.side[1] = static_cast<uint8_t>(image.width >> 8);
    for (size_t c = 0; c < 3; ++c) {
        header.least[c] = header.most[c] = image.samples[c];
        for (size_t i = c; i < image.samples.size(); i += 3) {
            header.least[c] = std::min(header.least[c], image.samples[i]);
            header.most[c] = std::max(header.most[c], image.samples[i]);
        }
    }
    return header;
}

Bytes differences(const FloatImage& image, const Header& header)
{
    const int mask = (1 << header.bits) - 1;
    Bytes low, high;
    for (size_t c = 0; c < 3; ++c) {
        const double step = stepOf(header, c);
        int before = 0;
        for (size_t i = c; i < image.samples.size(); i += 3) {
            const double level = step > 0 ? (double{image.samples[i]} - header.least[c]) / step : 0;
            const int whole = static_cast<int>(std::lround(level));
            const int difference = (whole - before) & mask;
            before = whole;
            low.push_back(static_cast<uint8_t>(difference & 0xff));
            if (header.bits > 8) high.push_back(static_cast<uint8_t>(difference >> 8));
        }
    }
    low.insert(low.end(), high.begin(), high.end());
    return low;
}

Result<Bytes> pack(const FloatImage& image, int bits)
{
    const Header header = headerOf(image, bits);
    const Bytes plain = differences(image, header);
    Bytes file = headerBytes(header);
    uLongf size = compressBound(static_cast<uLong>(plain.size()));
    file.resize(kHeaderBytes + size);
    if (compress2(&file[kHeaderBytes], &size, plain.data(), static_cast<uLong>(plain.size()),
                  Z_BEST_COMPRESSION) != Z_OK)
        return failure("packing failed");
    file.resize(kHeaderBytes + size);
    return file;
}

Result<FloatImage> unpack(const Bytes& file)
{
    if (file.size() < kHeaderBytes) return failure("a file without header");
    const Header header = readHeader(file);
    const int side = header.side[0] | header.side[1] << 8;
    const size_t pixels = static_cast<size_t>(side) * static_cast<size_t>(side), count = 3 * pixels;
    Bytes plain(count * (header.bits > 8 ? 2 : 1));
    uLongf size = static_cast<uLongf>(plain.size());
    if (uncompress(plain.data(), &size, &file[kHeaderBytes],
                   static_cast<uLong>(file.size() - kHeaderBytes)) != Z_OK ||
        size != plain.size())
        return failure("unpacking failed");
    const int mask = (1 << header.bits) - 1;
    FloatImage image{side, side, std::vector<float>(count)};
    for (size_t c = 0; c < 3; ++c) {
        const double step = stepOf(header, c);
        int level = 0;
        for (size_t i = 0; i < pixels; ++i) {
            const size_t at = c * pixels + i;
            level = (level + plain[at] + (header.bits > 8 ? plain[count + at] << 8 : 0)) & mask;
            image.samples[3 * i + c] = static_cast<float>(header.least[c] + level * step);
        }
    }
    return image;
}

// Every second sample of every second row.
FloatImage halved(const FloatImage& image)
{
    FloatImage half{(image.width + 1) / 2, (image.height + 1) / 2, {}};
    for (int j = 0; j < half.height; ++j)
        for (int i = 0; i < half.width; ++i)
            for (int c = 0; c < 3; ++c) half.samples.push_back(image.at(2 * i, 2 * j, c));
    return half;
}

// The image at every resolution that keeps its border: while the number of cells is even.
std::vector<FloatImage> resolutions(const FloatImage& image)
{
    std::vector<FloatImage> images = {image};
    while (images.back().width > 3 && images.back().width % 2 == 1) images.push_back(halved(images.back()));
    return images;
}

class RawZlib : public Adapter
{
public:
    Description describe() const override
    {
        return {"raw-zlib", "Raw grid + zlib", Input::Image, Side::Peer, "zlib", {"zlib1g-dev"}, {}, false};
    }

    // The best of every resolution, with as many bits as fit.
    Status encode(const Subject& subject, const std::vector<size_t>& sizes,
                  const std::function<void(size_t, Result<Coded>)>& done) override
    {
        const SurfaceMeasure measure(gridMesh(subject.image), {kSamples, 1, subject.threads});
        const std::vector<FloatImage> images = resolutions(subject.image);
        files_.clear();
        for (const size_t size : sizes) {
            Result<Coded> best = Error{ErrorKind::TargetUnreachable, "no resolution is so small"};
            double bestPsnr = -1;
            for (size_t i = 0; i < images.size(); ++i) {
                const Result<int> bits = mostBitsThatFit(images[i], i, size);
                if (!bits) return bits.error();
                if (*bits < kFewestBits) continue;
                const Bytes& file = files_.at({i, *bits});
                Result<FloatImage> image = unpack(file);
                if (!image) return image.error();
                const Result<SurfaceDistance> distance = measure.against(gridMesh(*image));
                if (!distance || distance->psnr() <= bestPsnr) continue;
                bestPsnr = distance->psnr();
                best =
                    Coded{file, "zraw", {}, std::move(*image), {{"grid", images[i].width}, {"bits", *bits}}};
            }
            done(size, std::move(best));
        }
        return Done{};
    }

    Result<Times> time(const Subject& subject, size_t, int runs) override
    {
        return timeRuns(
            runs, [&] { return pack(subject.image, kTimedBits); },
            [](const Bytes& file) -> Status {
                const Result<FloatImage> image = unpack(file);
                if (!image) return image.error();
                return Done{};
            });
    }

private:
    // By bisection, since more bits make a larger file; one less than the fewest where none fits.
    Result<int> mostBitsThatFit(const FloatImage& image, size_t resolution, size_t size)
    {
        int fit = kFewestBits - 1, tooMany = kMostBits + 1;
        while (tooMany - fit > 1) {
            const int bits = (fit + tooMany) / 2;
            Bytes& file = files_[{resolution, bits}];
            if (file.empty()) {
                Result<Bytes> packed = pack(image, bits);
                if (!packed) return packed.error();
                file = std::move(*packed);
            }
            (file.size() <= size ? fit : tooMany) = bits;
        }
        return fit;
    }

    std::map<std::pair<size_t, int>, Bytes> files_; // of resolution and bits
};

} // namespace

std::unique_ptr<Adapter> makeAdapter() { return std::make_unique<RawZlib>(); }

} // namespace gimg::adapter

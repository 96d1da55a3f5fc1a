// The geometry image as it is: as many bits a sample as fit, packed by zlib.
#include "adapter.h"

#include <zlib.h>

#include <chrono>
#include <cmath>

namespace gimg::adapter {
namespace {

constexpr int kFewestBits = 1, kMostBits = 16;

struct Packed
{
    std::vector<uint8_t> file; ///< bits, side, box, then the deflated samples
    FloatImage image;          ///< as decoded
};

// Scales each axis to its own range; samples are stored planar, each as the difference from the one before,
// low bytes and high bytes apart.
Packed pack(const FloatImage& image, int bits)
{
    const auto pixels = image.samples.size() / 3;
    const double top = std::ldexp(1.0, bits) - 1;
    Packed packed;
    packed.image = image;
    std::vector<uint8_t> low, high;
    std::vector<float> box;
    for (size_t c = 0; c < 3; ++c) {
        float least = image.samples[c], most = least;
        for (size_t i = 0; i < pixels; ++i) {
            least = std::min(least, image.samples[3 * i + c]);
            most = std::max(most, image.samples[3 * i + c]);
        }
        box.insert(box.end(), {least, most});
        const double range = double{most} - least, scale = range > 0 ? top / range : 0;
        int before = 0;
        for (size_t i = 0; i < pixels; ++i) {
            const int level =
                static_cast<int>(std::lround((double{image.samples[3 * i + c]} - least) * scale));
            const int difference = (level - before) & ((1 << bits) - 1);
            before = level;
            low.push_back(static_cast<uint8_t>(difference & 0xff));
            if (bits > 8) high.push_back(static_cast<uint8_t>(difference >> 8));
            packed.image.samples[3 * i + c] = static_cast<float>(least + level * range / top);
        }
    }
    low.insert(low.end(), high.begin(), high.end());
    uLongf size = compressBound(static_cast<uLong>(low.size()));
    std::vector<uint8_t> deflated(size);
    compress2(deflated.data(), &size, low.data(), static_cast<uLong>(low.size()), Z_BEST_COMPRESSION);
    deflated.resize(size);
    packed.file = {static_cast<uint8_t>(bits), static_cast<uint8_t>(image.width & 0xff),
                   static_cast<uint8_t>(image.width >> 8)};
    const auto* boxBytes = reinterpret_cast<const uint8_t*>(box.data());
    packed.file.insert(packed.file.end(), boxBytes, boxBytes + box.size() * sizeof(float));
    packed.file.insert(packed.file.end(), deflated.begin(), deflated.end());
    return packed;
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

class RawZlib : public Adapter
{
public:
    Description describe() const override
    {
        return {"raw-zlib", "Raw grid + zlib", Input::Image, Side::Peer, "zlib", {"zlib1g"}, {}, false};
    }

    // The best of every resolution, with as many bits as fit.
    Status encode(const Subject& subject, const std::vector<size_t>& sizes,
                  const std::function<void(size_t, Result<Coded>)>& done) override
    {
        std::optional<SurfaceMeasure> measure;
        measure.emplace(gridMesh(subject.image), DistanceOptions{20000, 1, subject.threads});
        for (const size_t size : sizes) {
            Result<Coded> best = Error{ErrorKind::TargetUnreachable, "no resolution is so small"};
            double bestPsnr = -1;
            for (FloatImage image = subject.image; image.width >= 3; image = halved(image)) {
                int bits = kMostBits;
                Packed packed = pack(image, bits);
                while (packed.file.size() > size && bits > kFewestBits) packed = pack(image, --bits);
                if (packed.file.size() > size) continue;
                const Result<SurfaceDistance> distance = measure->against(gridMesh(packed.image));
                if (!distance || distance->psnr() <= bestPsnr) continue;
                bestPsnr = distance->psnr();
                Coded coded;
                coded.settings = {{"grid", image.width}, {"bits", bits}};
                coded.extension = "zraw";
                coded.file = std::move(packed.file);
                coded.image = std::move(packed.image);
                best = std::move(coded);
            }
            done(size, std::move(best));
        }
        return Done{};
    }

    Result<Times> time(const Subject&, size_t, int) override
    {
        return Error{ErrorKind::BadArgument, "raw-zlib is not timed"};
    }
};

} // namespace

std::unique_ptr<Adapter> makeAdapter() { return std::make_unique<RawZlib>(); }

} // namespace gimg::adapter

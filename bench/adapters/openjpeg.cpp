// OpenJPEG's programs on the image's three planes: 9/7 wavelets, no transform over the planes.
#include "scaled_image.h"

#include "tools/cli.h"

#include <array>
#include <cstring>

namespace gimg::adapter {
namespace {

using Bytes = std::vector<uint8_t>;

constexpr int kAttempts = 6;
constexpr double kStride = 1.04; ///< between budgets until one fits and one does not
constexpr std::array kBits = {16, 12};

class OpenJpeg : public Adapter
{
public:
    Description describe() const override
    {
        const std::string package = "libopenjp2-tools";
        return {"openjpeg",
                "OpenJPEG 9/7",
                Input::Image,
                Side::Peer,
                "openjpeg",
                {package},
                missingPrograms({"opj_compress", "opj_decompress"}, package),
                false};
    }

    Status encode(const Subject& subject, const std::vector<size_t>& sizes,
                  const std::function<void(size_t, Result<Coded>)>& done) override
    {
        const SurfaceMeasure measure(gridMesh(subject.image), {200000, 1, subject.threads});
        const Cube cube = cubeOf(subject.image);
        for (const size_t size : sizes) {
            Result<Coded> best = Error{ErrorKind::TargetUnreachable, "opj_compress makes no file so small"};
            double bestPsnr = -1;
            for (const int bits : kBits) {
                const ScaledImage planes = scaled(subject.image, cube, bits);
                const Result<std::optional<Bytes>> coded = largestThatFits(planes, size);
                if (!coded) return coded.error();
                if (!*coded) continue;
                Bytes file = withCube(cube, **coded);
                const Result<FloatImage> image = decode(file, planes);
                if (!image) return image.error();
                const Result<SurfaceDistance> distance = measure.against(gridMesh(*image));
                if (!distance || distance->psnr() <= bestPsnr) continue;
                bestPsnr = distance->psnr();
                best = Coded{std::move(file), "j2k", {}, *image, {{"bits", bits}}};
            }
            done(size, std::move(best));
        }
        return Done{};
    }

    Result<Times> time(const Subject&, size_t, int) override
    {
        return Error{ErrorKind::BadArgument, "not timed"};
    }

private:
    // Sizes go up with the budget in steps of up to 2 %, some of them above it: between a budget that fits
    // and one that does not there may be a better one.
    Result<std::optional<Bytes>> largestThatFits(const ScaledImage& image, size_t size)
    {
        std::optional<Bytes> best;
        const double room = static_cast<double>(size) - static_cast<double>(Cube::kBytes);
        double fits = 0, tooLarge = 0;
        double budget = room;
        for (int i = 0; i < kAttempts && budget > 0; ++i) {
            Result<Bytes> file = compress(image, budget);
            if (!file) return file.error();
            const bool fit = static_cast<double>(file->size()) <= room;
            (fit ? fits : tooLarge) = budget;
            if (fit && (!best || file->size() > best->size())) best = std::move(*file);
            if (tooLarge == 0)
                budget *= kStride;
            else if (fits == 0)
                budget /= kStride;
            else
                budget = (fits + tooLarge) / 2;
        }
        return best;
    }

    Result<Bytes> compress(const ScaledImage& image, double budget)
    {
        const std::string raw = scratch_.path("in.rawl"), coded = scratch_.path("out.j2k");
        const size_t bytes = image.planes.size() * sizeof(uint16_t);
        if (!cli::writeFile(raw, image.planes.data(), bytes))
            return Error{ErrorKind::FileNotWritable, raw + ": cannot be written"};
        const std::string side = std::to_string(image.side);
        const double bits = static_cast<double>(image.planes.size()) * image.bits;
        const Result<std::string> ran =
            runTool({"opj_compress", "-i", raw, "-o", coded, "-F",
                     side + ',' + side + ",3," + std::to_string(image.bits) + ",u", "-I", "-mct", "0", "-r",
                     std::to_string(bits / 8 / budget)});
        if (!ran) return ran.error();
        return readOutput(coded);
    }

    Result<FloatImage> decode(const Bytes& file, const ScaledImage& like)
    {
        const std::string coded = scratch_.path("in.j2k"), raw = scratch_.path("out.rawl");
        if (!cli::writeFile(coded, file.data() + Cube::kBytes, file.size() - Cube::kBytes))
            return Error{ErrorKind::FileNotWritable, coded + ": cannot be written"};
        const Result<std::string> ran = runTool({"opj_decompress", "-i", coded, "-o", raw});
        if (!ran) return ran.error();
        const Result<Bytes> bytes = readOutput(raw);
        if (!bytes) return bytes.error();
        ScaledImage image = like;
        if (bytes->size() != image.planes.size() * sizeof(uint16_t))
            return Error{ErrorKind::CodecFailure,
                         "opj_decompress wrote " + std::to_string(bytes->size()) + " bytes"};
        std::memcpy(image.planes.data(), bytes->data(), bytes->size());
        return unscaled(image, readCube(file));
    }

    Scratch scratch_;
};

} // namespace

std::unique_ptr<Adapter> makeAdapter() { return std::make_unique<OpenJpeg>(); }

} // namespace gimg::adapter

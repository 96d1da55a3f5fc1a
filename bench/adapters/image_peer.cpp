#include "image_peer.h"

#include "gimg/decode.h"
#include "largest_that_fits.h"
#include "tools/cli.h"
#include "tools/process.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace gimg::adapter {

namespace {

using Bytes = std::vector<uint8_t>;

constexpr int kAttempts = 6;

/// The corner of least x, y, z and the side of the cube that whole numbers are relative to.
struct Cube
{
    float low[3] = {0, 0, 0};
    float side = 0;
};
static_assert(sizeof(Cube) == 16);

Cube cubeOf(const FloatImage& image)
{
    const BoundingCube bounds = boundingCube(image);
    Cube cube;
    for (int c = 0; c < 3; ++c) cube.low[c] = static_cast<float>(bounds.low[c]);
    cube.side = static_cast<float>(bounds.side);
    return cube;
}

ScaledImage scaled(const FloatImage& image, const Cube& cube, int bits)
{
    const size_t pixels = image.samples.size() / 3;
    const double top = std::ldexp(1.0, bits) - 1;
    const double scale = cube.side > 0 ? top / cube.side : 0;
    ScaledImage result{image.width, bits, std::vector<uint16_t>(3 * pixels)};
    for (size_t i = 0; i < pixels; ++i)
        for (size_t c = 0; c < 3; ++c) {
            const double level = (double{image.samples[3 * i + c]} - cube.low[c]) * scale;
            result.planes[c * pixels + i] = static_cast<uint16_t>(std::clamp(std::round(level), 0.0, top));
        }
    return result;
}

FloatImage unscaled(const ScaledImage& image, const Cube& cube)
{
    const size_t pixels = image.planes.size() / 3;
    const double step = cube.side / (std::ldexp(1.0, image.bits) - 1);
    FloatImage result{image.side, image.side, std::vector<float>(3 * pixels)};
    for (size_t i = 0; i < pixels; ++i)
        for (size_t c = 0; c < 3; ++c)
            result.samples[3 * i + c] = static_cast<float>(cube.low[c] + image.planes[c * pixels + i] * step);
    return result;
}

Bytes withCube(const Cube& cube, const Bytes& coded)
{
    Bytes file(sizeof cube + coded.size());
    std::memcpy(file.data(), &cube, sizeof cube);
    std::copy(coded.begin(), coded.end(), file.begin() + sizeof cube);
    return file;
}

class ImageCoder : public Adapter
{
public:
    explicit ImageCoder(ImagePeer peer) : peer_(std::move(peer)) {}

    Description describe() const override { return peer_.description; }

    Status encode(const Subject& subject, const std::vector<size_t>& sizes,
                  const std::function<void(size_t, Result<Coded>)>& done) override
    {
        const SurfaceMeasure measure(gridMesh(subject.image), {200000, 1, subject.threads});
        for (const size_t size : sizes) {
            Result<Coded> best = Error{ErrorKind::TargetUnreachable, "the coder makes no file so small"};
            double bestPsnr = -1;
            for (const ImageVariant& variant : peer_.variants) {
                Result<std::optional<Coded>> coded = encodeWith(variant, subject.image, size);
                if (!coded) return coded.error();
                if (!*coded) continue;
                const Result<SurfaceDistance> distance = measure.against(gridMesh((*coded)->image));
                if (!distance || distance->psnr() <= bestPsnr) continue;
                bestPsnr = distance->psnr();
                best = std::move(**coded);
            }
            done(size, std::move(best));
        }
        return Done{};
    }

    Result<Times> time(const Subject& subject, size_t size, int runs) override
    {
        const ImageVariant& variant = peer_.variants.front();
        const ScaledImage image = scaled(subject.image, cubeOf(subject.image), variant.bits);
        double parameter = variant.start;
        const Result<std::optional<Bytes>> coded = fitted(variant, image, size, parameter);
        if (!coded) return coded.error();
        if (!*coded) return Error{ErrorKind::TargetUnreachable, "the coder makes no file so small"};
        Result<Times> times = peer_.time(image, parameter, runs);
        if (times) times->bytes = sizeof(Cube) + (*coded)->size();
        return times;
    }

private:
    /// @param parameter  becomes that of the file
    Result<std::optional<Bytes>> fitted(const ImageVariant& variant, const ScaledImage& image, size_t size,
                                        double& parameter) const
    {
        if (size <= sizeof(Cube)) return std::optional<Bytes>();
        const size_t room = size - sizeof(Cube);
        size_t largest = 0;
        const auto encode = [&](double value) {
            Result<Bytes> file = variant.encode(image, value);
            if (file && file->size() <= room && file->size() > largest) {
                largest = file->size();
                parameter = value;
            }
            return file;
        };
        return largestThatFits(
            {encode, variant.least, variant.most, variant.start, variant.exponent, kAttempts}, room);
    }

    Result<std::optional<Coded>> encodeWith(const ImageVariant& variant, const FloatImage& image,
                                            size_t size) const
    {
        const Cube cube = cubeOf(image);
        const ScaledImage planes = scaled(image, cube, variant.bits);
        double parameter = variant.start;
        const Result<std::optional<Bytes>> coded = fitted(variant, planes, size, parameter);
        if (!coded) return coded.error();
        if (!*coded) return std::optional<Coded>();
        const Result<ScaledImage> decoded = peer_.decode(**coded, planes);
        if (!decoded) return decoded.error();
        Coded result;
        result.file = withCube(cube, **coded);
        result.extension = peer_.extension;
        result.image = unscaled(*decoded, cube);
        result.settings = variant.settings;
        result.settings["parameter"] = parameter;
        return std::optional<Coded>(std::move(result));
    }

    ImagePeer peer_;
};

} // namespace

std::unique_ptr<Adapter> makeImagePeer(ImagePeer peer)
{
    return std::make_unique<ImageCoder>(std::move(peer));
}

Scratch::Scratch()
{
    std::error_code failed;
    std::string pattern = (std::filesystem::temp_directory_path(failed) / "gimg-adapter-XXXXXX").string();
    // Where no folder can be made, the first file that is to be written there says so.
    if (::mkdtemp(pattern.data()) != nullptr) folder_ = pattern;
}

Scratch::~Scratch()
{
    std::error_code failed;
    if (!folder_.empty()) std::filesystem::remove_all(folder_, failed);
}

Result<std::string> runTool(const std::vector<std::string>& command)
{
    std::string printed;
    const Result<cli::Ended> ended =
        cli::runProgram(command, [&](const std::string& line) { printed += line + '\n'; });
    if (!ended) return ended.error();
    printed += ended->errors;
    if (ended->code == 0) return printed;
    while (!printed.empty() && printed.back() == '\n') printed.pop_back();
    return Error{ErrorKind::CodecFailure, command[0] + " ended with status " + std::to_string(ended->code) +
                                              ": " + printed.substr(printed.find_last_of('\n') + 1)};
}

std::vector<std::string> missingPrograms(const std::vector<std::string>& programs, const std::string& package)
{
    for (const std::string& program : programs)
        if (!onPath(program)) return {package};
    return {};
}

Result<std::vector<uint8_t>> readScratch(const std::string& path)
{
    std::optional<std::vector<uint8_t>> bytes = cli::readFile(path);
    if (!bytes) return Error{ErrorKind::CodecFailure, path + ": was not written"};
    return std::move(*bytes);
}

Status writeScratch(const std::string& path, const void* bytes, size_t size)
{
    if (!cli::writeFile(path, bytes, size))
        return Error{ErrorKind::FileNotWritable, path + ": cannot be written"};
    return Done{};
}

Result<double> numberAfter(const std::string& printed, const std::string& before)
{
    const size_t at = printed.find(before);
    char* end = nullptr;
    const char* start = at == std::string::npos ? "" : printed.c_str() + at + before.size();
    const double number = std::strtod(start, &end);
    if (end == start)
        return Error{ErrorKind::CodecFailure, "no number after '" + before + "' in what was printed"};
    return number;
}

} // namespace gimg::adapter

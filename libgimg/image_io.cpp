#include "gimg/image_io.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <limits>
#include <memory>

namespace gimg {

namespace {

constexpr int kLargestSide = 32768;

Error failure(ErrorKind kind, const std::string& path, const std::string& what)
{
    return {kind, path + ": " + what};
}

template <class Image> Status checkedSize(const Image& image, const std::string& path)
{
    if (image.width < 1 || image.height < 1 || image.width > kLargestSide || image.height > kLargestSide)
        return failure(ErrorKind::BadArgument, path,
                       "an image of " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                           " pixels");
    if (image.samples.size() != 3 * static_cast<size_t>(image.width) * static_cast<size_t>(image.height))
        return failure(ErrorKind::BadArgument, path,
                       std::to_string(image.samples.size()) + " samples for " + std::to_string(image.width) +
                           " x " + std::to_string(image.height) + " pixels of three");
    return Done{};
}

Status checkedForPng(const FloatImage& image, const std::string& path)
{
    if (const Status status = checkedSize(image, path); !status) return status;
    const auto bad =
        std::find_if(image.samples.begin(), image.samples.end(), [](float x) { return !std::isfinite(x); });
    if (bad == image.samples.end()) return Done{};
    const auto pixel = (bad - image.samples.begin()) / 3;
    return failure(ErrorKind::NotFinite, path,
                   "pixel (" + std::to_string(pixel % image.width) + ", " +
                       std::to_string(pixel / image.width) + ") is not finite");
}

using File = std::unique_ptr<FILE, int (*)(FILE*)>;

// libpng leaves by longjmp where something fails, so nothing in here may need a destructor.
bool encodePng(FILE* file, int width, int height, int bits, const std::vector<uint8_t>& bytes)
{
    png_structp png =
        png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr,
                                [](png_structp, png_const_charp) {}); // errors are told by the caller
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    if (!info || setjmp(png_jmpbuf(png))) {
        png_destroy_write_struct(&png, &info);
        return false;
    }
    png_init_io(png, file);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bits,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    const size_t rowSize = bytes.size() / static_cast<size_t>(height);
    for (int row = 0; row < height; ++row)
        png_write_row(png, bytes.data() + static_cast<size_t>(row) * rowSize);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return true;
}

/// @param level  maps channel and sample to [0, 1]
template <class Level>
Status writePng(const FloatImage& image, const std::string& path, int bits, Level level)
try {
    std::vector<uint8_t> bytes;
    bytes.reserve(image.samples.size() * static_cast<size_t>(bits / 8));
    const double top = bits == 16 ? 65535.0 : 255.0;
    for (size_t i = 0; i < image.samples.size(); ++i) {
        const double unit = level(static_cast<int>(i % 3), double{image.samples[i]});
        const auto value = static_cast<uint16_t>(std::lround(std::clamp(unit, 0.0, 1.0) * top));
        if (bits == 16) bytes.push_back(static_cast<uint8_t>(value >> 8)); // PNG is big-endian
        bytes.push_back(static_cast<uint8_t>(value & 0xff));
    }
    File file(std::fopen(path.c_str(), "wb"), std::fclose);
    if (!file || !encodePng(file.get(), image.width, image.height, bits, bytes) ||
        std::fclose(file.release()) != 0)
        return failure(ErrorKind::FileNotWritable, path, "cannot be written");
    return Done{};
} catch (const std::exception& e) {
    return failure(ErrorKind::FileNotWritable, path, e.what());
}

Status writeScaledPng(const FloatImage& image, const std::string& path, int bits)
{
    if (const Status status = checkedForPng(image, path); !status) return status;
    const BoundingCube cube = boundingCube(image);
    return writePng(image, path, bits, [&cube](int channel, double value) {
        return cube.side > 0 ? (value - cube.low[channel]) / cube.side : 0.0;
    });
}

using ChannelNames = std::array<const char*, 3>;
constexpr ChannelNames kChannels = {"R", "G", "B"}, kCoordinates = {"X", "Y", "Z"};

/// OpenEXR addresses pixels by data window coordinates, so `left` and `top` are the corner of that window.
Imf::FrameBuffer frameBuffer(const ChannelNames& names, float* samples, int width, int left, int top)
{
    const size_t stride = 3 * sizeof(float);
    const size_t rowStride = stride * static_cast<size_t>(width);
    const auto offset = static_cast<ptrdiff_t>(stride) * left + static_cast<ptrdiff_t>(rowStride) * top;
    Imf::FrameBuffer buffer;
    for (size_t c = 0; c < 3; ++c)
        buffer.insert(names[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(samples + c) - offset, stride,
                                           rowStride));
    return buffer;
}

// n for 3 n^2 floats; 0 for any other size.
int sideOfFloats(std::uintmax_t bytes)
{
    const auto n = static_cast<int>(std::lround(std::sqrt(static_cast<double>(bytes / (3 * sizeof(float))))));
    return n >= 2 && n <= kLargestSide && bytes == std::uintmax_t{3} * n * n * sizeof(float) ? n : 0;
}

float littleEndianFloat(const uint8_t* bytes)
{
    uint32_t bits = 0;
    for (int k = 0; k < 4; ++k) bits |= uint32_t{bytes[k]} << (8 * k);
    return std::bit_cast<float>(bits);
}

} // namespace

BoundingCube boundingCube(const FloatImage& image)
{
    if (image.samples.size() < 3) return {};
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 high = -low;
    for (size_t i = 0; i + 2 < image.samples.size(); i += 3) {
        const Vec3 p(image.samples[i], image.samples[i + 1], image.samples[i + 2]);
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    return {low, (high - low).maxCoeff()};
}

Status writePng8(const FloatImage& image, const std::string& path) { return writeScaledPng(image, path, 8); }
Status writePng16(const FloatImage& image, const std::string& path)
{
    return writeScaledPng(image, path, 16);
}

Status writeNormalPng(const FloatImage& normals, const std::string& path)
{
    if (const Status status = checkedForPng(normals, path); !status) return status;
    return writePng(normals, path, 8, [](int, double value) { return (value + 1) / 2; });
}

Result<std::vector<uint8_t>> pngBytes(const RgbImage& image)
try {
    if (const Status status = checkedSize(image, "PNG"); !status) return status.error();
    char* data = nullptr;
    size_t size = 0;
    File memory(open_memstream(&data, &size), std::fclose);
    const bool encoded = memory && encodePng(memory.get(), image.width, image.height, 8, image.samples);
    const bool closed = memory && std::fclose(memory.release()) == 0; // data and size are known from here
    const std::unique_ptr<char, void (*)(void*)> owner(data, std::free);
    if (!encoded || !closed) return failure(ErrorKind::FileNotWritable, "PNG", "out of memory");
    return std::vector<uint8_t>(data, data + size);
} catch (const std::exception& e) {
    return failure(ErrorKind::FileNotWritable, "PNG", e.what());
}

Status writePng(const RgbImage& image, const std::string& path)
{
    if (const Status status = checkedSize(image, path); !status) return status;
    File file(std::fopen(path.c_str(), "wb"), std::fclose);
    if (!file || !encodePng(file.get(), image.width, image.height, 8, image.samples) ||
        std::fclose(file.release()) != 0)
        return failure(ErrorKind::FileNotWritable, path, "cannot be written");
    return Done{};
}

Status writeExr(const FloatImage& image, const std::string& path)
try {
    if (const Status status = checkedSize(image, path); !status) return status;
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const char* channel : kChannels) header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    Imf::OutputFile file(path.c_str(), header, 0); // no threads beside the caller's
    // The frame buffer of OpenEXR serves reading too and knows no const.
    file.setFrameBuffer(frameBuffer(kChannels, const_cast<float*>(image.samples.data()), image.width, 0, 0));
    file.writePixels(image.height);
    return Done{};
} catch (const std::exception& e) {
    return failure(ErrorKind::FileNotWritable, path, e.what());
}

Result<FloatImage> readExr(const std::string& path)
try {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored))
        return failure(ErrorKind::FileNotReadable, path, "no such file");
    Imf::InputFile file(path.c_str(), 0);
    const ChannelNames& names = file.header().channels().findChannel("X") ? kCoordinates : kChannels;
    for (const char* name : names) {
        const Imf::Channel* channel = file.header().channels().findChannel(name);
        if (!channel || channel->xSampling != 1 || channel->ySampling != 1)
            return failure(ErrorKind::FileCorrupt, path, std::string("no full channel ") + name);
    }
    const Imath::Box2i window = file.header().dataWindow();
    const int64_t width = int64_t{window.max.x} - window.min.x + 1;
    const int64_t height = int64_t{window.max.y} - window.min.y + 1;
    if (width < 1 || height < 1 || width > kLargestSide || height > kLargestSide)
        return failure(ErrorKind::BadArgument, path,
                       "an image of " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
    FloatImage image;
    image.width = static_cast<int>(width);
    image.height = static_cast<int>(height);
    image.samples.resize(3 * static_cast<size_t>(width) * static_cast<size_t>(height));
    file.setFrameBuffer(frameBuffer(names, image.samples.data(), image.width, window.min.x, window.min.y));
    file.readPixels(window.min.y, window.max.y);
    return image;
} catch (const std::exception& e) {
    return failure(ErrorKind::FileCorrupt, path, e.what());
}

Status writeF32(const FloatImage& image, const std::string& path)
{
    if (const Status status = checkedSize(image, path); !status) return status;
    if (image.width != image.height) return failure(ErrorKind::BadArgument, path, "the image is not square");
    std::vector<uint8_t> bytes;
    bytes.reserve(image.samples.size() * sizeof(float));
    for (size_t c = 0; c < 3; ++c)
        for (size_t i = c; i < image.samples.size(); i += 3) {
            const auto bits = std::bit_cast<uint32_t>(image.samples[i]);
            for (int k = 0; k < 4; ++k) bytes.push_back(static_cast<uint8_t>(bits >> (8 * k)));
        }
    File file(std::fopen(path.c_str(), "wb"), std::fclose);
    if (!file || std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size() ||
        std::fclose(file.release()) != 0)
        return failure(ErrorKind::FileNotWritable, path, "cannot be written");
    return Done{};
}

Result<FloatImage> readF32(const std::string& path)
{
    std::error_code failed;
    const std::uintmax_t size = std::filesystem::file_size(path, failed);
    File file(std::fopen(path.c_str(), "rb"), std::fclose);
    if (failed || !file) return failure(ErrorKind::FileNotReadable, path, "cannot be read");
    const int n = sideOfFloats(size);
    if (n == 0) return failure(ErrorKind::FileCorrupt, path, "is not 3 n^2 floats");
    std::vector<uint8_t> bytes(static_cast<size_t>(size));
    if (std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size())
        return failure(ErrorKind::FileNotReadable, path, "cannot be read");
    const size_t pixels = size_t{1} * n * n;
    FloatImage image{n, n, std::vector<float>(3 * pixels)};
    for (size_t i = 0; i < pixels; ++i)
        for (size_t c = 0; c < 3; ++c) {
            const float value = littleEndianFloat(&bytes[sizeof(float) * (c * pixels + i)]);
            if (!std::isfinite(value))
                return failure(ErrorKind::NotFinite, path, "sample " + std::to_string(i) + " is not finite");
            image.samples[3 * i + c] = value;
        }
    return image;
}

Result<FloatImage> readGeometryImage(const std::string& path)
{
    const std::string extension = std::filesystem::path(path).extension().string();
    if (extension != ".f32" && extension != ".exr")
        return failure(ErrorKind::FormatUnknown, path, "a geometry image is an .exr or .f32 file");
    Result<FloatImage> image = extension == ".f32" ? readF32(path) : readExr(path);
    if (!image) return image;
    const int n = image->width;
    if (n != image->height || n < 3 || n > 4097 || ((n - 1) & (n - 2)) != 0)
        return failure(ErrorKind::FileCorrupt, path,
                       "an image of " + std::to_string(n) + " x " + std::to_string(image->height) +
                           " samples; a geometry image has 2^j + 1 a side, 3 to 4097");
    const auto bad = std::find_if(image->samples.begin(), image->samples.end(),
                                  [](float value) { return !std::isfinite(value); });
    if (bad != image->samples.end()) {
        const auto sample = (bad - image->samples.begin()) / 3;
        return failure(ErrorKind::NotFinite, path,
                       "sample " + std::to_string(sample % n) + ", " + std::to_string(sample / n) +
                           " is not finite");
    }
    return image;
}

int sideOfF32(const std::string& path)
{
    std::error_code failed;
    const std::uintmax_t size = std::filesystem::file_size(path, failed);
    return failed ? 0 : sideOfFloats(size);
}

} // namespace gimg

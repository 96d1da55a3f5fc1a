#include "gimg/image_io.h"
#include "temporary_files.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <gmock/gmock.h>
#include <png.h>

#include <cmath>
#include <cstring>
#include <limits>

using namespace gimg;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

namespace {

class ImageIo : public test::TemporaryFiles
{
};

struct Png
{
    unsigned width, height;
    int bits;
    std::vector<unsigned> samples;
};

Png readPng(const std::string& path)
{
    FILE* file = std::fopen(path.c_str(), "rb");
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, file);
    png_read_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
    Png image{
        png_get_image_width(png, info), png_get_image_height(png, info), png_get_bit_depth(png, info), {}};
    EXPECT_EQ(png_get_color_type(png, info), PNG_COLOR_TYPE_RGB);
    png_bytepp rows = png_get_rows(png, info);
    for (unsigned y = 0; y < image.height; ++y)
        for (unsigned i = 0; i < 3 * image.width; ++i)
            image.samples.push_back(image.bits == 16 ? unsigned{rows[y][2 * i]} << 8 | rows[y][2 * i + 1]
                                                     : rows[y][i]);
    png_destroy_read_struct(&png, &info, nullptr);
    std::fclose(file);
    return image;
}

// Two columns, three rows. The extents are 4, 2 and 1: x sets the scale.
FloatImage smallImage() { return {2, 3, {10, 0, 5, 14, 1, 5, 12, 2, 5, 11, 0, 6, 10, 2, 6, 13, 1, 5.5F}}; }

} // namespace

TEST_F(ImageIo, TheBoundingCubeHasTheLargestExtent)
{
    const BoundingCube cube = boundingCube(smallImage());
    EXPECT_EQ(cube.low, Vec3(10, 0, 5));
    EXPECT_EQ(cube.side, 4);
}

TEST_F(ImageIo, PngIsScaledFromTheBoundingCube)
{
    ASSERT_TRUE(writePng16(smallImage(), path("a.png")).ok());
    const Png deep = readPng(path("a.png"));
    EXPECT_EQ(deep.width, 2U);
    EXPECT_EQ(deep.height, 3U);
    EXPECT_EQ(deep.bits, 16);
    EXPECT_THAT(deep.samples, ElementsAre(0, 0, 0, 65535, 16384, 0, 32768, 32768, 0, 16384, 0, 16384, 0,
                                          32768, 16384, 49151, 16384, 8192));

    ASSERT_TRUE(writePng8(smallImage(), path("b.png")).ok());
    const Png flat = readPng(path("b.png"));
    EXPECT_EQ(flat.bits, 8);
    EXPECT_THAT(flat.samples,
                ElementsAre(0, 0, 0, 255, 64, 0, 128, 128, 0, 64, 0, 64, 0, 128, 64, 191, 64, 32));
}

TEST_F(ImageIo, AnImageWithoutExtentIsBlack)
{
    ASSERT_TRUE(writePng8({1, 1, {3, 4, 5}}, path("a.png")).ok());
    EXPECT_THAT(readPng(path("a.png")).samples, ElementsAre(0, 0, 0));
}

TEST_F(ImageIo, NormalsAreMappedFromMinusOneToOne)
{
    ASSERT_TRUE(writeNormalPng({2, 1, {-1, 0, 1, 1.5F, -2, 0.6F}}, path("n.png")).ok());
    EXPECT_THAT(readPng(path("n.png")).samples, ElementsAre(0, 128, 255, 255, 0, 204));
}

TEST_F(ImageIo, ExrKeepsEveryBit)
{
    FloatImage image{3, 2, {}};
    for (int i = 0; i < 18; ++i)
        image.samples.push_back(std::ldexp(1.0F + static_cast<float>(i) * 0x1p-23F, 5 * i - 40));
    image.samples[3] = -0.0F;
    image.samples[4] = std::numeric_limits<float>::denorm_min();
    image.samples[5] = std::numeric_limits<float>::infinity();
    image.samples[6] = std::numeric_limits<float>::quiet_NaN();
    image.samples[7] = std::numeric_limits<float>::max();
    ASSERT_TRUE(writeExr(image, path("a.exr")).ok());
    const Result<FloatImage> back = readExr(path("a.exr"));
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_EQ(back->width, 3);
    EXPECT_EQ(back->height, 2);
    ASSERT_EQ(back->samples.size(), image.samples.size());
    EXPECT_EQ(std::memcmp(back->samples.data(), image.samples.data(), 18 * sizeof(float)), 0);
    EXPECT_EQ(back->at(2, 1, 0), image.samples[15]);
}

TEST_F(ImageIo, ExrOfOtherProgramsHasWindowsAndHalfs)
{
    const Imath::Box2i window({-3, 5}, {-2, 7});
    Imf::Header header(Imath::Box2i({0, 0}, {9, 9}), window);
    std::vector<half> samples;
    for (int i = 0; i < 24; ++i) samples.push_back(half(static_cast<float>(i) / 4));
    Imf::FrameBuffer buffer;
    size_t c = 0;
    for (const char* name : {"R", "G", "B", "A"}) {
        header.channels().insert(name, Imf::Channel(Imf::HALF));
        buffer.insert(
            name,
            Imf::Slice(Imf::HALF, reinterpret_cast<char*>(samples.data() + c++) - (-3 * 8 + 5 * 16), 8, 16));
    }
    {
        Imf::OutputFile file(path("a.exr").c_str(), header);
        file.setFrameBuffer(buffer);
        file.writePixels(3);
    }
    const Result<FloatImage> image = readExr(path("a.exr"));
    ASSERT_TRUE(image.ok()) << image.error().message;
    ASSERT_EQ(image->width, 2);
    ASSERT_EQ(image->height, 3);
    for (int pixel = 0; pixel < 6; ++pixel)
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(image->at(pixel % 2, pixel / 2, k), static_cast<float>(4 * pixel + k) / 4);
}

TEST_F(ImageIo, ExrOfCoordinatesIsNamedByThem)
{
    Imf::Header header(3, 3);
    std::vector<float> samples(27);
    for (size_t k = 0; k < samples.size(); ++k) samples[k] = static_cast<float>(k);
    Imf::FrameBuffer buffer;
    size_t c = 0;
    for (const char* name : {"X", "Y", "Z"}) {
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(samples.data() + c++), 12, 36));
    }
    {
        Imf::OutputFile file(path("a.exr").c_str(), header);
        file.setFrameBuffer(buffer);
        file.writePixels(3);
    }
    const Result<FloatImage> image = readGeometryImage(path("a.exr"));
    ASSERT_TRUE(image.ok()) << image.error().message;
    EXPECT_EQ(image->samples, samples);
}

TEST_F(ImageIo, DamagedExrIsRefused)
{
    const FloatImage image{16, 16, std::vector<float>(768, 0.3F)};
    ASSERT_TRUE(writeExr(image, path("a.exr")).ok());
    const std::string whole = read(path("a.exr"));
    for (size_t size = 0; size < whole.size(); size += 7) {
        const Result<FloatImage> cut = readExr(write("cut.exr", whole.substr(0, size)));
        ASSERT_FALSE(cut.ok()) << size;
        EXPECT_EQ(cut.error().kind, ErrorKind::FileCorrupt);
    }
    EXPECT_EQ(readExr(path("none.exr")).error().kind, ErrorKind::FileNotReadable);

    Imf::Header header(2, 2);
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    std::vector<float> grey(4, 1.0F);
    Imf::FrameBuffer buffer;
    buffer.insert("Y", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(grey.data()), 4, 8));
    {
        Imf::OutputFile file(path("grey.exr").c_str(), header);
        file.setFrameBuffer(buffer);
        file.writePixels(2);
    }
    EXPECT_THAT(readExr(path("grey.exr")).error().message, HasSubstr("no full channel R"));
}

TEST_F(ImageIo, WhatCannotBeWrittenIsRefused)
{
    const auto kind = [](const Status& status) {
        return status.ok() ? ErrorKind::CodecFailure : status.error().kind;
    };
    EXPECT_EQ(kind(writePng8({}, path("a.png"))), ErrorKind::BadArgument);
    EXPECT_EQ(kind(writePng16({2, 2, {1, 2, 3}}, path("a.png"))), ErrorKind::BadArgument);
    EXPECT_EQ(kind(writeExr({0, 2, {}}, path("a.exr"))), ErrorKind::BadArgument);
    EXPECT_EQ(kind(writePng8(smallImage(), path("none/a.png"))), ErrorKind::FileNotWritable);
    EXPECT_EQ(kind(writeExr(smallImage(), path("none/a.exr"))), ErrorKind::FileNotWritable);
    FloatImage infinite = smallImage();
    infinite.samples[8] = std::numeric_limits<float>::infinity();
    EXPECT_EQ(kind(writeNormalPng(infinite, path("a.png"))), ErrorKind::NotFinite);
    EXPECT_THAT(writePng8(infinite, path("a.png")).error().message, HasSubstr("pixel (0, 1) is not finite"));
}

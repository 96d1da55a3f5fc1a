#pragma once

#include "gimg/mesh.h"
#include "gimg/result.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace gimg {

/// Three floats a pixel: x, y, z of a geometry image, or of a normal image. Row 0 holds t = 0 and is row 0 of
/// every file, which viewers show at the top; column 0 holds s = 0.
struct FloatImage
{
    int width = 0;
    int height = 0;
    std::vector<float> samples; ///< 3 * width * height, row after row

    float at(int column, int row, int channel) const
    {
        const int64_t pixel = int64_t{row} * width + column;
        return samples[static_cast<size_t>(3 * pixel + channel)];
    }
};

/// The cube a geometry image is scaled into for viewing: its corner of least x, y, z, and the largest extent.
struct BoundingCube
{
    Vec3 low = Vec3::Zero();
    double side = 0;
};
BoundingCube boundingCube(const FloatImage& image);

/// Writes x, y, z as red, green, blue: (value - low) / side of the bounding cube, times 255 or 65535,
/// rounded. The three axes share one scale; an image without extent is black. So do Gu, Gortler and Hoppe
/// (2002) show geometry images.
/// Errors: BadArgument (empty, or samples that do not fit the size), NotFinite (names the pixel),
/// FileNotWritable.
Status writePng8(const FloatImage& image, const std::string& path);
Status writePng16(const FloatImage& image, const std::string& path);

/// Writes unit normals with 8 bits a component: round((value + 1) / 2 * 255), clamped.
/// Errors: as writePng8.
Status writeNormalPng(const FloatImage& normals, const std::string& path);

/// A picture: 8 bits each of red, green and blue a pixel, the top row first.
struct RgbImage
{
    int width = 0;
    int height = 0;
    std::vector<uint8_t> samples; ///< 3 * width * height, row after row
};

/// The bytes of a PNG file with these pixels; writePng writes them.
/// Errors: BadArgument (empty, above 32768 x 32768 pixels, or samples that do not fit the size),
/// FileNotWritable.
Result<std::vector<uint8_t>> pngBytes(const RgbImage& image);
Status writePng(const RgbImage& image, const std::string& path);

/// Writes every float as it is, channels R, G, B of type float, without loss.
/// Errors: BadArgument, FileNotWritable.
Status writeExr(const FloatImage& image, const std::string& path);

/// Reads the channels X, Y, Z of an EXR file, or R, G, B if it has no X; half-float channels are widened.
/// Errors: FileNotReadable, FileCorrupt (also: a channel is missing), BadArgument (above 32768 x 32768
/// pixels).
Result<FloatImage> readExr(const std::string& path);

/// Writes and reads .f32, a square image as the other geometry image coders take it: 3 n^2 little-endian
/// floats, planar x, y, z, row after row; n follows from the size of the file.
/// Errors: BadArgument (not square, or as writeExr), FileNotWritable; FileNotReadable, FileCorrupt (no such
/// size), NotFinite.
Status writeF32(const FloatImage& image, const std::string& path);
Result<FloatImage> readF32(const std::string& path);

/// Reads an .exr or .f32 file that is to be a geometry image: square, 2^j + 1 samples a side, 3 to 4097, all
/// finite. Errors: as readExr and readF32; FormatUnknown (by the name), FileCorrupt (the size), NotFinite.
Result<FloatImage> readGeometryImage(const std::string& path);

/// Samples a side of a .f32 file, as its size says; 0 if it is not there or has no such size.
int sideOfF32(const std::string& path);

} // namespace gimg

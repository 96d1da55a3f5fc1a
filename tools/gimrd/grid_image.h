#pragma once

#include "gimg/image_io.h"
#include "gimg/mesh.h"
#include "gimg/result.h"

#include <filesystem>

namespace gimg::gimrd {

/// Whether a file name says that the file holds a geometry image: 3 n^2 little-endian floats, planar x, y, z,
/// row after row.
bool isGridImage(const std::filesystem::path& path);

/// Samples a side of such a file, as its size says; 0 if it is not there or has no such size.
int gridImageSide(const std::filesystem::path& path);

/// Errors: FileNotReadable, FileCorrupt, NotFinite.
Result<FloatImage> readGridImage(const std::filesystem::path& path);

/// Errors: FileNotWritable.
Status writeGridImage(const FloatImage& image, const std::filesystem::path& path);

/// The triangles of a geometry image, with open borders; vertex j * width + i is sample (i, j).
Mesh openGridMesh(const FloatImage& image);

} // namespace gimg::gimrd

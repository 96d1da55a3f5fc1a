#pragma once

#include "gimg/image_io.h"
#include "gimg/mesh.h"
#include "gimg/result.h"
#include "gimg/vertex_attribute.h"

#include <gim.h>

#include <cstdint>
#include <span>
#include <vector>

namespace gimg {

/// An attribute's image: `values` are by sample, in rows.
struct AttributeImage
{
    gim_attribute info;
    VertexAttribute samples;
};

/// A .gim file's samples. The C functions of gim.h do the same without allocating.
struct DecodedImages
{
    gim_info info;
    FloatImage geometry;
    FloatImage normals; ///< empty if the file has none
    std::vector<AttributeImage> attributes;
    bool isPrefix = false; ///< the file was cut short
};

/// @param flags  GIM_NO_FUSE, GIM_NO_DIFFUSE, GIM_PREFIX, or 0
/// Errors: FileTruncated, FileCorrupt, CodecFailure (a version or size this library does not take).
Result<DecodedImages> decodeImages(std::span<const uint8_t> file, unsigned flags = 0);

/// The mesh of a level of detail: one vertex for each class of glued samples.
/// @param level  0 is the finest; each step halves the grid; below info.levels
/// Errors: as decodeImages; BadArgument for a level that the file does not have.
Result<Mesh> levelMesh(std::span<const uint8_t> file, const DecodedImages& images, unsigned level,
                       unsigned flags = 0);

/// The attributes of levelMesh's vertices. Where an attribute's grid is coarser than the level, values lie
/// between its samples, bilinearly.
/// Errors: as levelMesh.
Result<std::vector<VertexAttribute>> levelAttributes(std::span<const uint8_t> file,
                                                     const DecodedImages& images, unsigned level,
                                                     unsigned flags = 0);

/// The triangles of a square geometry image as levelMesh has them, but with open borders, no samples glued;
/// vertex j * width + i is sample (i, j).
Mesh gridMesh(const FloatImage& image);

} // namespace gimg

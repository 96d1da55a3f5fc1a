#pragma once

#include "gimg/decode.h"
#include "gimg/distance.h"
#include "gimg/encode.h"

#include <gtest/gtest.h>

namespace gimg::test {

inline EncodedMesh encode(const Mesh& mesh, const EncodeOptions& options)
{
    Result<EncodedMesh> encoded = encodeMesh(mesh, options);
    EXPECT_TRUE(encoded.ok()) << encoded.error().message;
    return encoded ? std::move(*encoded) : EncodedMesh{};
}

/// Samples slide, but are not fitted again: what is tested is seldom how good they become.
constexpr int kQuickEffort = 4;

inline EncodeOptions forBytes(size_t bytes, int grid = 0)
{
    EncodeOptions options;
    options.bytes = bytes;
    options.grid = grid;
    options.effort = kQuickEffort;
    return options;
}

inline EncodeOptions forTarget(EncodeTarget target, int grid)
{
    EncodeOptions options;
    options.target = target;
    options.grid = grid;
    options.effort = kQuickEffort;
    return options;
}

inline Mesh decodedLevel(const EncodedMesh& encoded, unsigned level, unsigned flags = 0)
{
    const Result<DecodedImages> images = decodeImages(encoded.file, flags);
    EXPECT_TRUE(images.ok());
    Result<Mesh> mesh = levelMesh(encoded.file, *images, level, flags);
    EXPECT_TRUE(mesh.ok());
    return *mesh;
}

inline double psnrOf(const Mesh& reference, const Mesh& test)
{
    const Result<SurfaceDistance> distance = compareSurfaces(reference, test);
    EXPECT_TRUE(distance.ok());
    return distance->psnr();
}

} // namespace gimg::test

#include "gimg/decode.h"

#include "codec/triangulate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>

namespace gimg {
namespace {

Error decoderError(gim_status status)
{
    const std::string text = gim_status_text(status);
    switch (status) {
    case GIM_MORE_INPUT:
        return {ErrorKind::FileTruncated, text};
    case GIM_CORRUPT:
        return {ErrorKind::FileCorrupt, text};
    case GIM_MISUSE:
        return {ErrorKind::BadArgument, text};
    default:
        return {ErrorKind::CodecFailure, text};
    }
}

FloatImage emptyImage(uint32_t n)
{
    return {static_cast<int>(n), static_cast<int>(n), std::vector<float>(size_t{3} * n * n)};
}

Result<AttributeImage> decodeAttribute(std::span<const uint8_t> file, uint32_t index,
                                       std::vector<std::byte>& workspace)
{
    AttributeImage out{};
    out.info.size = sizeof out.info;
    gim_status status = gim_read_attribute(file.data(), file.size(), nullptr, index, &out.info);
    if (status != GIM_OK) return decoderError(status);
    const auto decodeAs = [&](auto zero) {
        std::vector<decltype(zero)> samples(out.info.decoded_bytes / sizeof zero);
        status = gim_decode_attribute(file.data(), file.size(), nullptr, index, workspace.data(),
                                      workspace.size(), samples.data());
        out.samples.values.assign(samples.begin(), samples.end());
    };
    if (out.info.type == GIM_U8)
        decodeAs(uint8_t{});
    else if (out.info.type == GIM_U16)
        decodeAs(uint16_t{});
    else
        decodeAs(0.0f);
    if (status != GIM_OK) return decoderError(status);
    out.samples.name = out.info.name;
    out.samples.channels = static_cast<int>(out.info.channels);
    out.samples.type = out.info.type;
    out.samples.normalized = out.info.normalized != 0;
    return out;
}

// The finest grid's sample of each vertex of a level.
Result<std::vector<uint32_t>> samplesOfVertices(std::span<const uint8_t> file, const DecodedImages& images,
                                                unsigned level, unsigned flags)
{
    if (level >= images.info.levels)
        return Error{ErrorKind::BadArgument, "level " + std::to_string(level) + " does not exist"};
    std::vector<std::byte> workspace(gim_workspace_size(&images.info));
    gim_mesh_counts counts{};
    counts.size = sizeof counts;
    gim_status status = gim_mesh_size(file.data(), file.size(), nullptr, flags, level, workspace.data(),
                                      workspace.size(), &counts);
    if (status != GIM_OK) return decoderError(status);
    std::vector<uint32_t> samples(counts.vertices);
    status = gim_build_mesh(file.data(), file.size(), nullptr, flags, level, workspace.data(),
                            workspace.size(), nullptr, nullptr, samples.data(), nullptr);
    if (status != GIM_OK) return decoderError(status);
    return samples;
}

} // namespace

Result<DecodedImages> decodeImages(std::span<const uint8_t> file, unsigned flags)
{
    DecodedImages out{};
    out.info.size = sizeof out.info;
    gim_status status = gim_probe(file.data(), file.size(), nullptr, &out.info);
    const bool isPrefix = status == GIM_MORE_INPUT && out.info.grid != 0 && (flags & GIM_PREFIX) != 0;
    if (status != GIM_OK && !isPrefix) return decoderError(status);
    out.isPrefix = isPrefix;
    std::vector<std::byte> workspace(gim_workspace_size(&out.info));
    out.geometry = emptyImage(out.info.grid);
    status = gim_decode_geometry(file.data(), file.size(), nullptr, flags, workspace.data(), workspace.size(),
                                 out.geometry.samples.data());
    if (status != GIM_OK) return decoderError(status);
    if (out.info.normal_grid > 0) {
        out.normals = emptyImage(out.info.normal_grid);
        status = gim_decode_normals(file.data(), file.size(), nullptr, flags, workspace.data(),
                                    workspace.size(), out.normals.samples.data());
        if (status != GIM_OK) return decoderError(status);
    }
    for (uint32_t k = 0; k < out.info.attributes; ++k) {
        Result<AttributeImage> attribute = decodeAttribute(file, k, workspace);
        if (!attribute) return attribute.error();
        out.attributes.push_back(std::move(*attribute));
    }
    return out;
}

Result<std::vector<VertexAttribute>>
levelAttributes(std::span<const uint8_t> file, const DecodedImages& images, unsigned level, unsigned flags)
{
    const Result<std::vector<uint32_t>> samples = samplesOfVertices(file, images, level, flags);
    if (!samples) return samples.error();
    const uint32_t grid = images.info.grid;
    std::vector<VertexAttribute> out;
    for (const AttributeImage& image : images.attributes) {
        VertexAttribute& attribute = out.emplace_back(image.samples);
        attribute.values.clear();
        const uint32_t n = image.info.grid;
        const size_t channels = image.info.channels;
        for (const uint32_t sample : *samples) {
            const double x = static_cast<double>(sample % grid) * (n - 1) / (grid - 1),
                         y = static_cast<double>(sample / grid) * (n - 1) / (grid - 1);
            const uint32_t i = std::min(static_cast<uint32_t>(x), n - 2),
                           j = std::min(static_cast<uint32_t>(y), n - 2);
            const double u = x - i, v = y - j;
            const float* low = &image.samples.values[channels * (size_t{j} * n + i)];
            const float* high = low + channels * n;
            for (size_t c = 0; c < channels; ++c) {
                const double value = (1 - v) * ((1 - u) * double{low[c]} + u * double{low[channels + c]}) +
                                     v * ((1 - u) * double{high[c]} + u * double{high[channels + c]});
                attribute.values.push_back(
                    static_cast<float>(attribute.type == GIM_F32 ? value : std::floor(value + 0.5)));
            }
        }
    }
    return out;
}

Result<Mesh> levelMesh(std::span<const uint8_t> file, const DecodedImages& images, unsigned level,
                       unsigned flags)
{
    if (level >= images.info.levels)
        return Error{ErrorKind::BadArgument,
                     "level " + std::to_string(level) + " does not exist: the file has " +
                         std::to_string(images.info.levels) + " levels, 0 the finest"};
    std::vector<std::byte> workspace(gim_workspace_size(&images.info));
    gim_mesh_counts counts{};
    counts.size = sizeof counts;
    gim_status status = gim_mesh_size(file.data(), file.size(), nullptr, flags, level, workspace.data(),
                                      workspace.size(), &counts);
    if (status != GIM_OK) return decoderError(status);
    std::vector<uint32_t> sampleOfVertex(counts.vertices), triangles(size_t{3} * counts.triangles);
    const float* xyz = images.geometry.samples.data();
    status = gim_build_mesh(file.data(), file.size(), nullptr, flags, level, workspace.data(),
                            workspace.size(), xyz, nullptr, sampleOfVertex.data(), triangles.data());
    if (status != GIM_OK) return decoderError(status);

    Mesh mesh;
    mesh.positions.reserve(sampleOfVertex.size());
    for (uint32_t sample : sampleOfVertex) {
        const float* p = xyz + size_t{3} * sample;
        mesh.positions.emplace_back(p[0], p[1], p[2]);
    }
    mesh.faces.reserve(counts.triangles);
    for (size_t t = 0; t < counts.triangles; ++t)
        mesh.faces.push_back({static_cast<int>(triangles[3 * t]), static_cast<int>(triangles[3 * t + 1]),
                              static_cast<int>(triangles[3 * t + 2])});
    return mesh;
}

Mesh gridMesh(const FloatImage& image)
{
    Mesh mesh;
    const int n = image.width;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            mesh.positions.emplace_back(image.at(i, j, 0), image.at(i, j, 1), image.at(i, j, 2));
    const auto size = static_cast<uint32_t>(n);
    std::vector<uint32_t> vertices(mesh.positions.size()), corners(size_t{6} * (size - 1) * (size - 1));
    std::iota(vertices.begin(), vertices.end(), 0U);
    codec::triangulate(size, 1, size, image.samples.data(), vertices.data(), corners.data());
    for (size_t k = 0; k < corners.size(); k += 3)
        mesh.faces.push_back({static_cast<int>(corners[k]), static_cast<int>(corners[k + 1]),
                              static_cast<int>(corners[k + 2])});
    return mesh;
}

} // namespace gimg

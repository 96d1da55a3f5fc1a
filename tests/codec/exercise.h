#pragma once

#include "gim.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

/// Calls everything a file can be given to, with limits that keep it short. For fuzzing and mutation tests:
/// what counts is that nothing is read or written out of bounds, and that what decodes is finite and in
/// range.
inline gim_status exerciseDecoder(const std::uint8_t* bytes, std::size_t size, std::uint32_t maxGrid)
{
    const gim_limits limits{sizeof(gim_limits), maxGrid, 4096, std::uint64_t{1} << 26};
    gim_info info{};
    info.size = sizeof info;
    const gim_status probe = gim_probe(bytes, size, &limits, &info);
    gim_chunk chunk{};
    chunk.size = sizeof chunk;
    for (std::uint32_t k = 0; k < 4; ++k) (void)gim_read_chunk(bytes, size, k, &chunk);
    const std::uint32_t prefix = probe == GIM_MORE_INPUT && info.grid != 0 ? GIM_PREFIX : 0;
    if (probe != GIM_OK && prefix == 0) return probe;

    // Exactly the promised sizes, so that a sanitizer sees any step beyond.
    std::vector<unsigned char> work(gim_workspace_size(&info));
    std::vector<float> xyz(3 * std::size_t{info.grid} * info.grid);
    gim_seam seam{};
    seam.size = sizeof seam;
    gim_status status = gim_read_seam(bytes, size, &limits, work.data(), work.size(), &seam, nullptr, 0);
    if (status == GIM_OK) {
        std::vector<gim_side> sides(seam.sides);
        status =
            gim_read_seam(bytes, size, &limits, work.data(), work.size(), &seam, sides.data(), seam.sides);
        if (status != GIM_OK) std::abort();
        std::uint64_t total = 0;
        for (const gim_side& side : sides) total += side.length;
        if (total != 4 * std::uint64_t{info.lowest - 1} || seam.paths > seam.sides) std::abort();
    }
    for (std::uint32_t flags = 0; flags < 3; ++flags) {
        const gim_status decoded =
            gim_decode_geometry(bytes, size, &limits, flags | prefix, work.data(), work.size(), xyz.data());
        if (decoded == GIM_MISUSE) std::abort();
        if (decoded != GIM_OK) return decoded;
        for (const float value : xyz)
            if (!(value - value == 0)) std::abort();
    }
    for (std::uint32_t level = 0; level < info.levels; ++level) {
        for (const std::uint32_t flags : {prefix, prefix | GIM_NO_FUSE}) {
            gim_mesh_counts counts{sizeof counts, 0, 0, 0};
            if (gim_mesh_size(bytes, size, &limits, flags, level, work.data(), work.size(), &counts) !=
                GIM_OK)
                std::abort();
            std::vector<std::uint32_t> vertices(counts.vertices),
                triangles(3 * std::size_t{counts.triangles});
            if (gim_build_mesh(bytes, size, &limits, flags, level, work.data(), work.size(), xyz.data(),
                               nullptr, vertices.data(), triangles.data()) != GIM_OK)
                std::abort();
            for (const std::uint32_t v : triangles)
                if (v >= counts.vertices) std::abort();
            for (const std::uint32_t s : vertices)
                if (s >= xyz.size() / 3) std::abort();
            std::vector<float> normals(xyz.size());
            if (gim_estimate_normals(bytes, size, &limits, flags, level, work.data(), work.size(), xyz.data(),
                                     normals.data()) != GIM_OK)
                std::abort();
            for (const std::uint32_t s : vertices) {
                const float *n = &normals[3 * std::size_t{s}],
                            length = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
                if (!(length > 0.999f && length < 1.001f)) std::abort();
            }
        }
    }
    if (info.normal_grid != 0) {
        std::vector<float> normals(3 * std::size_t{info.normal_grid} * info.normal_grid);
        const gim_status decoded =
            gim_decode_normals(bytes, size, &limits, prefix, work.data(), work.size(), normals.data());
        if (decoded == GIM_MISUSE) std::abort();
    }
    for (std::uint32_t k = 0; k < info.attributes; ++k) {
        gim_attribute attribute{};
        attribute.size = sizeof attribute;
        if (gim_read_attribute(bytes, size, &limits, k, &attribute) != GIM_OK) std::abort();
        if (attribute.channels > GIM_MAX_CHANNELS || attribute.decoded_bytes > std::uint64_t{1} << 26)
            std::abort();
        std::vector<unsigned char> samples(attribute.decoded_bytes);
        if (gim_decode_attribute(bytes, size, &limits, k, work.data(), work.size(), samples.data()) ==
            GIM_MISUSE)
            std::abort();
    }
    return GIM_OK;
}

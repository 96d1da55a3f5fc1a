#include "gim.h"

#include "arena.h"
#include "attribute_header.h"
#include "border.h"
#include "format/container.h"
#include "image_header.h"
#include "range_decoder.h"
#include "seam_code.h"
#include "surface_normals.h"
#include "triangulate.h"

#include <cstring>

namespace {

using namespace gimg::codec;
using gimg::format::ByteSpan;
using gimg::format::Chunk;
using gimg::format::ChunkWalk;
using gimg::format::Contents;

gim_status toPublic(ReadStatus status) { return static_cast<gim_status>(status); }

static_assert(static_cast<int>(ReadStatus::Ok) == GIM_OK);
static_assert(static_cast<int>(ReadStatus::MoreInput) == GIM_MORE_INPUT);
static_assert(static_cast<int>(ReadStatus::Corrupt) == GIM_CORRUPT);
static_assert(static_cast<int>(ReadStatus::Unsupported) == GIM_UNSUPPORTED);
static_assert(static_cast<int>(ReadStatus::Limit) == GIM_LIMIT);
static_assert(static_cast<int>(ReadStatus::Misuse) == GIM_MISUSE);

constexpr std::uint32_t kDefaultGrid = 4097;
constexpr std::uint32_t kDefaultSides = 16384;
constexpr std::uint64_t kDefaultWorkspace = std::uint64_t{1} << 31;

bool readLimits(const gim_limits* given, gim_limits* limits)
{
    *limits = {sizeof(gim_limits), kDefaultGrid, kDefaultSides, kDefaultWorkspace};
    if (given == nullptr) return true;
    if (given->size < sizeof(gim_limits)) return false;
    if (given->max_grid != 0) limits->max_grid = given->max_grid;
    if (given->max_sides != 0) limits->max_sides = given->max_sides;
    if (given->max_workspace != 0) limits->max_workspace = given->max_workspace;
    return true;
}

/// A file whose headers are sound and within the limits.
struct File
{
    Contents contents;
    gim_limits limits{};
    std::uint32_t lowest = 0;
    std::uint32_t levels = 0;
    ByteSpan word; ///< the coded seam
    ImageHeader geometry;
    ImageHeader normals; ///< grid 0: absent
    AttributeHeader attributes[gimg::format::kMaxAttributes];
    std::uint32_t attributeCount = 0;
    std::uint32_t widest = 0; ///< samples a side of the largest image
    std::uint64_t workspace = 0;

    std::uint32_t maxSides() const
    {
        const std::uint32_t room = borderSize(lowest);
        return room < limits.max_sides ? room : limits.max_sides;
    }
};

constexpr std::size_t kSeamFixedBytes = 1;
constexpr std::uint32_t kKnownFlags = GIM_NO_FUSE | GIM_NO_DIFFUSE | GIM_PREFIX;

// Seam, its scratch, and what of the rest is largest.
std::uint64_t workspaceOf(const File& file)
{
    const std::size_t sides = file.maxSides();
    const std::uint32_t grid = file.geometry.grid;
    const std::uint64_t seam = Arena::sizeOf<gim_side>(sides) + Arena::sizeOf<std::uint32_t>(2 * sides) +
                               Arena::sizeOf<std::uint32_t>(borderSize(file.widest));
    const std::uint64_t mesh = Arena::sizeOf<std::uint32_t>(borderSize(grid)) +
                               Arena::sizeOf<std::uint32_t>(std::size_t{grid} * grid);
    std::uint64_t most = Arena::sizeOf<double>(normalScratch(grid));
    if (mesh > most) most = mesh;
    const std::uint64_t geometry = imageWorkspace(file.geometry);
    const std::uint64_t normals = file.normals.grid != 0 ? imageWorkspace(file.normals) : 0;
    if (geometry > most) most = geometry;
    if (normals > most) most = normals;
    for (std::uint32_t k = 0; k < file.attributeCount; ++k) {
        const std::uint64_t attribute = attributeWorkspace(file.attributes[k]);
        if (attribute > most) most = attribute;
    }
    return seam + most + Arena::kAlignment;
}

bool areEqual(ByteSpan a, ByteSpan b) { return a.size == b.size && std::memcmp(a.data, b.data, a.size) == 0; }

ReadStatus readAttributes(File* file)
{
    file->attributeCount = file->contents.attributeCount;
    for (std::uint32_t k = 0; k < file->attributeCount; ++k) {
        AttributeHeader& attribute = file->attributes[k];
        const ReadStatus status = readAttributeHeader(file->contents.attributes[k].content, &attribute);
        if (status != ReadStatus::Ok) return status;
        for (std::uint32_t before = 0; before < k; ++before)
            if (areEqual(file->attributes[before].name, attribute.name)) return ReadStatus::Corrupt;
        if (attribute.image.grid > file->widest) file->widest = attribute.image.grid;
    }
    return ReadStatus::Ok;
}

/// @param allowPrefix  a file that is cut short will do, if its geometry can be decoded as far as it goes
ReadStatus openFile(const void* bytes, std::size_t size, const gim_limits* limits, bool allowPrefix,
                    File* file)
{
    if ((bytes == nullptr && size > 0) || !readLimits(limits, &file->limits)) return ReadStatus::Misuse;
    ReadStatus status =
        readContents({static_cast<const std::uint8_t*>(bytes), size}, allowPrefix, &file->contents);
    if (status != ReadStatus::Ok) return status;

    status = readImageHeader(file->contents.geometry.content, ImageKind::Geometry, &file->geometry);
    const std::size_t missing = file->contents.geometry.missing;
    if (status == ReadStatus::Corrupt && missing > 0) return ReadStatus::MoreInput;
    if (status != ReadStatus::Ok) return status;
    if (missing > 0 && file->geometry.coding != GIM_CODING_SURFACE) return ReadStatus::MoreInput;
    file->geometry.isPrefix = missing > 0;
    if (file->contents.normals.type != 0) {
        status = readImageHeader(file->contents.normals.content, ImageKind::Normals, &file->normals);
        if (status != ReadStatus::Ok) return status;
    }

    file->widest = file->normals.grid > file->geometry.grid ? file->normals.grid : file->geometry.grid;
    status = readAttributes(file);
    if (status != ReadStatus::Ok) return status;

    gimg::format::Reader in(file->contents.seam.content);
    const std::uint8_t exponent = in.u8();
    if (in.failed() || exponent == 0) return ReadStatus::Corrupt;
    if (exponent > kLargestExponent) return ReadStatus::Unsupported;
    file->lowest = (1u << exponent) + 1;
    file->word = in.span(in.remaining());
    if (file->lowest > file->geometry.grid) return ReadStatus::Corrupt;
    if (file->normals.grid != 0 && file->lowest > file->normals.grid) return ReadStatus::Corrupt;
    for (std::uint32_t k = 0; k < file->attributeCount; ++k)
        if (file->lowest > file->attributes[k].image.grid) return ReadStatus::Corrupt;
    for (std::uint32_t n = file->geometry.grid; n >= file->lowest; n = n / 2 + 1) {
        ++file->levels;
        if (n == 3) break;
    }

    if (file->widest > file->limits.max_grid) return ReadStatus::Limit;
    file->workspace = workspaceOf(*file);
    if (file->workspace > file->limits.max_workspace || file->workspace > SIZE_MAX) return ReadStatus::Limit;
    return ReadStatus::Ok;
}

/// Decodes the seam into the arena.
/// @param scratch  receives 2 maxSides() entries of scratch
ReadStatus readSeam(const File& file, Arena& arena, SeamView* seam, std::uint32_t** scratch)
{
    const std::uint32_t capacity = file.maxSides();
    auto* sides = arena.take<gim_side>(capacity);
    *scratch = arena.take<std::uint32_t>(2 * std::size_t{capacity});
    if (sides == nullptr || *scratch == nullptr) return ReadStatus::Misuse;
    RangeDecoder decoder(file.word);
    seam->lowest = file.lowest;
    if (!codeSeam(decoder, *seam, sides, capacity, *scratch)) return ReadStatus::Limit;
    return decoder.finished() ? ReadStatus::Ok : ReadStatus::Corrupt;
}

/// Decodes the seam and the classes of a grid's border.
ReadStatus readClasses(const File& file, std::uint32_t grid, Arena& arena, SeamView* seam,
                       const std::uint32_t** classes)
{
    std::uint32_t* scratch = nullptr;
    const ReadStatus status = readSeam(file, arena, seam, &scratch);
    if (status != ReadStatus::Ok) return status;
    auto* out = arena.take<std::uint32_t>(borderSize(grid));
    if (out == nullptr) return ReadStatus::Misuse;
    borderClasses(*seam, grid, scratch, out);
    *classes = out;
    return ReadStatus::Ok;
}

ReadStatus decode(const File& file, const ImageHeader& header, std::uint32_t flags, void* workspace,
                  std::size_t workspaceSize, float* out)
{
    if (workspace == nullptr || out == nullptr || workspaceSize < file.workspace) return ReadStatus::Misuse;
    if ((flags & ~kKnownFlags) != 0) return ReadStatus::Misuse;
    Arena arena(workspace, workspaceSize);
    SeamView seam;
    const std::uint32_t* classes = nullptr;
    const ReadStatus status = readClasses(file, header.grid, arena, &seam, &classes);
    if (status != ReadStatus::Ok) return status;
    return decodeImage(header, seam, classes, flags, arena, out);
}

/// A level of detail, with the classes of its border.
struct Level
{
    std::uint32_t grid = 0;
    std::uint32_t stride = 0;
    const std::uint32_t* classes = nullptr; ///< nullptr: not fused
    std::uint32_t vertices = 0;
};

ReadStatus openLevel(const File& file, std::uint32_t flags, std::uint32_t level, Arena& arena, Level* out)
{
    if ((flags & ~kKnownFlags) != 0 || level >= file.levels) return ReadStatus::Misuse;
    out->stride = 1u << level;
    out->grid = (file.geometry.grid - 1) / out->stride + 1;
    SeamView seam;
    const ReadStatus status = readClasses(file, out->grid, arena, &seam, &out->classes);
    if (status != ReadStatus::Ok) return status;
    const std::uint32_t samples = out->grid * out->grid, border = borderSize(out->grid);
    if ((flags & GIM_NO_FUSE) != 0) out->classes = nullptr;
    out->vertices = out->classes == nullptr ? samples : samples - border + countClasses(out->classes, border);
    return ReadStatus::Ok;
}

/// The file and a level of it, with all the workspace that the file asks for.
ReadStatus openFileAndLevel(const void* bytes, std::size_t size, const gim_limits* limits,
                            std::uint32_t flags, std::uint32_t level, std::size_t workspaceSize, Arena& arena,
                            File* file, Level* out)
{
    const ReadStatus status = openFile(bytes, size, limits, (flags & GIM_PREFIX) != 0, file);
    if (status != ReadStatus::Ok) return status;
    if (workspaceSize < file->workspace) return ReadStatus::Misuse;
    return openLevel(*file, flags, level, arena, out);
}

} // namespace

extern "C" {

const char* gim_status_text(gim_status status)
{
    switch (status) {
    case GIM_OK:
        return "no error";
    case GIM_MORE_INPUT:
        return "the file is cut short";
    case GIM_CORRUPT:
        return "the file is damaged or is not a .gim file";
    case GIM_UNSUPPORTED:
        return "the file needs a newer version of this reader";
    case GIM_LIMIT:
        return "the file exceeds the limits set for it";
    case GIM_MISUSE:
        return "the decoder was called with a wrong argument";
    }
    return "unknown status";
}

gim_status gim_probe(const void* bytes, size_t size, const gim_limits* limits, gim_info* info)
{
    if (info == nullptr || info->size < sizeof(gim_info)) return GIM_MISUSE;
    *info = {};
    info->size = sizeof *info;
    File file;
    const ReadStatus status = openFile(bytes, size, limits, true, &file);
    if (status != ReadStatus::Ok) return toPublic(status);
    const Contents& contents = file.contents;
    info->version = gimg::format::kVersion;
    info->grid = file.geometry.grid;
    info->lowest = file.lowest;
    info->levels = file.levels;
    info->coding = file.geometry.coding;
    info->step = file.geometry.step;
    info->normal_grid = file.normals.grid;
    info->normal_coding = file.normals.coding;
    info->normal_step = file.normals.step;
    info->chunks = contents.chunks;
    info->seam_bytes = contents.seam.content.size - kSeamFixedBytes;
    info->geometry_bytes = file.geometry.samples.size;
    info->normal_bytes = file.normals.samples.size;
    info->other_bytes = contents.otherBytes;
    info->attributes = file.attributeCount;
    info->attribute_bytes = 0;
    for (std::uint32_t k = 0; k < file.attributeCount; ++k)
        info->attribute_bytes += file.attributes[k].image.samples.size;
    info->container_bytes = size - info->seam_bytes - info->geometry_bytes - info->normal_bytes -
                            info->attribute_bytes - info->other_bytes;
    info->workspace = file.workspace;
    info->missing_bytes = contents.geometry.missing;
    return contents.isPrefix ? GIM_MORE_INPUT : GIM_OK;
}

size_t gim_workspace_size(const gim_info* info)
{
    return info == nullptr ? 0 : static_cast<size_t>(info->workspace);
}

gim_status gim_read_chunk(const void* bytes, size_t size, uint32_t index, gim_chunk* chunk)
{
    if ((bytes == nullptr && size > 0) || chunk == nullptr || chunk->size < sizeof(gim_chunk))
        return GIM_MISUSE;
    ChunkWalk walk({static_cast<const std::uint8_t*>(bytes), size});
    ReadStatus status = walk.open();
    if (status != ReadStatus::Ok) return toPublic(status);
    if (index >= walk.count()) return GIM_MISUSE;
    Chunk found;
    for (uint32_t k = 0; k <= index; ++k) {
        status = walk.next(&found);
        if (status != ReadStatus::Ok) return toPublic(status);
    }
    chunk->type = static_cast<char>(found.type);
    chunk->offset = found.offset;
    chunk->length = found.content.size;
    chunk->total = found.total;
    return GIM_OK;
}

gim_status gim_read_seam(const void* bytes, size_t size, const gim_limits* limits, void* workspace,
                         size_t workspace_size, gim_seam* out, gim_side* sides, uint32_t capacity)
{
    if (workspace == nullptr || out == nullptr || out->size < sizeof(gim_seam)) return GIM_MISUSE;
    if (sides == nullptr && capacity != 0) return GIM_MISUSE;
    File file;
    ReadStatus status = openFile(bytes, size, limits, true, &file);
    if (status != ReadStatus::Ok) return toPublic(status);
    Arena arena(workspace, workspace_size);
    SeamView seam;
    std::uint32_t* scratch = nullptr;
    status = readSeam(file, arena, &seam, &scratch);
    if (status != ReadStatus::Ok) return toPublic(status);
    const Topology topology = seamTopology(seam, scratch);
    out->start = seam.start;
    out->sides = seam.count;
    out->paths = topology.paths;
    out->cut_nodes = topology.cutNodes;
    out->genus = topology.genus;
    out->boundary_loops = topology.loops;
    if (sides == nullptr) return GIM_OK;
    if (capacity < seam.count) return GIM_MISUSE;
    for (std::uint32_t s = 0; s < seam.count; ++s) sides[s] = seam.sides[s];
    return GIM_OK;
}

gim_status gim_decode_geometry(const void* bytes, size_t size, const gim_limits* limits, uint32_t flags,
                               void* workspace, size_t workspace_size, float* xyz)
{
    File file;
    const ReadStatus status = openFile(bytes, size, limits, (flags & GIM_PREFIX) != 0, &file);
    if (status != ReadStatus::Ok) return toPublic(status);
    return toPublic(decode(file, file.geometry, flags, workspace, workspace_size, xyz));
}

gim_status gim_decode_normals(const void* bytes, size_t size, const gim_limits* limits, uint32_t flags,
                              void* workspace, size_t workspace_size, float* normals)
{
    File file;
    ReadStatus status = openFile(bytes, size, limits, (flags & GIM_PREFIX) != 0, &file);
    if (status != ReadStatus::Ok) return toPublic(status);
    if (file.normals.grid == 0) return GIM_MISUSE;
    status = decode(file, file.normals, flags, workspace, workspace_size, normals);
    if (status == ReadStatus::Ok && file.normals.coding != GIM_CODING_FLOAT)
        normalize(normals, std::size_t{file.normals.grid} * file.normals.grid);
    return toPublic(status);
}

gim_status gim_estimate_normals(const void* bytes, size_t size, const gim_limits* limits, uint32_t flags,
                                uint32_t level, void* workspace, size_t workspace_size, const float* xyz,
                                float* normals)
{
    if (workspace == nullptr || xyz == nullptr || normals == nullptr) return GIM_MISUSE;
    Arena arena(workspace, workspace_size);
    File file;
    Level open;
    const ReadStatus status =
        openFileAndLevel(bytes, size, limits, flags, level, workspace_size, arena, &file, &open);
    if (status != ReadStatus::Ok) return toPublic(status);
    auto* scratch = arena.take<double>(normalScratch(open.grid));
    if (scratch == nullptr) return GIM_MISUSE;
    estimateNormals(open.grid, open.stride, file.geometry.grid, xyz, open.classes, scratch, normals);
    return GIM_OK;
}

gim_status gim_read_attribute(const void* bytes, size_t size, const gim_limits* limits, uint32_t index,
                              gim_attribute* out)
{
    if (out == nullptr || out->size < sizeof(gim_attribute)) return GIM_MISUSE;
    File file;
    const ReadStatus status = openFile(bytes, size, limits, true, &file);
    if (status != ReadStatus::Ok) return toPublic(status);
    if (index >= file.attributeCount) return GIM_MISUSE;
    const AttributeHeader& attribute = file.attributes[index];
    std::memset(out->name, 0, sizeof out->name);
    std::memcpy(out->name, attribute.name.data, attribute.name.size);
    out->grid = attribute.image.grid;
    out->channels = attribute.channels;
    out->type = attribute.type;
    out->coding = attribute.image.coding;
    out->step = attribute.image.step;
    out->glued = attribute.glued ? 1 : 0;
    out->normalized = attribute.normalized ? 1 : 0;
    out->coded_bytes = attribute.image.samples.size;
    out->decoded_bytes = std::uint64_t{attribute.image.grid} * attribute.image.grid * attribute.channels *
                         sampleSize(attribute.type);
    return GIM_OK;
}

gim_status gim_decode_attribute(const void* bytes, size_t size, const gim_limits* limits, uint32_t index,
                                void* workspace, size_t workspace_size, void* samples)
{
    File file;
    ReadStatus status = openFile(bytes, size, limits, true, &file);
    if (status != ReadStatus::Ok) return toPublic(status);
    if (index >= file.attributeCount || workspace == nullptr || samples == nullptr ||
        workspace_size < file.workspace)
        return GIM_MISUSE;
    const AttributeHeader& attribute = file.attributes[index];
    Arena arena(workspace, workspace_size);
    SeamView seam;
    const std::uint32_t* classes = nullptr;
    status = readClasses(file, attribute.image.grid, arena, &seam, &classes);
    if (status != ReadStatus::Ok) return toPublic(status);
    return toPublic(decodeAttribute(attribute, seam, classes, arena, samples));
}

gim_status gim_mesh_size(const void* bytes, size_t size, const gim_limits* limits, uint32_t flags,
                         uint32_t level, void* workspace, size_t workspace_size, gim_mesh_counts* counts)
{
    if (workspace == nullptr || counts == nullptr || counts->size < sizeof(gim_mesh_counts))
        return GIM_MISUSE;
    File file;
    ReadStatus status = openFile(bytes, size, limits, (flags & GIM_PREFIX) != 0, &file);
    if (status != ReadStatus::Ok) return toPublic(status);
    Arena arena(workspace, workspace_size);
    Level open;
    status = openLevel(file, flags, level, arena, &open);
    if (status != ReadStatus::Ok) return toPublic(status);
    counts->grid = open.grid;
    counts->vertices = open.vertices;
    counts->triangles = 2 * (open.grid - 1) * (open.grid - 1);
    return GIM_OK;
}

gim_status gim_build_mesh(const void* bytes, size_t size, const gim_limits* limits, uint32_t flags,
                          uint32_t level, void* workspace, size_t workspace_size, const float* xyz,
                          uint32_t* vertex_of_sample, uint32_t* sample_of_vertex, uint32_t* triangles)
{
    if (workspace == nullptr || (xyz == nullptr && triangles != nullptr)) return GIM_MISUSE;
    Arena arena(workspace, workspace_size);
    File file;
    Level open;
    const ReadStatus status =
        openFileAndLevel(bytes, size, limits, flags, level, workspace_size, arena, &file, &open);
    if (status != ReadStatus::Ok) return toPublic(status);
    auto* scratch = arena.take<std::uint32_t>(borderSize(open.grid));
    if (vertex_of_sample == nullptr)
        vertex_of_sample = arena.take<std::uint32_t>(std::size_t{open.grid} * open.grid);
    if (scratch == nullptr || vertex_of_sample == nullptr) return GIM_MISUSE;
    numberVertices(open.grid, open.stride, file.geometry.grid, open.classes, scratch, vertex_of_sample,
                   sample_of_vertex);
    if (triangles != nullptr)
        triangulate(open.grid, open.stride, file.geometry.grid, xyz, vertex_of_sample, triangles);
    return GIM_OK;
}

} // extern "C"

#include "meshopt_codec.h"

#include <meshoptimizer.h>
#include <zstd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

namespace gimg::adapter {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kZstdLevel = 19;
constexpr int kTimedBits = 12;

/// meshoptimizer codes vertices in multiples of four bytes; the fourth number stays 0 and costs next to
/// nothing.
struct Vertex
{
    std::uint16_t position[3];
    std::uint16_t padding;
};

/// What a file begins with; the rest is one zstd frame of the coded vertices and the coded indices.
struct Header
{
    float low[3];
    float step; ///< a unit of the whole numbers
    std::uint32_t vertices, triangles, vertexBytes;
};

struct Arrays
{
    std::vector<Vertex> vertices;
    std::vector<unsigned> indices;
};

Error failure(const std::string& what) { return {ErrorKind::CodecFailure, "meshoptimizer: " + what}; }

// The largest extent is `bits` bits long, as in Draco.
Arrays quantized(const Mesh& mesh, int bits, Header& header)
{
    Eigen::AlignedBox3d box;
    for (const Vec3& p : mesh.positions) box.extend(p);
    const double step = box.sizes().maxCoeff() / (std::ldexp(1.0, bits) - 1);
    for (int c = 0; c < 3; ++c) header.low[c] = static_cast<float>(box.min()[c]);
    header.step = static_cast<float>(step);
    Arrays arrays;
    for (const Vec3& p : mesh.positions) {
        Vertex vertex{};
        for (int c = 0; c < 3; ++c)
            vertex.position[c] =
                static_cast<std::uint16_t>(step > 0 ? std::lround((p[c] - box.min()[c]) / step) : 0);
        arrays.vertices.push_back(vertex);
    }
    for (const Triangle& face : mesh.faces)
        for (const int v : face) arrays.indices.push_back(static_cast<unsigned>(v));
    return arrays;
}

// In the order that meshoptimizer codes best.
void reorder(Arrays& arrays)
{
    std::vector<unsigned>& indices = arrays.indices;
    meshopt_optimizeVertexCacheStrip(indices.data(), indices.data(), indices.size(), arrays.vertices.size());
    arrays.vertices.resize(meshopt_optimizeVertexFetch(arrays.vertices.data(), indices.data(), indices.size(),
                                                       arrays.vertices.data(), arrays.vertices.size(),
                                                       sizeof(Vertex)));
}

Result<Bytes> packed(const Header& header, const Bytes& coded)
{
    Bytes file(sizeof header + ZSTD_compressBound(coded.size()));
    std::memcpy(file.data(), &header, sizeof header);
    const std::size_t size = ZSTD_compress(file.data() + sizeof header, file.size() - sizeof header,
                                           coded.data(), coded.size(), kZstdLevel);
    if (ZSTD_isError(size) != 0) return failure(ZSTD_getErrorName(size));
    file.resize(sizeof header + size);
    return file;
}

Result<Bytes> encodeMeshopt(const Mesh& mesh, int bits)
{
    Header header{};
    Arrays arrays = quantized(mesh, bits, header);
    reorder(arrays);
    const std::size_t vertices = arrays.vertices.size(), indices = arrays.indices.size();
    Bytes coded(meshopt_encodeVertexBufferBound(vertices, sizeof(Vertex)) +
                meshopt_encodeIndexBufferBound(indices, vertices));
    const std::size_t vertexBytes = meshopt_encodeVertexBuffer(
        coded.data(), coded.size(), arrays.vertices.data(), vertices, sizeof(Vertex));
    const std::size_t indexBytes = meshopt_encodeIndexBuffer(
        coded.data() + vertexBytes, coded.size() - vertexBytes, arrays.indices.data(), indices);
    if (vertexBytes == 0 || indexBytes == 0) return failure("encoding failed");
    coded.resize(vertexBytes + indexBytes);
    header.vertices = static_cast<std::uint32_t>(vertices);
    header.triangles = static_cast<std::uint32_t>(indices / 3);
    header.vertexBytes = static_cast<std::uint32_t>(vertexBytes);
    return packed(header, coded);
}

Result<Arrays> decodeArrays(const Bytes& file, Header& header)
{
    if (file.size() < sizeof header) return failure("a file without header");
    std::memcpy(&header, file.data(), sizeof header);
    const std::uint8_t* frame = file.data() + sizeof header;
    const std::size_t frameBytes = file.size() - sizeof header;
    Bytes coded(ZSTD_getFrameContentSize(frame, frameBytes));
    if (ZSTD_isError(ZSTD_decompress(coded.data(), coded.size(), frame, frameBytes)) != 0)
        return failure("zstd cannot unpack the file");
    Arrays arrays;
    arrays.vertices.resize(header.vertices);
    arrays.indices.resize(std::size_t{3} * header.triangles);
    if (meshopt_decodeVertexBuffer(arrays.vertices.data(), header.vertices, sizeof(Vertex), coded.data(),
                                   header.vertexBytes) != 0 ||
        meshopt_decodeIndexBuffer(arrays.indices.data(), arrays.indices.size(), sizeof(unsigned),
                                  coded.data() + header.vertexBytes, coded.size() - header.vertexBytes) != 0)
        return failure("decoding failed");
    return arrays;
}

Result<Mesh> decodeMeshopt(const Bytes& file)
{
    Header header{};
    const Result<Arrays> arrays = decodeArrays(file, header);
    if (!arrays) return arrays.error();
    Mesh mesh;
    for (const Vertex& vertex : arrays->vertices) {
        Vec3 p;
        for (int c = 0; c < 3; ++c)
            p[c] = static_cast<float>(header.low[c] + double{header.step} * vertex.position[c]);
        mesh.positions.push_back(p);
    }
    for (std::size_t i = 0; i + 2 < arrays->indices.size(); i += 3)
        mesh.faces.push_back({static_cast<int>(arrays->indices[i]), static_cast<int>(arrays->indices[i + 1]),
                              static_cast<int>(arrays->indices[i + 2])});
    return mesh;
}

} // namespace

MeshCodec meshoptCodec() { return {"mopt", 4, 16, encodeMeshopt, decodeMeshopt}; }

Result<Times> timeMeshopt(const Mesh& mesh, int runs)
{
    const Mesh whole = referenced(mesh);
    return timeRuns(
        runs, [&] { return encodeMeshopt(whole, kTimedBits); },
        [](const Bytes& file) -> Status {
            Header header{};
            const Result<Arrays> arrays = decodeArrays(file, header);
            if (!arrays) return arrays.error();
            return Done{};
        });
}

} // namespace gimg::adapter

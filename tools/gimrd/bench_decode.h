#pragma once

#include "gimg/mesh.h"
#include "gimg/result.h"

#include <gim.h>

#include <cstdint>
#include <vector>

namespace gimg::gimrd {

/// Milliseconds from bytes in memory until the named things are there, each with all before it.
struct DecodeTimes
{
    double samples = 0;   ///< the fused geometry image
    double positions = 0; ///< a position for each vertex, and the triangles
    double all = 0;       ///< and a normal for each vertex, or the file's normal image if it has one
};

/// Decodes a .gim file as an engine would: the finest level by the C interface, into memory that is there.
class GimDecoder
{
public:
    /// Allocates all memory that decoding needs. Errors: CodecFailure.
    static Result<GimDecoder> open(std::vector<std::uint8_t> file);

    /// Decodes once. Errors: CodecFailure.
    Result<DecodeTimes> run();

    const gim_info& info() const { return info_; }
    const gim_mesh_counts& counts() const { return counts_; }
    /// What the C interface writes: samples, the vertices' samples, triangles, and a normal image.
    std::size_t outputBytes() const;
    /// What run() decoded last.
    Mesh mesh() const;

private:
    gim_status decodeSamples();
    gim_status buildMesh();
    gim_status findNormals();

    std::vector<std::uint8_t> file_;
    gim_info info_{};
    gim_mesh_counts counts_{};
    std::vector<unsigned char> workspace_;
    std::vector<float> xyz_, positions_, normals_;
    std::vector<std::uint32_t> sampleOfVertex_, triangles_;
};

} // namespace gimg::gimrd

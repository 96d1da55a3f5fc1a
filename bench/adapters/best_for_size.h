#pragma once

#include "adapter.h"
#include "ladder.h"

namespace gimg::adapter {

/// A mesh coder with one parameter besides the mesh: the bits of a coordinate.
struct MeshCodec
{
    std::string extension;
    int fewestBits = 4, mostBits = 16;
    std::function<Result<std::vector<std::uint8_t>>(const Mesh&, int bits)> encode;
    std::function<Result<Mesh>(const std::vector<std::uint8_t>&)> decode;
};

/// For each size the file of the highest surface PSNR against rung 0 among all rungs and numbers of bits that
/// are not larger, what Adapter::encode is to do. The search: for a number of bits, the most triangles that
/// fit; over the bits, uphill from where the size below left off; the three best once more with the meshes
/// between two rungs and more samples. The whole mesh takes part with the most bits that fit.
Status bestForSizes(Ladder& ladder, const MeshCodec& codec, const std::vector<std::size_t>& sizes,
                    int threads, const std::function<void(std::size_t size, Result<Coded>)>& done);

/// Runs a coder in this process, what Adapter::time is to do.
Result<Times> timeRuns(int runs, const std::function<Result<std::vector<std::uint8_t>>()>& encode,
                       const std::function<Status(const std::vector<std::uint8_t>&)>& decode);

} // namespace gimg::adapter

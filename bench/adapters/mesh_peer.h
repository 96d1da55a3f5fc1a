#pragma once

#include "adapter.h"
#include "best_for_size.h"
#include "ladder.h"

namespace gimg::adapter {

/// What makes a peer that simplifies the mesh and codes what is left.
struct MeshPeer
{
    Description description;
    std::function<Result<std::unique_ptr<Ladder>>(const Mesh&, std::size_t mostTriangles)> simplify;
    MeshCodec codec;
    std::function<Result<Times>(const Mesh&, int runs)> time;
};

std::unique_ptr<Adapter> makeMeshPeer(MeshPeer peer);

/// The adapter of a coder that was not found when this was built: it has its description, and
/// `missing` filled, and codes nothing.
std::unique_ptr<Adapter> makeMissing(Description description, std::vector<std::string> missing);

} // namespace gimg::adapter

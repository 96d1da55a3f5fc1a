#pragma once

#include "gimg/mesh.h"
#include "gimg/result.h"

#include <optional>
#include <string>

namespace gimg {

/// What keeps the triangles of a mesh from being looked at: none (EmptyMesh), an index out of range
/// (BadArgument), or a vertex of a face that is not finite (NotFinite).
/// @param name  of the mesh in the message, "the test mesh"
std::optional<Error> objectionToTriangles(const Mesh& mesh, const std::string& name);

} // namespace gimg

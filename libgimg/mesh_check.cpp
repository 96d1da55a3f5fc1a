#include "mesh_check.h"

namespace gimg {

std::optional<Error> objectionToTriangles(const Mesh& mesh, const std::string& name)
{
    if (mesh.faces.empty()) return Error{ErrorKind::EmptyMesh, name + " has no faces"};
    for (size_t f = 0; f < mesh.faces.size(); ++f)
        for (int v : mesh.faces[f]) {
            if (v < 0 || v >= mesh.vertexCount())
                return Error{ErrorKind::BadArgument, name + ": face " + std::to_string(f) + " names vertex " +
                                                         std::to_string(v) + " of " +
                                                         std::to_string(mesh.vertexCount())};
            if (!mesh.positions[v].allFinite())
                return Error{ErrorKind::NotFinite, name + ": vertex " + std::to_string(v) + " is not finite"};
        }
    return std::nullopt;
}

} // namespace gimg

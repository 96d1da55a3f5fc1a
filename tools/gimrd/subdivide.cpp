#include "subdivide.h"

namespace gimg::gimrd {

Mesh subdivide(const Mesh& mesh)
{
    const Halfedges halfedges(mesh.faces, mesh.vertexCount());
    Mesh fine;
    fine.positions = mesh.positions;
    std::vector<int> middle(static_cast<size_t>(halfedges.count()));
    for (int h = 0; h < halfedges.count(); ++h) {
        const int twin = halfedges.twin(h);
        if (twin >= 0 && twin < h) {
            middle[h] = middle[twin];
            continue;
        }
        middle[h] = fine.vertexCount();
        fine.positions.push_back(0.5 *
                                 (mesh.positions[halfedges.tail(h)] + mesh.positions[halfedges.head(h)]));
    }
    fine.faces.reserve(4 * mesh.faces.size());
    for (int f = 0; f < mesh.faceCount(); ++f) {
        const Triangle& corner = mesh.faces[f];
        const int ab = middle[3 * f], bc = middle[3 * f + 1], ca = middle[3 * f + 2];
        fine.faces.push_back({corner[0], ab, ca});
        fine.faces.push_back({ab, corner[1], bc});
        fine.faces.push_back({ca, bc, corner[2]});
        fine.faces.push_back({ab, bc, ca});
    }
    return fine;
}

} // namespace gimg::gimrd

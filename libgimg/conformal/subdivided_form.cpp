#include "gimg/handle_separation.h"

namespace gimg {

SubdividedForm subdivided(const Mesh& mesh, const ComplexOneForm& form)
{
    const Halfedges he(mesh.faces, mesh.vertexCount());
    SubdividedForm fine{{mesh.positions, {}}, ComplexOneForm(4 * form.size())};
    std::vector<int> middle(static_cast<size_t>(he.count()), -1);
    for (int h = 0; h < he.count(); ++h) {
        if (middle[h] >= 0) continue;
        middle[h] = fine.mesh.vertexCount();
        if (!he.onBoundary(h)) middle[he.twin(h)] = middle[h];
        fine.mesh.positions.push_back((mesh.positions[he.tail(h)] + mesh.positions[he.head(h)]) / 2);
    }
    for (int f = 0; f < mesh.faceCount(); ++f) {
        const Triangle& t = mesh.faces[f];
        const int *m = &middle[3 * f], h = 3 * f;
        // Halfedges of the parts run along or against those of the face, half as long.
        const auto add = [&](Triangle part, double sign, std::array<int, 3> along) {
            const Eigen::Index at = 3 * fine.mesh.faceCount();
            fine.mesh.faces.push_back(part);
            for (int k = 0; k < 3; ++k) fine.form[at + k] = sign / 2 * form[h + along[k]];
        };
        add({t[0], m[0], m[2]}, 1, {0, 1, 2});
        add({m[0], t[1], m[1]}, 1, {0, 1, 2});
        add({m[2], m[1], t[2]}, 1, {0, 1, 2});
        add({m[0], m[1], m[2]}, -1, {2, 0, 1});
    }
    return fine;
}

} // namespace gimg

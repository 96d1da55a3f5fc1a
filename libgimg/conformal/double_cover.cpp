#include "gimg/double_cover.h"

#include <algorithm>
#include <string>

namespace gimg {
namespace {

std::vector<bool> boundaryVertices(const Halfedges& he, int vertexCount)
{
    std::vector<bool> boundary(static_cast<size_t>(vertexCount), false);
    for (int h = 0; h < he.count(); ++h)
        if (he.onBoundary(h)) boundary[he.tail(h)] = boundary[he.head(h)] = true;
    return boundary;
}

/// Triangles of a face whose marked edges are halved, as corners 0 to 2 and midpoints 3 (of edge 0) to 5.
std::vector<Triangle> splitFace(std::array<bool, 3> marked)
{
    const int count = marked[0] + marked[1] + marked[2];
    if (count == 0) return {{0, 1, 2}};
    if (count == 3) return {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
    // Turn the face so that edge 0 is the marked one, or edges 0 and 1 are the marked ones.
    int turn = 0;
    while (!(marked[turn] && (count == 1 || marked[(turn + 1) % 3]))) ++turn;
    std::vector<Triangle> parts = count == 1 ? std::vector<Triangle>{{0, 3, 2}, {3, 1, 2}}
                                             : std::vector<Triangle>{{3, 1, 4}, {0, 3, 4}, {0, 4, 2}};
    for (Triangle& t : parts)
        for (int& corner : t) corner = corner < 3 ? (corner + turn) % 3 : 3 + (corner - 3 + turn) % 3;
    return parts;
}

/// The surface with its chords halved.
struct SplitSurface
{
    std::vector<Vec3> positions;
    std::vector<Triangle> faces;
    std::vector<int> faceOrigin;
    std::vector<std::array<int, 2>> halfedges; // per halfedge of the surface
};

SplitSurface halveChords(const Mesh& mesh, const Halfedges& he, const std::vector<bool>& boundary)
{
    SplitSurface split{
        mesh.positions, {}, {}, std::vector<std::array<int, 2>>(3 * mesh.faces.size(), {-1, -1})};
    std::vector<int> middle(3 * mesh.faces.size(), -1);
    for (int h = 0; h < he.count(); ++h) {
        if (he.onBoundary(h) || middle[h] >= 0 || !boundary[he.tail(h)] || !boundary[he.head(h)]) continue;
        middle[h] = middle[he.twin(h)] = static_cast<int>(split.positions.size());
        split.positions.push_back((mesh.positions[he.tail(h)] + mesh.positions[he.head(h)]) / 2);
    }
    for (int f = 0; f < mesh.faceCount(); ++f) {
        std::array<int, 6> vertex;
        for (int k = 0; k < 3; ++k) {
            vertex[k] = mesh.faces[f][k];
            vertex[3 + k] = middle[3 * f + k];
        }
        const auto runsAlong = [&](int from, int to) { // edge 0 to 2 and which half of it, else -1
            for (int k = 0; k < 3; ++k) {
                const int end = (k + 1) % 3;
                if (vertex[3 + k] < 0 && from == k && to == end) return 2 * k;
                if (vertex[3 + k] >= 0 && from == k && to == 3 + k) return 2 * k;
                if (vertex[3 + k] >= 0 && from == 3 + k && to == end) return 2 * k + 1;
            }
            return -1;
        };
        for (const Triangle& t : splitFace({vertex[3] >= 0, vertex[4] >= 0, vertex[5] >= 0})) {
            for (int k = 0; k < 3; ++k) {
                const int half = runsAlong(t[k], t[(k + 1) % 3]);
                if (half < 0) continue;
                split.halfedges[3 * f + half / 2][half % 2] = 3 * static_cast<int>(split.faces.size()) + k;
            }
            split.faces.push_back({vertex[t[0]], vertex[t[1]], vertex[t[2]]});
            split.faceOrigin.push_back(f);
        }
    }
    return split;
}

// A face and its mirror face have the same corners in opposite order: 0, 2, 1. So halfedge k of one runs
// against halfedge 2 - k of the other.
std::vector<int> mirrorHalfedges(const Mesh& mesh, const std::vector<int>& mirrorFace)
{
    const Halfedges he(mesh.faces, mesh.vertexCount());
    std::vector<int> mirror(static_cast<size_t>(he.count()));
    for (int h = 0; h < he.count(); ++h) mirror[h] = he.twin(3 * mirrorFace[h / 3] + 2 - h % 3);
    return mirror;
}

} // namespace

Result<DoubleCover> doubleCover(const Mesh& mesh)
{
    const Halfedges he(mesh.faces, mesh.vertexCount());
    for (int f = 0; f < mesh.faceCount(); ++f)
        if (he.onBoundary(3 * f) && he.onBoundary(3 * f + 1) && he.onBoundary(3 * f + 2))
            return Error{ErrorKind::BadArgument, "face " + std::to_string(f) + " is a component of its own"};
    const std::vector<bool> boundary = boundaryVertices(he, mesh.vertexCount());
    if (std::find(boundary.begin(), boundary.end(), true) == boundary.end())
        return Error{ErrorKind::BadArgument, "the surface has no boundary to be doubled along"};

    SplitSurface split = halveChords(mesh, he, boundary);
    DoubleCover cover;
    cover.mesh = {std::move(split.positions), std::move(split.faces)};
    cover.halfedges = std::move(split.halfedges);
    cover.faceOrigin = std::move(split.faceOrigin);

    const int sheetVertices = cover.mesh.vertexCount(), sheetFaces = cover.mesh.faceCount();
    cover.mirror.resize(static_cast<size_t>(sheetVertices));
    for (int v = 0; v < sheetVertices; ++v) {
        const bool seam = v < mesh.vertexCount() && boundary[v];
        cover.mirror[v] = seam ? v : cover.mesh.vertexCount();
        if (seam) continue;
        cover.mesh.positions.push_back(Vec3(cover.mesh.positions[v]));
        cover.mirror.push_back(v);
    }
    for (int f = 0; f < sheetFaces; ++f) {
        const Triangle t = cover.mesh.faces[f];
        cover.mesh.faces.push_back({cover.mirror[t[0]], cover.mirror[t[2]], cover.mirror[t[1]]});
        cover.faceOrigin.push_back(cover.faceOrigin[f]);
    }
    for (int f = 0; f < 2 * sheetFaces; ++f)
        cover.mirrorFace.push_back(f < sheetFaces ? f + sheetFaces : f - sheetFaces);
    cover.mirrorHalfedge = mirrorHalfedges(cover.mesh, cover.mirrorFace);
    return cover;
}

Eigen::VectorXcd restrictToSurface(const DoubleCover& cover, const Eigen::VectorXcd& form)
{
    Eigen::VectorXcd restricted(static_cast<Eigen::Index>(cover.halfedges.size()));
    for (size_t h = 0; h < cover.halfedges.size(); ++h) {
        const auto [first, second] = cover.halfedges[h];
        restricted[static_cast<Eigen::Index>(h)] = form[first] + (second < 0 ? 0.0 : form[second]);
    }
    return restricted;
}

Eigen::VectorXcd symmetricPart(const DoubleCover& cover, const Eigen::VectorXcd& form)
{
    Eigen::VectorXcd part(form.size());
    for (Eigen::Index h = 0; h < form.size(); ++h)
        part[h] = (form[h] + std::conj(form[cover.mirrorHalfedge[static_cast<size_t>(h)]])) / 2.0;
    return part;
}

} // namespace gimg

#include "gimg/mesh.h"

#include <algorithm>
#include <limits>

namespace gimg {

Halfedges::Halfedges(const std::vector<Triangle>& faces, int vertexCount)
    : tail_(3 * faces.size()), twin_(3 * faces.size(), -1), outgoing_(static_cast<size_t>(vertexCount), -1)
{
    struct Key
    {
        uint64_t edge;
        int h;
    };
    std::vector<Key> keys(tail_.size());
    for (size_t f = 0; f < faces.size(); ++f)
        for (int k = 0; k < 3; ++k) tail_[3 * f + k] = faces[f][k];
    for (int h = 0; h < count(); ++h) {
        const int low = std::min(tail(h), head(h)), high = std::max(tail(h), head(h));
        keys[h] = {static_cast<uint64_t>(low) << 32 | static_cast<uint32_t>(high), h};
    }
    std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
        return a.edge != b.edge ? a.edge < b.edge : a.h < b.h;
    });
    for (size_t i = 0; i + 1 < keys.size(); ++i) {
        if (keys[i].edge != keys[i + 1].edge) continue;
        twin_[keys[i].h] = keys[i + 1].h;
        twin_[keys[i + 1].h] = keys[i].h;
        ++i;
    }
    for (int h = 0; h < count(); ++h)
        if (outgoing_[tail(h)] < 0 || onBoundary(h)) outgoing_[tail(h)] = h;
}

Topology topology(const Mesh& mesh)
{
    const Halfedges he(mesh.faces, mesh.vertexCount());
    Topology t;
    t.faces = mesh.faceCount();
    for (int v = 0; v < mesh.vertexCount(); ++v) t.vertices += he.outgoing(v) >= 0;
    for (int h = 0; h < he.count(); ++h) t.edges += he.onBoundary(h) || h < he.twin(h);

    std::vector<bool> seen(static_cast<size_t>(he.count()), false);
    for (int start = 0; start < he.count(); ++start) {
        if (!he.onBoundary(start) || seen[start]) continue;
        ++t.boundaries;
        for (int h = start; !seen[h];) {
            seen[h] = true;
            h = he.outgoing(he.head(h)); // boundary vertices start at their boundary halfedge
        }
    }
    t.genus = (2 - t.euler() - t.boundaries) / 2;
    return t;
}

double boundingBoxDiagonal(const Mesh& mesh)
{
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 high = -low;
    for (const Triangle& f : mesh.faces)
        for (int v : f) {
            low = low.cwiseMin(mesh.positions[v]);
            high = high.cwiseMax(mesh.positions[v]);
        }
    return mesh.faces.empty() ? 0.0 : (high - low).norm();
}

namespace {
Vec3 doubleAreaNormal(const Mesh& mesh, const Triangle& f)
{
    const Vec3& p = mesh.positions[f[0]];
    return (mesh.positions[f[1]] - p).cross(mesh.positions[f[2]] - p);
}
} // namespace

double surfaceArea(const Mesh& mesh)
{
    double area = 0;
    for (const Triangle& f : mesh.faces) area += 0.5 * doubleAreaNormal(mesh, f).norm();
    return area;
}

std::vector<Vec3> vertexNormals(const Mesh& mesh)
{
    std::vector<Vec3> normals(mesh.positions.size(), Vec3::Zero());
    for (const Triangle& f : mesh.faces) {
        const Vec3 n = doubleAreaNormal(mesh, f);
        for (int v : f) normals[v] += n;
    }
    for (Vec3& n : normals) {
        const double length = n.norm();
        if (length > 0) n /= length;
    }
    return normals;
}

} // namespace gimg

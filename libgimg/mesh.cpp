#include "gimg/mesh.h"

#include <algorithm>
#include <limits>

namespace gimg {

Halfedges::Halfedges(const std::vector<Triangle>& faces, int vertexCount)
    : tail_(3 * faces.size()), twin_(3 * faces.size(), -1), outgoing_(static_cast<size_t>(vertexCount), -1)
{
    std::vector<int> first(static_cast<size_t>(vertexCount) + 1, 0), leaving(tail_.size());
    for (size_t f = 0; f < faces.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            tail_[3 * f + k] = faces[f][k];
            ++first[faces[f][k] + 1];
        }
    for (int v = 0; v < vertexCount; ++v) first[v + 1] += first[v];
    std::vector<int> end(first.begin(), first.end() - 1);
    for (int h = 0; h < count(); ++h) leaving[end[tail(h)]++] = h;
    const auto valence = [&](int v) { return end[v] - first[v]; };
    for (int h = 0; h < count(); ++h) {
        // Where fewer halfedges leave: else the hub of a wheel would be gone through from every spoke.
        if (valence(head(h)) > valence(tail(h))) continue;
        for (int i = first[head(h)]; i < end[head(h)]; ++i) {
            if (head(leaving[i]) != tail(h)) continue;
            twin_[h] = leaving[i];
            twin_[leaving[i]] = h;
            break;
        }
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

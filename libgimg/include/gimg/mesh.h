#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

namespace gimg {

using Vec3 = Eigen::Vector3d;
using Vec2 = Eigen::Vector2d;
using Triangle = std::array<int, 3>; ///< vertex indices, counter-clockwise seen from outside

/// An indexed triangle mesh. Nothing is promised about it beyond indices in range; see Halfedges.
struct Mesh
{
    std::vector<Vec3> positions;
    std::vector<Triangle> faces;

    int vertexCount() const { return static_cast<int>(positions.size()); }
    int faceCount() const { return static_cast<int>(faces.size()); }
};

/// Connectivity of an oriented manifold mesh. Halfedge h = 3 f + k runs from corner k of face f to the next
/// corner; its twin runs the other way in the neighbouring face, or is -1 on the boundary.
class Halfedges
{
public:
    /// @param faces  edge-manifold and consistently oriented: every directed edge occurs at most once.
    Halfedges(const std::vector<Triangle>& faces, int vertexCount);

    static int face(int h) { return h / 3; }
    static int next(int h) { return h % 3 == 2 ? h - 2 : h + 1; }
    static int prev(int h) { return h % 3 == 0 ? h + 2 : h - 1; }

    int count() const { return static_cast<int>(tail_.size()); }
    int tail(int h) const { return tail_[h]; }
    int head(int h) const { return tail_[next(h)]; }
    int twin(int h) const { return twin_[h]; }
    bool onBoundary(int h) const { return twin_[h] < 0; }

    /// An outgoing halfedge of vertex v, the most clockwise one where v lies on the boundary; -1 if
    /// unreferenced.
    int outgoing(int v) const { return outgoing_[v]; }
    /// The next outgoing halfedge counter-clockwise around the tail of h; -1 past the boundary.
    int rotateCcw(int h) const { return twin_[prev(h)]; }
    /// The next outgoing halfedge clockwise around the tail of h; -1 past the boundary.
    int rotateCw(int h) const { return twin_[h] < 0 ? -1 : next(twin_[h]); }

private:
    std::vector<int> tail_;
    std::vector<int> twin_;
    std::vector<int> outgoing_;
};

/// Topological type of a connected, oriented manifold mesh.
struct Topology
{
    int vertices = 0; ///< referenced by a face
    int edges = 0;
    int faces = 0;
    int boundaries = 0; ///< boundary loops
    int genus = 0;
    int euler() const { return vertices - edges + faces; }
};

/// @param mesh  connected, manifold, oriented.
Topology topology(const Mesh& mesh);

/// Length of the bounding box diagonal of the referenced vertices.
double boundingBoxDiagonal(const Mesh& mesh);

/// Sum of the triangle areas.
double surfaceArea(const Mesh& mesh);

/// Area-weighted unit normal of every vertex; zero where no face has an area.
std::vector<Vec3> vertexNormals(const Mesh& mesh);

} // namespace gimg

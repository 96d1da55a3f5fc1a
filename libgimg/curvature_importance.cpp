#include "curvature_importance.h"

#include <algorithm>
#include <cmath>

namespace gimg {
namespace {

// Integral over the triangle of |grad n|^2 with n the interpolated normal.
double bending(const std::array<Vec3, 3>& corner, const std::array<Vec3, 3>& normal, double area)
{
    if (!(area > 0)) return 0;
    Vec3 edge[3]; // opposite the corner
    for (int k = 0; k < 3; ++k) edge[k] = corner[(k + 2) % 3] - corner[(k + 1) % 3];
    double sum = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) sum += normal[i].dot(normal[j]) * edge[i].dot(edge[j]);
    return std::max(0.0, sum / (4 * area));
}

} // namespace

std::vector<double> curvatureImportance(const Mesh& mesh, int grid)
{
    constexpr double kFlat = 0.1, kLargest = 30; // times the mean
    const std::vector<Vec3> normals = vertexNormals(mesh);
    const size_t vertices = mesh.positions.size();
    std::vector<double> faceArea, area(vertices, 0.0), value(vertices, 0.0);
    double total = 0, bent = 0, squaredEdges = 0;
    for (const Triangle& f : mesh.faces) {
        const std::array corner = {mesh.positions[f[0]], mesh.positions[f[1]], mesh.positions[f[2]]};
        const double a = 0.5 * (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm();
        const double b = bending(corner, {normals[f[0]], normals[f[1]], normals[f[2]]}, a);
        for (int k = 0; k < 3; ++k) {
            squaredEdges += (corner[(k + 1) % 3] - corner[k]).squaredNorm();
            area[f[k]] += a / 3;
            value[f[k]] += b / 3;
        }
        faceArea.push_back(a);
        total += a;
        bent += b;
    }
    if (!(bent > 1e-9)) return std::vector<double>(vertices, 1.0); // a sphere has 8 pi
    for (size_t v = 0; v < vertices; ++v)
        if (area[v] > 0) value[v] /= area[v];

    // A round of averaging spreads a value over about an edge; r rounds over sqrt(r) edges.
    const double cell = total / (double(grid) * grid), edge = squaredEdges / (3.0 * mesh.faceCount());
    const int rounds = std::clamp(static_cast<int>(std::lround(4 * cell / edge)), 3, 100);
    for (int round = 0; round < rounds; ++round) {
        std::vector<double> sum(vertices, 0.0);
        for (size_t f = 0; f < faceArea.size(); ++f) {
            const Triangle& t = mesh.faces[f];
            const double mean = (value[t[0]] + value[t[1]] + value[t[2]]) / 3;
            for (int v : t) sum[v] += mean * faceArea[f] / 3;
        }
        for (size_t v = 0; v < vertices; ++v)
            if (area[v] > 0) value[v] = sum[v] / area[v];
    }

    double weighted = 0;
    for (size_t v = 0; v < vertices; ++v) {
        value[v] = std::sqrt(std::min(value[v] * total / bent, kLargest) + kFlat);
        weighted += value[v] * area[v];
    }
    for (double& x : value) x *= total / weighted;
    return value;
}

} // namespace gimg

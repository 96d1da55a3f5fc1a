#pragma once

#include "gimg/mesh.h"

#include <cmath>
#include <numbers>

namespace gimg::test {

inline Mesh tetrahedron()
{
    return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

/// An octahedron, each side cut into 4^levels triangles, on a sphere about the origin. The eight sides share
/// no vertices.
inline Mesh sphere(double radius, int levels)
{
    const int n = 1 << levels;
    Mesh mesh;
    for (int sx : {1, -1})
        for (int sy : {1, -1})
            for (int sz : {1, -1}) {
                const int first = mesh.vertexCount();
                const auto at = [&](int i, int j) { return first + i * (n + 1) - i * (i - 1) / 2 + j; };
                for (int i = 0; i <= n; ++i)
                    for (int j = 0; j <= n - i; ++j)
                        mesh.positions.push_back(Vec3(sx * i, sy * j, sz * (n - i - j)).normalized() *
                                                 radius);
                for (int i = 0; i < n; ++i)
                    for (int j = 0; j < n - i; ++j) {
                        Triangle t{at(i, j), at(i + 1, j), at(i, j + 1)};
                        if (sx * sy * sz < 0) std::swap(t[1], t[2]);
                        mesh.faces.push_back(t);
                        if (j + 1 == n - i) continue;
                        t = {at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
                        if (sx * sy * sz < 0) std::swap(t[1], t[2]);
                        mesh.faces.push_back(t);
                    }
            }
    return mesh;
}

/// A band of 2 x `segments` triangles around the z axis, with a half twist (a Moebius band) or none.
inline Mesh band(int segments, bool twisted)
{
    Mesh mesh;
    for (int i = 0; i < segments; ++i) {
        const double angle = 2 * std::numbers::pi * i / segments;
        const double lean = twisted ? angle / 2 : 0;
        for (double side : {-0.3, 0.3})
            mesh.positions.emplace_back((1 + side * std::sin(lean)) * std::cos(angle),
                                        (1 + side * std::sin(lean)) * std::sin(angle), side * std::cos(lean));
    }
    for (int i = 0; i < segments; ++i) {
        const int a = 2 * i, b = a + 1;
        int c = 2 * ((i + 1) % segments), d = c + 1;
        if (twisted && i + 1 == segments) std::swap(c, d);
        mesh.faces.push_back({a, c, b});
        mesh.faces.push_back({b, c, d});
    }
    return mesh;
}

/// A torus of revolution about the z axis.
inline Mesh torus(double major, double minor, int around, int across)
{
    Mesh mesh;
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / across;
            const double r = major + minor * std::cos(v);
            mesh.positions.emplace_back(r * std::cos(u), r * std::sin(u), minor * std::sin(v));
        }
    const auto at = [&](int i, int j) { return (i % around) * across + j % across; };
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return mesh;
}

/// The unit square in z = 0, two triangles a cell.
inline Mesh square(int cells)
{
    Mesh mesh;
    for (int i = 0; i <= cells; ++i)
        for (int j = 0; j <= cells; ++j)
            mesh.positions.emplace_back(double(i) / cells, double(j) / cells, 0.0);
    const auto at = [cells](int i, int j) { return i * (cells + 1) + j; };
    for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j) {
            mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return mesh;
}

inline double signedVolume(const Mesh& mesh)
{
    double six = 0;
    for (const Triangle& t : mesh.faces)
        six += mesh.positions[t[0]].dot(mesh.positions[t[1]].cross(mesh.positions[t[2]]));
    return six / 6;
}

} // namespace gimg::test

#include "known_surfaces.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>

namespace gimg::known {
namespace {

constexpr double kPi = std::numbers::pi;

// In [-1, 1].
double unit(std::mt19937& random) { return 2.0 * static_cast<double>(random()) / std::mt19937::max() - 1; }

class Groups // of things that are glued to each other
{
public:
    explicit Groups(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
    int root(int i)
    {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void glue(int i, int j) { parent_[root(i)] = root(j); }

    /// Numbers the groups 0, 1, ... in the order of their first members.
    std::vector<int> numbered(int& count)
    {
        std::vector<int> number(parent_.size(), -1), result(parent_.size());
        count = 0;
        for (int i = 0; i < static_cast<int>(parent_.size()); ++i) {
            int& own = number[root(i)];
            if (own < 0) own = count++;
            result[i] = own;
        }
        return result;
    }

private:
    std::vector<int> parent_;
};

// The faces split into n x n, the new vertices pushed out to the sphere.
Mesh splitOnSphere(const Mesh& coarse, int n)
{
    Mesh mesh;
    std::map<std::array<int, 6>, int> known; // corners with their weights, least corner first
    const auto vertex = [&](const Triangle& t, int a, int b, int c) {
        std::array<std::pair<int, int>, 3> key{{{t[0], a}, {t[1], b}, {t[2], c}}};
        for (auto& [corner, weight] : key)
            if (weight == 0) corner = -1;
        std::sort(key.begin(), key.end());
        const auto [place, isNew] = known.try_emplace(
            {key[0].first, key[0].second, key[1].first, key[1].second, key[2].first, key[2].second},
            mesh.vertexCount());
        if (isNew) {
            const Vec3 p =
                a * coarse.positions[t[0]] + b * coarse.positions[t[1]] + c * coarse.positions[t[2]];
            mesh.positions.push_back(p.normalized());
        }
        return place->second;
    };
    for (int v = 0; v < coarse.vertexCount(); ++v)
        for (const Triangle& t : coarse.faces)
            for (int k = 0; k < 3; ++k)
                if (t[k] == v) vertex(t, k == 0 ? n : 0, k == 1 ? n : 0, k == 2 ? n : 0);
    for (const Triangle& t : coarse.faces)
        for (int i = 0; i < n; ++i)
            for (int j = 0; i + j < n; ++j) {
                const auto at = [&](int b, int c) { return vertex(t, n - b - c, b, c); };
                mesh.faces.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
                if (i + j + 2 <= n) mesh.faces.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
            }
    return mesh;
}

Mesh bipyramid(int sides)
{
    Mesh mesh;
    for (int i = 0; i < sides; ++i)
        mesh.positions.emplace_back(std::cos(2 * kPi * i / sides), std::sin(2 * kPi * i / sides), 0);
    mesh.positions.emplace_back(0, 0, 1);
    mesh.positions.emplace_back(0, 0, -1);
    for (int i = 0; i < sides; ++i) {
        const int j = (i + 1) % sides;
        mesh.faces.push_back({i, j, sides});
        mesh.faces.push_back({j, i, sides + 1});
    }
    return mesh;
}

// Is x on the arc of the great circle from p to q, shorter than half?
bool isOnArc(const Vec3& x, const Vec3& p, const Vec3& q)
{
    constexpr double kNear = 1e-9;
    const Vec3 normal = p.cross(q).normalized();
    return std::abs(x.dot(normal)) < kNear && p.cross(x).dot(normal) > -kNear &&
           x.cross(q).dot(normal) > -kNear;
}

// By stereographic projection along an axis, dilation and back.
Vec3 dilated(const Vec3& p, double factor)
{
    const Vec3 axis = Vec3(1, 2, 3).normalized();
    const double height = p.dot(axis);
    const Vec3 plane = factor * (p - height * axis); // times 1 - height
    const double away = factor * factor * (1 + height), near = 1 - height;
    return (2 * plane + (away - near) * axis) / (away + near);
}

// Two copies of a mesh of the sphere, glued crosswise along arcs between vertices.
PolyhedralSurface doubleCover(const Mesh& mesh, const std::vector<std::pair<int, int>>& arcs, double dilation)
{
    const Halfedges he(mesh.faces, mesh.vertexCount());
    const std::vector<Vec3>& p = mesh.positions;
    const auto isSlit = [&](int h) {
        return std::any_of(arcs.begin(), arcs.end(), [&](const std::pair<int, int>& arc) {
            return isOnArc(p[he.tail(h)], p[arc.first], p[arc.second]) &&
                   isOnArc(p[he.head(h)], p[arc.first], p[arc.second]);
        });
    };
    const int corners = he.count(); // of one copy
    Groups groups(2 * static_cast<size_t>(corners));
    for (int h = 0; h < corners; ++h)
        for (int sheet = 0; sheet < 2; ++sheet) {
            const int other = isSlit(h) ? 1 - sheet : sheet, twin = he.twin(h);
            groups.glue(sheet * corners + h, other * corners + Halfedges::next(twin));
            groups.glue(sheet * corners + Halfedges::next(h), other * corners + twin);
        }
    PolyhedralSurface cover;
    const std::vector<int> vertex = groups.numbered(cover.vertexCount);
    Mesh moved = mesh;
    for (Vec3& v : moved.positions) v = dilated(v, dilation);
    const PolyhedralSurface below = polyhedralSurface(moved);
    for (int c = 0; c < 2 * corners; c += 3) cover.faces.push_back({vertex[c], vertex[c + 1], vertex[c + 2]});
    cover.lengths = below.lengths;
    cover.lengths.insert(cover.lengths.end(), below.lengths.begin(), below.lengths.end());
    return cover;
}

struct Grid // of vertices (i, j), wrapped around both ways
{
    int nu, nv;
    int operator()(int i, int j) const { return (i + nu) % nu * nv + (j + nv) % nv; }
};

double angleOpposite(const Mesh& mesh, int u, int v, int apex)
{
    const Vec3 a = mesh.positions[u] - mesh.positions[apex], b = mesh.positions[v] - mesh.positions[apex];
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

// One sweep of flips that touch no face twice; false if there was none.
bool flipBadEdges(Mesh& mesh)
{
    const Halfedges he(mesh.faces, mesh.vertexCount());
    std::map<std::pair<int, int>, bool> edges;
    for (int h = 0; h < he.count(); ++h) edges[{he.tail(h), he.head(h)}] = true;
    std::vector<bool> changed(mesh.faces.size(), false);
    bool any = false;
    for (int h = 0; h < he.count(); ++h) {
        const int t = he.twin(h), f = h / 3, g = t / 3;
        if (h > t || changed[f] || changed[g]) continue;
        const int u = he.tail(h), v = he.head(h), p = he.tail(Halfedges::prev(h)),
                  q = he.tail(Halfedges::prev(t));
        if (angleOpposite(mesh, u, v, p) + angleOpposite(mesh, u, v, q) <= kPi + 1e-9) continue;
        if (edges.count({p, q}) || edges.count({q, p})) continue;
        mesh.faces[f] = {u, q, p};
        mesh.faces[g] = {v, p, q};
        edges[{p, q}] = edges[{q, p}] = true;
        changed[f] = changed[g] = any = true;
    }
    return any;
}

} // namespace

Mesh bipyramidSphere(int sides, int n, double off)
{
    const Mesh coarse = bipyramid(sides);
    Mesh mesh = splitOnSphere(coarse, n);
    std::mt19937 random(11);
    for (Vec3& p : mesh.positions) {
        const Vec3 move = off / n * Vec3(unit(random), unit(random), unit(random));
        bool onEdge = false;
        for (const Triangle& t : coarse.faces)
            for (int k = 0; k < 3; ++k)
                onEdge |= isOnArc(p, coarse.positions[t[k]], coarse.positions[t[(k + 1) % 3]]);
        if (!onEdge) p = (p + move).normalized();
    }
    return mesh;
}

PolyhedralSurface coverOverEquator(int sides, int n, double off, double dilation)
{
    std::vector<std::pair<int, int>> arcs;
    for (int i = 0; i < sides; i += 2) arcs.emplace_back(i, i + 1);
    return doubleCover(bipyramidSphere(sides, n, off), arcs, dilation);
}

PolyhedralSurface coverOverOctahedron(int n, double off, double dilation)
{
    return doubleCover(bipyramidSphere(4, n, off), {{0, 1}, {2, 4}, {3, 5}},
                       dilation); // 4 and 5 are the poles
}

PolyhedralSurface squareTiled(const std::vector<int>& right, const std::vector<int>& up, int n, double off,
                              double skew)
{
    const int squares = static_cast<int>(right.size());
    const auto at = [&](int s, int i, int j) { return (s * (n + 1) + i) * (n + 1) + j; };
    Groups groups(static_cast<size_t>(at(squares, 0, 0)));
    for (int s = 0; s < squares; ++s)
        for (int k = 0; k <= n; ++k) {
            groups.glue(at(s, n, k), at(right[s], 0, k));
            groups.glue(at(s, k, n), at(up[s], k, 0));
        }
    PolyhedralSurface surface;
    const std::vector<int> vertex = groups.numbered(surface.vertexCount);
    std::mt19937 random(3);
    for (int s = 0; s < squares; ++s) {
        std::vector<Vec2> place;
        for (int i = 0; i <= n; ++i)
            for (int j = 0; j <= n; ++j) {
                const bool inside = i > 0 && j > 0 && i < n && j < n;
                const double x = off * unit(random), y = off * unit(random);
                place.emplace_back(std::pow((i + (inside ? x : 0)) / n, skew), (j + (inside ? y : 0)) / n);
            }
        const auto add = [&](int a, int b, int c) {
            surface.faces.push_back({vertex[at(s, 0, a)], vertex[at(s, 0, b)], vertex[at(s, 0, c)]});
            for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
                surface.lengths.push_back((place[to] - place[from]).norm());
        };
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const int a = at(0, i, j), b = at(0, i + 1, j), c = b + 1, d = a + 1;
                add(a, b, c);
                add(a, c, d);
            }
    }
    return surface;
}

Mesh roughTorus(double major, double minor, int nu, int nv, double off, bool irregular, uint32_t seed)
{
    std::mt19937 random(seed);
    Mesh mesh;
    for (int i = 0; i < nu; ++i)
        for (int j = 0; j < nv; ++j) {
            const double u = 2 * kPi * (i + off * unit(random)) / nu,
                         v = 2 * kPi * (j + off * unit(random)) / nv;
            const double radius = major + minor * std::cos(v);
            mesh.positions.emplace_back(radius * std::cos(u), radius * std::sin(u), minor * std::sin(v));
        }
    const Grid grid{nu, nv};
    for (int i = 0; i < nu; ++i)
        for (int j = 0; j < nv; ++j) {
            const int a = grid(i, j), b = grid(i + 1, j), c = grid(i + 1, j + 1), d = grid(i, j + 1);
            mesh.faces.push_back({a, b, c});
            mesh.faces.push_back({a, c, d});
        }
    for (int sweep = 0; irregular && sweep < 100 && flipBadEdges(mesh); ++sweep) {
    }
    return mesh;
}

Mesh splitInFour(const Mesh& mesh)
{
    Mesh fine;
    fine.positions = mesh.positions;
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int u, int v) {
        const auto [place, isNew] = middles.try_emplace(std::minmax(u, v), fine.vertexCount());
        if (isNew) fine.positions.push_back(0.5 * (mesh.positions[u] + mesh.positions[v]));
        return place->second;
    };
    for (const Triangle& t : mesh.faces) {
        const int a = middle(t[1], t[2]), b = middle(t[2], t[0]), c = middle(t[0], t[1]);
        fine.faces.insert(fine.faces.end(), {{t[0], c, b}, {c, t[1], a}, {b, a, t[2]}, {a, b, c}});
    }
    return fine;
}

PolyhedralSurface splitInFour(const PolyhedralSurface& surface)
{
    PolyhedralSurface fine{surface.vertexCount, {}, {}};
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int u, int v) {
        const auto [place, isNew] = middles.try_emplace(std::minmax(u, v), fine.vertexCount);
        if (isNew) ++fine.vertexCount;
        return place->second;
    };
    for (int f = 0; f < surface.faceCount(); ++f) {
        const Triangle& t = surface.faces[f];
        const double* l = &surface.lengths[3 * static_cast<size_t>(f)]; // of sides 01, 12, 20
        const double p = l[0] / 2, q = l[1] / 2, r = l[2] / 2;
        const int a = middle(t[1], t[2]), b = middle(t[2], t[0]), c = middle(t[0], t[1]);
        fine.faces.insert(fine.faces.end(), {{t[0], c, b}, {c, t[1], a}, {b, a, t[2]}, {a, b, c}});
        fine.lengths.insert(fine.lengths.end(), {p, q, r, p, q, r, p, q, r, p, q, r});
    }
    return fine;
}

Mesh kleinBottle(int n)
{
    Mesh mesh;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double u = 2 * kPi * i / n, v = 2 * kPi * j / n;
            const double radius = 3 + std::cos(u / 2) * std::sin(v) - std::sin(u / 2) * std::sin(2 * v);
            const double height = std::sin(u / 2) * std::sin(v) + std::cos(u / 2) * std::sin(2 * v);
            mesh.positions.emplace_back(radius * std::cos(u), radius * std::sin(u), height);
        }
    const auto at = [&](int i, int j) { return i < n ? i * n + j % n : (2 * n - j) % n; }; // v -> -v around u
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return mesh;
}

} // namespace gimg::known

#include "shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace gimg::shapes {

namespace {

using std::numbers::pi;

double distance(const Mesh& mesh, int a, int b) { return (mesh.positions[a] - mesh.positions[b]).norm(); }

// The quad a b c d, counter-clockwise, split along its shorter diagonal.
void addQuad(Mesh& mesh, int a, int b, int c, int d)
{
    if (distance(mesh, a, c) <= distance(mesh, b, d)) {
        mesh.faces.push_back({a, b, c});
        mesh.faces.push_back({a, c, d});
    } else {
        mesh.faces.push_back({a, b, d});
        mesh.faces.push_back({b, c, d});
    }
}

// Vertices named by integer triples, so that neighbouring patches share the ones on their common side.
class Lattice
{
public:
    using Key = std::array<int, 3>;

    template <class Position> int vertex(Mesh& mesh, const Key& key, Position position)
    {
        const auto [entry, isNew] = index_.try_emplace(key, mesh.vertexCount());
        if (isNew) mesh.positions.push_back(position());
        return entry->second;
    }

private:
    std::map<Key, int> index_;
};

// A tube of nu rings of nv vertices, `point(i, j)` at ring i; u x v points outward. Both directions close up.
template <class Point> Mesh closedTube(int nu, int nv, Point point)
{
    Mesh mesh;
    for (int i = 0; i < nu; ++i)
        for (int j = 0; j < nv; ++j) mesh.positions.push_back(point(i, j));
    const auto at = [&](int i, int j) { return (i % nu) * nv + j % nv; };
    for (int i = 0; i < nu; ++i)
        for (int j = 0; j < nv; ++j) addQuad(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    return mesh;
}

std::vector<Vec3> icosahedronVertices()
{
    const double g = std::numbers::phi;
    std::vector<Vec3> p;
    for (const double s : {-1.0, 1.0})
        for (const double t : {-g, g}) {
            p.emplace_back(0, s, t);
            p.emplace_back(s, t, 0);
            p.emplace_back(t, 0, s);
        }
    return p;
}

// Faces join vertices at the smallest distance, 2, and face away from the centre.
std::vector<Triangle> icosahedronFaces(const std::vector<Vec3>& p)
{
    const auto joined = [&](int a, int b) { return (p[a] - p[b]).squaredNorm() < 4.5; };
    std::vector<Triangle> faces;
    for (int a = 0; a < 12; ++a)
        for (int b = a + 1; b < 12; ++b)
            for (int c = b + 1; c < 12; ++c) {
                if (!joined(a, b) || !joined(b, c) || !joined(c, a)) continue;
                const bool outward = p[a].dot(p[b].cross(p[c])) > 0;
                faces.push_back(outward ? Triangle{a, b, c} : Triangle{a, c, b});
            }
    return faces;
}

} // namespace

Mesh sphere(double radius, int n)
{
    const std::vector<Vec3> corner = icosahedronVertices();
    Mesh mesh;
    std::map<std::array<int, 6>, int> index; // by the corners' weights, so that shared edges share vertices
    for (const Triangle& f : icosahedronFaces(corner)) {
        const auto at = [&](int i, int j) {
            std::array<std::pair<int, int>, 3> weights{{{f[0], n - i - j}, {f[1], i}, {f[2], j}}};
            for (auto& [vertex, weight] : weights)
                if (weight == 0) vertex = -1;
            std::sort(weights.begin(), weights.end());
            std::array<int, 6> key;
            Vec3 p = Vec3::Zero();
            for (int k = 0; k < 3; ++k) {
                const auto [vertex, weight] = weights[k];
                key[2 * k] = vertex;
                key[2 * k + 1] = weight;
                if (vertex >= 0) p += weight * corner[vertex];
            }
            const auto [entry, isNew] = index.try_emplace(key, mesh.vertexCount());
            if (isNew) mesh.positions.push_back(radius * p.normalized());
            return entry->second;
        };
        for (int i = 0; i < n; ++i)
            for (int j = 0; i + j < n; ++j) {
                mesh.faces.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
                if (i + j + 1 < n) mesh.faces.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
            }
    }
    return mesh;
}

Mesh wavySphere(double radius, double amplitude, int waves, int n)
{
    Mesh mesh = sphere(1.0, n);
    for (Vec3& p : mesh.positions) {
        const double wave =
            std::pow(std::hypot(p.x(), p.y()), waves) * std::cos(waves * std::atan2(p.y(), p.x()));
        p *= radius * (1 + amplitude * wave);
    }
    return mesh;
}

Mesh torus(double major, double minor, int nu, int nv)
{
    return closedTube(nu, nv, [=](int i, int j) {
        const double u = 2 * pi * i / nu, v = 2 * pi * j / nv;
        const double rho = major + minor * std::cos(v);
        return Vec3(rho * std::cos(u), rho * std::sin(u), minor * std::sin(v));
    });
}

namespace {

// c(t) = ((2 + cos 3t) cos 2t, (2 + cos 3t) sin 2t, sin 3t) lies on the torus of radii 2 and 1.
Vec3 trefoilPoint(double t)
{
    const double rho = 2 + std::cos(3 * t);
    return {rho * std::cos(2 * t), rho * std::sin(2 * t), std::sin(3 * t)};
}

Vec3 trefoilDerivative(double t)
{
    const double rho = 2 + std::cos(3 * t), drho = -3 * std::sin(3 * t);
    return {drho * std::cos(2 * t) - 2 * rho * std::sin(2 * t),
            drho * std::sin(2 * t) + 2 * rho * std::cos(2 * t), 3 * std::cos(3 * t)};
}

} // namespace

Mesh trefoil(double tube, int nu, int nv)
{
    return closedTube(nu, nv, [=](int i, int j) -> Vec3 {
        const double t = 2 * pi * i / nu, v = 2 * pi * j / nv;
        // The torus' normal is normal to the knot too, and closes up after one turn.
        const Vec3 normal(std::cos(3 * t) * std::cos(2 * t), std::cos(3 * t) * std::sin(2 * t),
                          std::sin(3 * t));
        const Vec3 binormal = normal.cross(trefoilDerivative(t).normalized());
        return trefoilPoint(t) + tube * (std::cos(v) * normal + std::sin(v) * binormal);
    });
}

double trefoilLength()
{
    const int samples = 4096; // the trapezoid rule converges exponentially on a periodic function
    double sum = 0;
    for (int i = 0; i < samples; ++i) sum += trefoilDerivative(2 * pi * i / samples).norm();
    return sum * 2 * pi / samples;
}

Mesh cylinder(double radius, double height, int nu, int nv)
{
    Mesh mesh;
    for (int j = 0; j <= nv; ++j)
        for (int i = 0; i < nu; ++i) {
            const double u = 2 * pi * i / nu;
            mesh.positions.emplace_back(radius * std::cos(u), radius * std::sin(u), height * j / nv);
        }
    const auto at = [&](int i, int j) { return j * nu + i % nu; };
    for (int j = 0; j < nv; ++j)
        for (int i = 0; i < nu; ++i) addQuad(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    return mesh;
}

Mesh disk(double radius, int n)
{
    Mesh mesh;
    mesh.positions.push_back(Vec3::Zero());
    for (int ring = 1; ring <= n; ++ring)
        for (int k = 0; k < 6 * ring; ++k) {
            const double u = 2 * pi * k / (6 * ring), rho = radius * ring / n;
            mesh.positions.emplace_back(rho * std::cos(u), rho * std::sin(u), 0);
        }
    // Ring r starts at vertex 1 + 3 r (r - 1); each of its six sectors has r segments.
    const auto at = [](int ring, int k) {
        return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1) + k % (6 * ring);
    };
    for (int ring = 1; ring <= n; ++ring)
        for (int sector = 0; sector < 6; ++sector)
            for (int k = 0; k < ring; ++k) {
                const int outer = sector * ring + k, inner = sector * (ring - 1) + k;
                mesh.faces.push_back({at(ring, outer), at(ring, outer + 1), at(ring - 1, inner)});
                if (k + 1 < ring)
                    mesh.faces.push_back({at(ring, outer + 1), at(ring - 1, inner + 1), at(ring - 1, inner)});
            }
    return mesh;
}

Mesh box(const Vec3& sides, int n)
{
    Mesh mesh;
    Lattice lattice;
    const auto at = [&](int axis, int end, int x, int y) {
        std::array<int, 3> p{};
        p[axis] = end, p[(axis + 1) % 3] = x, p[(axis + 2) % 3] = y;
        return lattice.vertex(mesh, {p[0], p[1], p[2]}, [&] {
            return Vec3(sides.cwiseProduct(Vec3(p[0], p[1], p[2]) / n - Vec3::Constant(0.5)));
        });
    };
    for (int axis = 0; axis < 3; ++axis)
        for (int x = 0; x < n; ++x)
            for (int y = 0; y < n; ++y) {
                addQuad(mesh, at(axis, n, x, y), at(axis, n, x + 1, y), at(axis, n, x + 1, y + 1),
                        at(axis, n, x, y + 1));
                addQuad(mesh, at(axis, 0, x, y), at(axis, 0, x, y + 1), at(axis, 0, x + 1, y + 1),
                        at(axis, 0, x + 1, y));
            }
    return mesh;
}

Mesh plate(int holes, int n)
{
    const double holeRadius = 0.6;
    Mesh mesh;
    Lattice lattice;
    // Points on the sides of the squares: (x, y) in units of 2 / n.
    const auto onLattice = [&](int x, int y) {
        return lattice.vertex(mesh, {x, y, 0}, [=] { return Vec3(2.0 * x / n, 2.0 * y / n, 0); });
    };
    if (holes == 0)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x)
                addQuad(mesh, onLattice(x, y), onLattice(x + 1, y), onLattice(x + 1, y + 1),
                        onLattice(x, y + 1));

    // A square with a hole is rings of 4 n vertices, ring 0 on the hole and ring `rings` on the square's
    // sides.
    const int rings = (n + 1) / 2;
    for (int hole = 0; hole < holes; ++hole) {
        const auto at = [&](int ring, int k) {
            const int side = k % (4 * n) / n, step = k % n;
            const std::array<std::array<int, 2>, 4> square{
                {{step, 0}, {n, step}, {n - step, n}, {0, n - step}}};
            const int x = square[side][0], y = square[side][1];
            if (ring == rings) return onLattice(hole * n + x, y);
            return lattice.vertex(mesh, {hole, ring * 4 * n + k % (4 * n), 1}, [=] {
                const Vec3 center(2 * hole + 1, 1, 0);
                const double angle = 2 * pi * k / (4 * n) - 0.75 * pi;
                const Vec3 inner = center + holeRadius * Vec3(std::cos(angle), std::sin(angle), 0);
                const Vec3 outer(2.0 * (hole * n + x) / n, 2.0 * y / n, 0);
                const double t = static_cast<double>(ring) / rings;
                return Vec3((1 - t) * inner + t * outer);
            });
        };
        for (int ring = 0; ring < rings; ++ring)
            for (int k = 0; k < 4 * n; ++k)
                addQuad(mesh, at(ring, k), at(ring + 1, k), at(ring + 1, k + 1), at(ring, k + 1));
    }
    return mesh;
}

namespace {

// The ladder lies in z = 0: rails y = 0 and y = 2 from x = 0 to 2 genus, rungs x = 0, 2, ..., 2 genus between
// them. Its field is the sum over rails and rungs of exp(-a |p - q|^2) integrated over q; the surface is a
// level of it.
constexpr double kSharpness = 4.0;
constexpr double kLadderRadius = 0.5; // of a straight, infinitely long bar

struct Field
{
    double value = 0;
    Vec3 gradient = Vec3::Zero();

    // One bar along coordinate `axis`, from `start` to start + length.
    void addBar(const Vec3& p, const Vec3& start, int axis, double length)
    {
        const double a = kSharpness, root = std::sqrt(a);
        Vec3 across = p - start;
        const double along = across[axis];
        across[axis] = 0;
        const double radial = std::exp(-a * across.squaredNorm());
        const double integral =
            std::sqrt(pi) / (2 * root) * (std::erf(root * along) - std::erf(root * (along - length)));
        value += radial * integral;
        gradient -= 2 * a * radial * integral * across;
        gradient[axis] +=
            radial * (std::exp(-a * along * along) - std::exp(-a * (along - length) * (along - length)));
    }
};

Field ladderField(int genus, const Vec3& p)
{
    Field field;
    for (int rung = 0; rung <= genus; ++rung) field.addBar(p, Vec3(2 * rung, 0, 0), 1, 2);
    for (int rail = 0; rail <= 2 && genus > 0; rail += 2) field.addBar(p, Vec3(0, rail, 0), 0, 2 * genus);
    return field;
}

// First-order offset to the surface along the gradient of log(field), which is nearly quadratic in the
// distance.
Vec3 offsetToLadder(int genus, const Vec3& p)
{
    const double level = std::sqrt(pi / kSharpness) * std::exp(-kSharpness * kLadderRadius * kLadderRadius);
    const Field field = ladderField(genus, p);
    const Vec3 slope = field.gradient / field.value;
    return std::log(level / field.value) / slope.squaredNorm() * slope;
}

} // namespace

Mesh surfaceOfGenus(int genus, int loops, int n)
{
    // Unit cells centred on the ladder: all of a (2 genus + 1) x 3 block but the gaps between the rungs.
    const auto solid = [&](int x, int y, int z) {
        return z == 0 && x >= 0 && x <= 2 * genus && y >= 0 && y <= 2 && !(x % 2 == 1 && y == 1);
    };
    // Openings: top sides of the cells where rungs meet rails, then the bottom sides. No two of them touch.
    const auto opened = [&](int x, int y, int side) {
        if (x % 2 == 1 || y == 1 || side == 0) return false;
        return x + y / 2 + (side > 0 ? 0 : 2 * (genus + 1)) < loops;
    };

    Mesh mesh;
    Lattice lattice;
    std::vector<std::array<int, 4>> quads;
    // The side of cell (x, y) facing along `axis`, up (+1) or down (-1), as n x n quads counter-clockwise
    // from outside.
    const auto addSide = [&](int x, int y, int axis, int direction) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const auto at = [&](int i, int j) {
            Lattice::Key key{x * n, y * n, 0}; // in units of 1 / n from the corner of cell (0, 0)
            key[axis] += direction > 0 ? n : 0;
            key[u] += i;
            key[v] += j;
            return lattice.vertex(mesh, key, [&] {
                Vec3 p = Vec3(key[0], key[1], key[2]) / n - Vec3::Constant(0.5);
                for (int step = 0; step < 30; ++step) {
                    const Vec3 offset = offsetToLadder(genus, p);
                    p += offset;
                    if (offset.norm() < 1e-13) break;
                }
                return p;
            });
        };
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                if (direction > 0)
                    quads.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
                else
                    quads.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
            }
    };
    for (int x = 0; x <= 2 * genus; ++x)
        for (int y = 0; y <= 2; ++y) {
            if (!solid(x, y, 0)) continue;
            for (int axis = 0; axis < 3; ++axis)
                for (const int direction : {-1, 1}) {
                    const int dx = axis == 0 ? direction : 0, dy = axis == 1 ? direction : 0;
                    const int dz = axis == 2 ? direction : 0;
                    if (solid(x + dx, y + dy, dz) || opened(x, y, dz)) continue;
                    addSide(x, y, axis, direction);
                }
        }
    for (const auto& [a, b, c, d] : quads) addQuad(mesh, a, b, c, d);
    return mesh;
}

double surfaceOfGenusResidual(int genus, const Vec3& p) { return offsetToLadder(genus, p).norm(); }

double volume(const Mesh& mesh)
{
    double six = 0;
    for (const Triangle& f : mesh.faces)
        six += mesh.positions[f[0]].dot(mesh.positions[f[1]].cross(mesh.positions[f[2]]));
    return six / 6;
}

double smallestAngle(const Mesh& mesh)
{
    double smallest = 180;
    for (const Triangle& f : mesh.faces)
        for (int k = 0; k < 3; ++k) {
            const Vec3 a = mesh.positions[f[(k + 1) % 3]] - mesh.positions[f[k]];
            const Vec3 b = mesh.positions[f[(k + 2) % 3]] - mesh.positions[f[k]];
            smallest = std::min(smallest, std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / pi);
        }
    return smallest;
}

} // namespace gimg::shapes

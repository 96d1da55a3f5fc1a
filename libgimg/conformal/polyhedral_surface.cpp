#include "gimg/polyhedral_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <tuple>

namespace gimg {
namespace {

using Objection = std::optional<Error>;

std::string number(int i) { return std::to_string(i); }

Objection objectionToIndices(const PolyhedralSurface& surface)
{
    if (surface.faces.empty()) return Error{ErrorKind::EmptyMesh, "the surface has no faces"};
    for (int f = 0; f < surface.faceCount(); ++f) {
        const Triangle& t = surface.faces[f];
        for (int v : t)
            if (v < 0 || v >= surface.vertexCount)
                return Error{ErrorKind::BadArgument, "face " + number(f) + " names vertex " + number(v) +
                                                         " of " + number(surface.vertexCount)};
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
            return Error{ErrorKind::ZeroAreaFace, "face " + number(f) + " names a vertex twice"};
    }
    if (surface.lengths.size() != 3 * surface.faces.size())
        return Error{ErrorKind::BadArgument, "the surface needs one length per halfedge"};
    for (const double length : surface.lengths)
        if (!std::isfinite(length)) return Error{ErrorKind::NotFinite, "an edge has no finite length"};
    return std::nullopt;
}

struct Side // of an edge: a halfedge of some face
{
    int low, high, halfedge;
    bool upward; ///< from low to high
    bool sameEdge(const Side& other) const { return low == other.low && high == other.high; }
};

std::vector<Side> sidesByEdge(const std::vector<Triangle>& faces)
{
    std::vector<Side> sides;
    sides.reserve(3 * faces.size());
    for (int f = 0; f < static_cast<int>(faces.size()); ++f)
        for (int k = 0; k < 3; ++k) {
            const int a = faces[f][k], b = faces[f][(k + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), 3 * f + k, a < b});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.halfedge) < std::tie(b.low, b.high, b.halfedge);
    });
    return sides;
}

std::string edgeName(const Side& side) { return "edge " + number(side.low) + "-" + number(side.high); }

// Can faces be turned over so that neighbours run along their edge both ways? `sides` has two of each edge.
bool isOrientable(const std::vector<Side>& sides, int faces)
{
    struct Neighbour
    {
        int face;
        bool turned;
    };
    std::vector<std::vector<Neighbour>> neighbours(static_cast<size_t>(faces));
    for (size_t i = 0; i + 1 < sides.size(); ++i) {
        if (!sides[i].sameEdge(sides[i + 1])) continue;
        const int f = sides[i].halfedge / 3, g = sides[i + 1].halfedge / 3;
        const bool turned = sides[i].upward == sides[i + 1].upward;
        neighbours[f].push_back({g, turned});
        neighbours[g].push_back({f, turned});
    }
    std::vector<int> turn(static_cast<size_t>(faces), -1);
    std::vector<int> waiting;
    for (int start = 0; start < faces; ++start) {
        if (turn[start] >= 0) continue;
        turn[start] = 0;
        waiting.push_back(start);
        while (!waiting.empty()) {
            const int f = waiting.back();
            waiting.pop_back();
            for (const Neighbour& n : neighbours[f]) {
                const int wanted = turn[f] ^ static_cast<int>(n.turned);
                if (turn[n.face] < 0)
                    turn[n.face] = wanted, waiting.push_back(n.face);
                else if (turn[n.face] != wanted)
                    return false;
            }
        }
    }
    return true;
}

// (What is wrong everywhere before what is wrong at the border: a mesh with both is no surface at all.)
Objection objectionToEdges(const PolyhedralSurface& surface)
{
    const std::vector<Side> sides = sidesByEdge(surface.faces);
    Objection open, turned;
    for (size_t i = 0; i < sides.size();) {
        size_t end = i + 1;
        while (end < sides.size() && sides[end].sameEdge(sides[i])) ++end;
        if (end - i > 2)
            return Error{ErrorKind::NonManifoldEdge,
                         edgeName(sides[i]) + " has " + std::to_string(end - i) + " faces"};
        if (end - i == 1 && !open)
            open = Error{ErrorKind::NotClosed,
                         edgeName(sides[i]) + " is a boundary: the surface must be closed"};
        if (end - i == 2 && !turned && sides[i].upward == sides[i + 1].upward)
            turned =
                Error{ErrorKind::BadArgument, "faces " + number(sides[i].halfedge / 3) + " and " +
                                                  number(sides[i + 1].halfedge / 3) + " both run along " +
                                                  edgeName(sides[i]) + ": orient the faces alike first"};
        if (end - i == 2) {
            const double a = surface.lengths[sides[i].halfedge], b = surface.lengths[sides[i + 1].halfedge];
            if (std::abs(a - b) > 1e-12 * std::max(std::abs(a), std::abs(b)))
                return Error{ErrorKind::BadArgument, edgeName(sides[i]) + " has two lengths"};
        }
        i = end;
    }
    if (turned && !isOrientable(sides, surface.faceCount()))
        return Error{ErrorKind::NotOrientable, "the surface has no consistent orientation"};
    return turned ? turned : open;
}

Objection objectionToVertices(const PolyhedralSurface& surface, const Halfedges& he)
{
    std::vector<int> corners(static_cast<size_t>(surface.vertexCount), 0);
    for (const Triangle& t : surface.faces)
        for (int v : t) ++corners[v];
    for (int v = 0; v < surface.vertexCount; ++v) {
        if (corners[v] == 0) continue;
        int fan = 0, h = he.outgoing(v);
        do ++fan, h = he.rotateCcw(h);
        while (h != he.outgoing(v));
        if (fan != corners[v])
            return Error{ErrorKind::NonManifoldVertex,
                         "the faces at vertex " + number(v) + " form more than one fan"};
    }
    return std::nullopt;
}

bool isConnected(const PolyhedralSurface& surface, const Halfedges& he)
{
    std::vector<bool> seen(surface.faces.size(), false);
    std::vector<int> waiting{0};
    seen[0] = true;
    size_t count = 0;
    while (!waiting.empty()) {
        const int f = waiting.back();
        waiting.pop_back();
        ++count;
        for (int h = 3 * f; h < 3 * f + 3; ++h) {
            const int g = Halfedges::face(he.twin(h));
            if (!seen[g]) seen[g] = true, waiting.push_back(g);
        }
    }
    return count == surface.faces.size();
}

// The longest side of a triangle is shorter than the others together by more than rounding.
Objection objectionToAreas(const PolyhedralSurface& surface)
{
    constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();
    for (int f = 0; f < surface.faceCount(); ++f) {
        const double* l = &surface.lengths[3 * static_cast<size_t>(f)];
        const double longest = std::max({l[0], l[1], l[2]}), shortest = std::min({l[0], l[1], l[2]});
        if (!(shortest > 0) || !(l[0] + l[1] + l[2] - 2 * longest > kRounding * longest))
            return Error{ErrorKind::ZeroAreaFace, "face " + number(f) + " has no area"};
    }
    return std::nullopt;
}

} // namespace

PolyhedralSurface polyhedralSurface(const Mesh& mesh)
{
    PolyhedralSurface surface{mesh.vertexCount(), mesh.faces, {}};
    surface.lengths.reserve(3 * mesh.faces.size());
    for (const Triangle& t : mesh.faces)
        for (int k = 0; k < 3; ++k)
            surface.lengths.push_back((mesh.positions[t[(k + 1) % 3]] - mesh.positions[t[k]]).norm());
    return surface;
}

Result<Topology> closedTopology(const PolyhedralSurface& surface)
{
    if (Objection objection = objectionToIndices(surface)) return *objection;
    if (Objection objection = objectionToEdges(surface)) return *objection;
    const Halfedges he(surface.faces, surface.vertexCount);
    if (Objection objection = objectionToVertices(surface, he)) return *objection;
    if (!isConnected(surface, he))
        return Error{ErrorKind::SeveralComponents, "the surface has more than one component"};
    if (Objection objection = objectionToAreas(surface)) return *objection;
    Topology topology;
    for (int v = 0; v < surface.vertexCount; ++v) topology.vertices += he.outgoing(v) >= 0;
    topology.faces = surface.faceCount();
    topology.edges = he.count() / 2;
    topology.genus = (2 - topology.euler()) / 2;
    return topology;
}

} // namespace gimg

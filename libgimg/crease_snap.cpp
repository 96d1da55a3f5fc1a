#include "crease_snap.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <tuple>

namespace gimg {
namespace {

constexpr double kReach = 0.75;      // lengths of a grid edge that one of its ends moves along it, at most
constexpr double kCornerReach = 0.8; // lengths of the longest edge at a vertex, to a corner
constexpr double kFar = 0.6;         // lengths of a grid edge: creases farther away do not cross it

/// Area-weighted, not of unit length.
std::vector<Vec3> normalsOf(const GridSurface& surface)
{
    std::vector<Vec3> normals(surface.positions().size(), Vec3::Zero());
    for (const Triangle& t : surface.faces()) {
        const Vec3 a = areaVector(surface.positions(), t);
        for (const int v : t) normals[v] += a;
    }
    return normals;
}

template <class Visit> void forEachFaceAt(const GridSurface& surface, int vertex, Visit visit)
{
    for (const int cell : surface.cellsAt(vertex))
        for (const int f : {2 * cell, 2 * cell + 1}) visit(surface.faces()[f]);
}

} // namespace

CreaseSnap::CreaseSnap(GridSurface& surface, const CreaseNet& net, const NearestTree& mesh)
    : surface_(surface), net_(net), mesh_(mesh), mover_(surface, mesh), hold_(surface.positions().size()),
      vertexAt_(net.corners().size(), -1)
{
}

void CreaseSnap::snap()
{
    constexpr int kMostSweeps = 3; // a vertex on a crease makes room for others
    snapCorners();
    for (int sweep = 0; sweep < kMostSweeps && snapCrossings() > 0; ++sweep) {
    }
}

std::vector<GridSurface::Rail> CreaseSnap::rails() const
{
    std::vector<GridSurface::Rail> rails(hold_.size());
    for (size_t v = 0; v < hold_.size(); ++v) {
        if (hold_[v].corner >= 0) rails[v].freedom = GridSurface::Freedom::None;
        if (hold_[v].segment >= 0)
            rails[v] = {GridSurface::Freedom::Along, net_.segments()[hold_[v].segment].direction()};
    }
    return rails;
}

void CreaseSnap::bringBack()
{
    for (int v = 0; v < static_cast<int>(hold_.size()); ++v) {
        if (hold_[v].segment < 0) continue;
        const CreaseNet::Place place = net_.nearestAlong(surface_.positions()[v], hold_[v].segment);
        if (mover_.tryMove(v, place.point, place.point)) hold_[v].segment = place.segment;
    }
}

void CreaseSnap::easeWorst(double negligible)
{
    constexpr int kMostSweeps = 10;
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
        bool eased = false;
        for (const CellMover::Apart& apart : mover_.farthestApart(negligible)) eased = ease(apart) || eased;
        if (!eased) return;
    }
}

/// @return whether it was worth a sweep
bool CreaseSnap::ease(const CellMover::Apart& apart)
{
    constexpr double kWorth = 0.98; // of the error
    bool eased = false;
    const Triangle corners = surface_.faces()[apart.face];
    for (const int v : corners) {
        if (surface_.isFixed(v) || hold_[v].corner >= 0) continue;
        const double before = mover_.errorAt(v, apart.point);
        for (const Vec3& to : placesNear(v, apart.point)) {
            if (to == surface_.positions()[v] || !mover_.tryMove(v, to, apart.point)) continue;
            if (hold_[v].segment >= 0) hold_[v].segment = net_.nearestAlong(to, hold_[v].segment).segment;
        }
        eased = eased || mover_.errorAt(v, apart.point) < kWorth * before;
    }
    return eased;
}

/// A quarter and half of the way to the vertices around, and to the wanted place.
std::vector<Vec3> CreaseSnap::placesNear(int vertex, const Vec3& wanted) const
{
    const Vec3 from = surface_.positions()[vertex];
    std::vector<Vec3> ends = {wanted, from + 2 * (wanted - from)};
    forEachFaceAt(surface_, vertex, [&](const Triangle& t) {
        for (const int v : t)
            if (v != vertex && std::find(ends.begin(), ends.end(), surface_.positions()[v]) == ends.end())
                ends.push_back(surface_.positions()[v]);
    });
    std::vector<Vec3> places;
    int near = 0;
    for (const Vec3& end : ends)
        for (const double part : {0.5, 0.25}) {
            const Vec3 place = from + part * (end - from);
            if (hold_[vertex].segment >= 0) {
                places.push_back(net_.nearestAlong(place, hold_[vertex].segment).point);
            } else {
                near = mesh_.nearest(place, near).face;
                places.push_back(mesh_.pointOfFace(near, mesh_.nearestOnFace(place, near)));
            }
        }
    return places;
}

int CreaseSnap::onCreases() const
{
    const auto on = [](const Hold& h) { return h.segment >= 0; };
    return static_cast<int>(std::count_if(hold_.begin(), hold_.end(), on));
}

int CreaseSnap::onCorners() const
{
    const auto there = [](int v) { return v >= 0; };
    return static_cast<int>(std::count_if(vertexAt_.begin(), vertexAt_.end(), there));
}

int CreaseSnap::crossings() const { return static_cast<int>(findCrossings().size()); }

void CreaseSnap::snapCorners()
{
    for (const Want& want : wantsOfCorners()) {
        if (vertexAt_[want.corner] >= 0 || hold_[want.vertex].corner >= 0) continue;
        if (want.distance > kCornerReach * longestEdgeAt(want.vertex)) continue;
        const Vec3& at = net_.corners()[want.corner].at;
        if (!mover_.tryMove(want.vertex, at, at)) continue;
        hold_[want.vertex] = {-1, want.corner};
        vertexAt_[want.corner] = want.vertex;
    }
}

/// Nearest first: the vertices around the nearest triangle, of those that face as the corner does.
std::vector<CreaseSnap::Want> CreaseSnap::wantsOfCorners() const
{
    const std::vector<Vec3>& x = surface_.positions();
    const NearestTree tree(x, surface_.faces());
    const std::vector<Vec3> normals = normalsOf(surface_);
    std::vector<Want> wants;
    for (int c = 0; c < static_cast<int>(vertexAt_.size()); ++c) {
        if (vertexAt_[c] >= 0) continue;
        const CreaseNet::Corner& corner = net_.corners()[c];
        for (const int u : surface_.faces()[tree.nearest(corner.at, 0).face])
            forEachFaceAt(surface_, u, [&](const Triangle& t) {
                for (const int v : t)
                    if (!surface_.isFixed(v) && hold_[v].corner < 0 && normals[v].dot(corner.outwards) > 0)
                        wants.push_back({(x[v] - corner.at).norm(), c, v});
            });
    }
    std::sort(wants.begin(), wants.end(), [](const Want& a, const Want& b) {
        return std::tie(a.distance, a.corner, a.vertex) < std::tie(b.distance, b.corner, b.vertex);
    });
    return wants;
}

double CreaseSnap::longestEdgeAt(int vertex) const
{
    double longest = 0;
    forEachFaceAt(surface_, vertex, [&](const Triangle& t) {
        if (std::find(t.begin(), t.end(), vertex) == t.end()) return;
        for (const int v : t)
            longest = std::max(longest, (surface_.positions()[v] - surface_.positions()[vertex]).norm());
    });
    return longest;
}

/// @return how many vertices moved
int CreaseSnap::snapCrossings()
{
    int count = 0;
    for (const Crossing& c : findCrossings()) {
        const int chain = net_.segments()[c.place.segment].chain;
        if (lies(c.vertex, chain) || lies(c.other, chain)) continue;
        for (const auto& [v, reach] : {std::pair(c.vertex, c.reach), {c.other, c.otherReach}}) {
            if (!isFree(v) || reach > kReach || !mover_.tryMove(v, c.place.point, c.place.point)) continue;
            hold_[v].segment = c.place.segment;
            ++count;
            break;
        }
    }
    return count;
}

/// Of the decoder's triangles; those first that one of the ends is closest to.
std::vector<CreaseSnap::Crossing> CreaseSnap::findCrossings() const
{
    const std::vector<Triangle>& faces = surface_.faces();
    const std::vector<Vec3> normals = normalsOf(surface_);
    std::vector<std::optional<Crossing>> found(3 * faces.size());
    tbb::parallel_for(tbb::blocked_range<size_t>(0, faces.size(), 256),
                      [&](const tbb::blocked_range<size_t>& range) {
                          for (size_t f = range.begin(); f < range.end(); ++f)
                              for (int k = 0; k < 3; ++k) {
                                  const int a = faces[f][k], b = faces[f][(k + 1) % 3];
                                  if (a < b) found[3 * f + k] = crossing(normals, a, b);
                              }
                      });
    std::vector<Crossing> crossings;
    for (const std::optional<Crossing>& c : found)
        if (c) crossings.push_back(*c);
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
        return std::tie(a.reach, a.vertex, a.other) < std::tie(b.reach, b.vertex, b.other);
    });
    return crossings;
}

std::optional<CreaseSnap::Crossing> CreaseSnap::crossing(const std::vector<Vec3>& normals, int a, int b) const
{
    const Vec3 &from = surface_.positions()[a], edge = surface_.positions()[b] - from;
    const double length = edge.norm();
    if (!(length > 0)) return std::nullopt;
    Vec3 on = from + edge / 2;
    CreaseNet::Place place = net_.nearest(on);
    if ((place.point - on).norm() > length) return std::nullopt;
    for (int k = 0; k < 3; ++k) { // to where the two are closest
        on = from + std::clamp(edge.dot(place.point - from) / (length * length), 0.0, 1.0) * edge;
        place = net_.nearestAlong(on, place.segment);
    }
    const CreaseNet::Segment& s = net_.segments()[place.segment];
    if ((place.point - on).norm() > kFar * length) return std::nullopt;
    // The other side of a thin plate faces away.
    if (!((normals[a] + normals[b]).dot(s.outwards) > 0)) return std::nullopt;
    const double overA = s.side.dot(from - place.point), overB = s.side.dot(from + edge - place.point);
    if (!(overA * overB < 0) || lies(a, s.chain) || lies(b, s.chain)) return std::nullopt;
    const double reachA = (place.point - from).norm() / length,
                 reachB = (place.point - from - edge).norm() / length;
    if (reachB < reachA) return Crossing{b, a, place, reachB, reachA};
    return Crossing{a, b, place, reachA, reachB};
}

bool CreaseSnap::lies(int vertex, int chain) const
{
    const Hold& h = hold_[vertex];
    if (h.segment >= 0) return net_.segments()[h.segment].chain == chain;
    if (h.corner < 0) return false;
    const std::vector<int>& chains = net_.corners()[h.corner].chains;
    return std::find(chains.begin(), chains.end(), chain) != chains.end();
}

} // namespace gimg

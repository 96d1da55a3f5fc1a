#include "gimg/topology_noise.h"

#include "editable_surface.h"
#include "polygon_triangulator.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>

namespace gimg {
namespace {

// Sides of a crack that are written in few digits differ in the last one.
constexpr double kSamePlace = 1e-6; // of the diagonal

using Ring = std::vector<int>; // the boundary halfedges of a loop, in order

std::vector<Ring> boundaryRings(const EditableSurface& surface)
{
    std::vector<int> leaving(static_cast<size_t>(surface.vertexCount()), -1);
    for (int h = 0; h < surface.halfedgeCount(); ++h)
        if (surface.twin(h) < 0) leaving[surface.tail(h)] = h;
    std::vector<Ring> rings;
    for (int start = 0; start < surface.halfedgeCount(); ++start) {
        if (surface.twin(start) >= 0 || leaving[surface.tail(start)] < 0) continue;
        Ring& ring = rings.emplace_back();
        for (int h = start; h >= 0; h = leaving[surface.head(h)]) {
            leaving[surface.tail(h)] = -1;
            ring.push_back(h);
        }
    }
    return rings;
}

class HoleCloser
{
public:
    explicit HoleCloser(const Mesh& mesh) : surface_(mesh), diagonal_(boundingBoxDiagonal(mesh)) {}

    HoleClosing run(double maxLength)
    {
        struct Hole
        {
            ClosedHole report;
            Ring ring;
        };
        std::vector<Hole> holes;
        for (Ring& ring : boundaryRings(surface_))
            if (ClosedHole hole = described(ring); hole.length <= maxLength)
                holes.push_back({hole, std::move(ring)});
        std::stable_sort(holes.begin(), holes.end(),
                         [](const Hole& a, const Hole& b) { return a.report.length < b.report.length; });
        HoleClosing result;
        std::vector<Ring> open;
        for (Hole& hole : holes) {
            hole.report.zipped = zip(hole.ring);
            result.holes.push_back(hole.report);
            if (!hole.ring.empty()) open.push_back(std::move(hole.ring));
        }
        if (!open.empty()) fillAll(open);
        result.mesh = surface_.mesh();
        return result;
    }

private:
    ClosedHole described(const Ring& ring) const
    {
        ClosedHole hole;
        hole.edges = static_cast<int>(ring.size());
        for (int h : ring) {
            hole.length += surface_.length(h);
            hole.at += surface_.position(surface_.tail(h)) / static_cast<double>(ring.size());
        }
        hole.fraction = hole.length / diagonal_;
        return hole;
    }

    // Wherever two edges of the ring that follow each other lie on each other, they become one.
    int zip(Ring& ring)
    {
        int zipped = 0;
        for (size_t i = 0, missed = 0; ring.size() >= 4 && missed < ring.size();) {
            const size_t n = ring.size();
            i %= n;
            const int arriving = ring[i], leaving = ring[(i + 1) % n];
            if (!canZip(ring, arriving, leaving)) {
                ++i, ++missed;
                continue;
            }
            surface_.merge(surface_.head(leaving), surface_.tail(arriving));
            surface_.glue(arriving, leaving);
            ++zipped;
            if (n == 4) {
                surface_.glue(ring[(i + 2) % n], ring[(i + 3) % n]);
                ring.clear();
                return zipped + 1;
            }
            ring.erase(ring.begin() + static_cast<std::ptrdiff_t>((i + 1) % n));
            ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(i + 1 == n ? i - 1 : i));
            i = i == 0 ? ring.size() - 1 : i - 1; // the edges on both sides of these two meet now
            missed = 0;
        }
        return zipped;
    }

    // Merging must not make two edges between the same vertices; the two edges themselves are to become one.
    bool canZip(const Ring& ring, int arriving, int leaving) const
    {
        const int a = surface_.tail(arriving), tip = surface_.head(arriving), b = surface_.head(leaving);
        if ((surface_.position(a) - surface_.position(b)).norm() > kSamePlace * diagonal_) return false;
        std::set<int> around;
        surface_.forEachEdgeAt(a, [&](int, int w) { around.insert(w); });
        if (around.count(b) > 0) return false;
        int shared = 0;
        surface_.forEachEdgeAt(b, [&](int, int w) { shared += w != tip && around.count(w) > 0; });
        return shared == (ring.size() == 4 ? 1 : 0); // of four edges the other two become one as well
    }

    void fillAll(const std::vector<Ring>& rings)
    {
        PolygonSoup soup;
        for (int v = 0; v < surface_.vertexCount(); ++v) soup.positions.push_back(surface_.position(v));
        const auto add = [&](const Ring& polygon) {
            for (int h : polygon) soup.corners.push_back(surface_.tail(h));
            soup.endFace();
        };
        for (int h = 0; h < surface_.halfedgeCount(); h += 3) add({h, h + 1, h + 2});
        for (const Ring& ring : rings) add({ring.rbegin(), ring.rend()});
        PolygonTriangulator triangulator(soup); // knows all edges, so as not to double one
        for (const Ring& ring : rings) fill(ring, triangulator);
    }

    void fill(const Ring& ring, PolygonTriangulator& triangulator)
    {
        std::vector<int> polygon;
        for (size_t i = ring.size(); i-- > 0;) polygon.push_back(surface_.tail(ring[i]));
        std::vector<Triangle> faces;
        triangulator.append(polygon, faces);
        if (!fits(faces, ring)) faces = fan(polygon);
        std::map<std::pair<int, int>, int> open; // halfedges that wait for their twin
        for (int h : ring) open[{surface_.tail(h), surface_.head(h)}] = h;
        for (const Triangle& t : faces) {
            const int first = surface_.addFace(t);
            for (int h = first; h < first + 3; ++h) {
                const auto twin = open.find({surface_.head(h), surface_.tail(h)});
                if (twin == open.end()) {
                    open[{surface_.tail(h), surface_.head(h)}] = h;
                } else {
                    surface_.glue(h, twin->second);
                    open.erase(twin);
                }
            }
        }
    }

    // Whether no edge within the hole repeats one of the surface, and no face a face.
    bool fits(const std::vector<Triangle>& faces, const Ring& ring) const
    {
        if (ring.size() == 3) return ring[0] / 3 != ring[1] / 3 || ring[1] / 3 != ring[2] / 3;
        std::set<std::pair<int, int>> edges;
        for (int h : ring) edges.insert(std::minmax(surface_.tail(h), surface_.head(h)));
        for (const Triangle& t : faces)
            for (int k = 0; k < 3; ++k) {
                const int v = t[k], w = t[(k + 1) % 3];
                if (edges.count(std::minmax(v, w)) == 0 && surface_.areAdjacent(v, w)) return false;
            }
        return true;
    }

    std::vector<Triangle> fan(const std::vector<int>& polygon)
    {
        Vec3 centre = Vec3::Zero();
        for (int v : polygon) centre += surface_.position(v) / static_cast<double>(polygon.size());
        const int middle = surface_.addVertex(centre);
        std::vector<Triangle> faces;
        for (size_t i = 0; i < polygon.size(); ++i)
            faces.push_back({polygon[i], polygon[(i + 1) % polygon.size()], middle});
        return faces;
    }

    EditableSurface surface_;
    double diagonal_;
};

} // namespace

Result<HoleClosing> closeHoles(const Mesh& mesh, double maxLength)
{
    if (!(maxLength >= 0)) return Error{ErrorKind::BadArgument, "the longest hole has no length >= 0"};
    return HoleCloser(mesh).run(maxLength);
}

} // namespace gimg

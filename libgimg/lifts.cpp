#include "lifts.h"

#include "stretch_element.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <string>
#include <unordered_map>

namespace gimg {
namespace {

constexpr double kMargin = 1e-10; // what touches the square's border from outside is not inside

bool insideSquare(const Vec2& p) { return p.minCoeff() >= 0 && p.maxCoeff() <= 1; }

// Whether a piece of the segment lies inside the square.
bool crossesSquare(const Vec2& a, const Vec2& b)
{
    double enter = 0, leave = 1;
    for (int c = 0; c < 2; ++c) {
        const double along = b[c] - a[c];
        const double low = kMargin - a[c], high = 1 - kMargin - a[c];
        if (along == 0) {
            if (low > 0 || high < 0) return false;
            continue;
        }
        enter = std::max(enter, std::min(low / along, high / along));
        leave = std::min(leave, std::max(low / along, high / along));
    }
    return enter < leave;
}

double areaInSquare(const std::array<Vec2, 3>& corner)
{
    std::vector<Vec2> polygon(corner.begin(), corner.end());
    for (int c = 0; c < 2; ++c)
        for (double bound : {0.0, 1.0}) {
            const double keep = bound == 0 ? 1 : -1;
            std::vector<Vec2> kept;
            for (size_t i = 0; i < polygon.size(); ++i) {
                const Vec2 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
                const double dp = keep * (p[c] - bound), dq = keep * (q[c] - bound);
                if (dp >= 0) kept.push_back(p);
                if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) kept.push_back(p + dp / (dp - dq) * (q - p));
            }
            polygon = std::move(kept);
        }
    double doubled = 0;
    for (size_t i = 1; i + 1 < polygon.size(); ++i)
        doubled += doubleArea({polygon[0], polygon[i], polygon[i + 1]});
    return doubled / 2;
}

// A face at the vertex farthest, in edges, from the border.
int deepestFace(const SquareDisk& square)
{
    const Mesh& disk = square.disk.mesh;
    const Halfedges he(disk.faces, disk.vertexCount());
    std::vector<bool> seen(disk.faces.size(), false);
    std::queue<int> queue;
    for (int h = 0; h < he.count(); ++h)
        if (square.squareSides[he.tail(h)] != 0 && !seen[Halfedges::face(h)]) {
            seen[Halfedges::face(h)] = true;
            queue.push(Halfedges::face(h));
        }
    int last = 0;
    while (!queue.empty()) {
        last = queue.front();
        queue.pop();
        for (int h = 3 * last; h < 3 * last + 3; ++h) {
            if (he.onBoundary(h) || seen[Halfedges::face(he.twin(h))]) continue;
            seen[Halfedges::face(he.twin(h))] = true;
            queue.push(Halfedges::face(he.twin(h)));
        }
    }
    return last;
}

// The motions under which each face was found; few faces have more than one.
class FoundLifts
{
public:
    explicit FoundLifts(size_t faces) : first_(faces), any_(faces, false) {}
    bool insert(const Lift& lift)
    {
        if (!any_[lift.face]) {
            any_[lift.face] = true;
            first_[lift.face] = lift.motion;
            return true;
        }
        if (first_[lift.face] == lift.motion) return false;
        std::vector<GridMotion>& more = more_[lift.face];
        if (std::find(more.begin(), more.end(), lift.motion) != more.end()) return false;
        more.push_back(lift.motion);
        return true;
    }

private:
    std::vector<GridMotion> first_;
    std::vector<bool> any_;
    std::unordered_map<int, std::vector<GridMotion>> more_;
};

// Where a walk may begin: a seam that slid far has taken the disk with it, and then a face over the square is
// one that some motions across the seam have brought back.
std::vector<GridMotion> shortMotions(const BorderTies& ties)
{
    std::vector<GridMotion> steps, words = {{}};
    const auto isNew = [](const std::vector<GridMotion>& list, const GridMotion& m) {
        return std::find(list.begin(), list.end(), m) == list.end();
    };
    for (const GridMotion& m : ties.across)
        if (!(m == GridMotion{}) && (steps.empty() || !(m == steps.back())) && isNew(steps, m))
            steps.push_back(m);
    constexpr size_t kMost = 400;
    for (size_t i = 0; i < words.size() && words.size() < kMost; ++i)
        for (const GridMotion& step : steps)
            if (const GridMotion longer = words[i] * step; isNew(words, longer)) words.push_back(longer);
    return words;
}

class Walk
{
public:
    Walk(const SquareDisk& square, const BorderTies& ties, const std::vector<Vec2>& st)
        : disk_(square.disk.mesh), surface_(square.surface.faces, square.surface.vertexCount()), ties_(ties),
          st_(st)
    {
    }

    std::array<Vec2, 3> corners(const Lift& lift) const
    {
        const Triangle& f = disk_.faces[lift.face];
        return {lift.motion(st_[f[0]]), lift.motion(st_[f[1]]), lift.motion(st_[f[2]])};
    }

    // All lifts that can be reached from the first. Returns how many faces do not lie over the square once,
    // and one more where all together do not fill it.
    int run(const Lift& first, std::vector<Lift>& lifts) const
    {
        lifts = {first};
        FoundLifts found(disk_.faces.size());
        found.insert(first);
        std::vector<double> covered(disk_.faces.size(), 0.0);
        const size_t most = 4 * disk_.faces.size() + 1000; // a wrong start may walk without end
        for (size_t i = 0; i < lifts.size() && lifts.size() < most; ++i) {
            const Lift lift = lifts[i];
            const std::array<Vec2, 3> p = corners(lift);
            const bool whole = insideSquare(p[0]) && insideSquare(p[1]) && insideSquare(p[2]);
            covered[lift.face] += whole ? doubleArea(p) / 2 : areaInSquare(p);
            for (int k = 0; k < 3; ++k) {
                const int h = 3 * lift.face + k;
                if (surface_.onBoundary(h) || !crossesSquare(p[k], p[(k + 1) % 3])) continue;
                const Lift next{Halfedges::face(surface_.twin(h)), lift.motion * ties_.across[h]};
                if (found.insert(next)) lifts.push_back(next);
            }
        }
        int bad = 0;
        double total = 0;
        for (double area : covered) total += area;
        if (!(std::abs(total - 1) < 1e-6)) ++bad;
        for (size_t f = 0; f < covered.size(); ++f) {
            const double area = doubleArea(corners({static_cast<int>(f), {}})) / 2;
            bad += !(std::abs(covered[f] - area) <= 1e-6 * area + 10 * kMargin);
        }
        return bad;
    }

private:
    const Mesh& disk_;
    const Halfedges surface_;
    const BorderTies& ties_;
    const std::vector<Vec2>& st_;
};

} // namespace

Result<std::vector<Lift>> liftsOverSquare(const SquareDisk& square, const BorderTies& ties,
                                          const std::vector<Vec2>& st)
{
    const Walk walk(square, ties, st);
    const int deepest = deepestFace(square);
    int fewest = square.disk.mesh.faceCount();
    for (const GridMotion& motion : shortMotions(ties)) {
        const std::array<Vec2, 3> p = walk.corners({deepest, motion});
        if (!insideSquare((p[0] + p[1] + p[2]) / 3)) continue;
        std::vector<Lift> lifts;
        const int bad = walk.run({deepest, motion}, lifts);
        if (bad == 0) return lifts;
        fewest = std::min(fewest, bad);
    }
    return Error{ErrorKind::FlippedTriangle,
                 std::to_string(fewest) + " triangles do not lie over the square once"};
}

} // namespace gimg

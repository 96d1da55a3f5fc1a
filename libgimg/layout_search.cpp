#include "layout_search.h"

#include "border_layout.h"
#include "curvature_importance.h"
#include "gimg/flatten.h"
#include "hierarchy.h"
#include "layout_model.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <queue>

namespace gimg {
namespace {

constexpr int kInside = 300; // vertices left off the cut: layouts rank as they do with thousands
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct CutSurface
{
    Mesh mesh;
    CutGraph cut;
    std::vector<double> importance; // per vertex: the squared curvatureImportance around it
};

// Means over the part of the mesh that is nearer, along edges, to one of `vertexOf` than to the others.
std::vector<double> meansAround(const Mesh& mesh, const std::vector<int>& vertexOf,
                                const std::vector<double>& value)
{
    const Halfedges he(mesh.faces, mesh.vertexCount());
    std::vector<double> area(mesh.positions.size(), 0.0);
    std::vector<std::vector<int>> neighbours(mesh.positions.size());
    for (int h = 0; h < he.count(); ++h) {
        const Triangle& f = mesh.faces[h / 3];
        const Vec3 &a = mesh.positions[f[0]], &b = mesh.positions[f[1]], &c = mesh.positions[f[2]];
        area[he.tail(h)] += (b - a).cross(c - a).norm();
        neighbours[he.tail(h)].push_back(he.head(h));
        if (he.onBoundary(h)) neighbours[he.head(h)].push_back(he.tail(h));
    }
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    std::vector<double> distance(mesh.positions.size(), kInfinity);
    std::vector<size_t> nearest(mesh.positions.size());
    for (size_t i = 0; i < vertexOf.size(); ++i) {
        distance[vertexOf[i]] = 0;
        nearest[vertexOf[i]] = i;
        queue.push({0.0, vertexOf[i]});
    }
    std::vector<double> sum(vertexOf.size(), 0.0), total(vertexOf.size(), 0.0);
    while (!queue.empty()) {
        const auto [d, v] = queue.top();
        queue.pop();
        if (d > distance[v]) continue;
        sum[nearest[v]] += area[v] * value[v];
        total[nearest[v]] += area[v];
        for (int w : neighbours[v]) {
            const double farther = d + (mesh.positions[w] - mesh.positions[v]).norm();
            if (farther >= distance[w]) continue;
            distance[w] = farther;
            nearest[w] = nearest[v];
            queue.push({farther, w});
        }
    }
    for (size_t i = 0; i < sum.size(); ++i) sum[i] = total[i] > 0 ? sum[i] / total[i] : 1;
    return sum;
}

// The cut stays as it is, edge by edge, so that layouts of one surface are layouts of the other.
CutSurface simplifyAround(const Mesh& mesh, const CutGraph& cut, int inside)
{
    std::vector<uint8_t> onCut(mesh.positions.size(), 0);
    for (const CutPath& path : cut.paths)
        for (int v : path.vertices) onCut[v] = 1;
    Hierarchy hierarchy(mesh, onCut);
    hierarchy.coarsenTo(inside);
    std::vector<int> vertexOf;
    CutSurface coarse{hierarchy.current(vertexOf), cut, {}};
    std::vector<double> squared = curvatureImportance(mesh, BorderOptions::kDefaultGrid);
    for (double& w : squared) w *= w;
    coarse.importance = meansAround(mesh, vertexOf, squared);
    std::vector<int> index(mesh.positions.size(), -1);
    for (size_t i = 0; i < vertexOf.size(); ++i) index[vertexOf[i]] = static_cast<int>(i);
    for (CutPath& path : coarse.cut.paths)
        for (int& v : path.vertices) v = index[v];
    return coarse;
}

// Vertices that laying out has put on edges take the mean of those around them.
std::vector<double> extended(std::vector<double> importance, const Mesh& mesh)
{
    const size_t known = importance.size();
    std::vector<double> count(mesh.positions.size(), 0.0);
    importance.resize(mesh.positions.size(), 0.0);
    for (const Triangle& f : mesh.faces)
        for (int v : f)
            for (int w : f)
                if (static_cast<size_t>(v) >= known && static_cast<size_t>(w) < known) {
                    importance[v] += importance[w];
                    ++count[v];
                }
    for (size_t v = known; v < importance.size(); ++v)
        importance[v] = count[v] > 0 ? importance[v] / count[v] : 1;
    return importance;
}

class LayoutSearch
{
public:
    LayoutSearch(const Mesh& mesh, const CutGraph& cut)
        : coarse_(simplifyAround(mesh, cut, kInside)), disk_(openAlong(coarse_.mesh, coarse_.cut)),
          needs_(pathNeeds(cut))
    {
    }

    ImprovedLayout run(const BorderLayout& first) const
    {
        constexpr double kWorth = 0.95;       // of the energy: less gain than that shows in no decibels
        constexpr double kAlignedLoss = 1.01; // that multiples of 2 and 4 may cost
        if (!disk_) return {first};
        const Judged begin = judge(first);
        if (!begin.model) return {first};
        const int side = first.lowest - 1;
        Judged best = begin;
        turn(best, std::max(1, side / 16));
        tryEach(flatTori(first), best);
        descend(best, 1, 6);
        if (best.energy > kWorth * begin.energy) return {first};
        for (int unit : {2, 4}) {
            Judged even = aligned(best, unit);
            if (even.energy > kAlignedLoss * best.energy) break;
            best = std::move(even);
        }
        return {best.layout, best.energy / begin.energy};
    }

private:
    struct Judged
    {
        BorderLayout layout;
        double energy = kInfinity;
        std::shared_ptr<const LayoutModel> model;
    };

    Judged judge(const BorderLayout& layout) const
    {
        Judged judged{layout, kInfinity, nullptr};
        const Result<SquareDisk> square =
            layOutBorder(coarse_.mesh, coarse_.cut, layout, BorderOptions::kDefaultGrid);
        if (!square) return judged;
        const std::vector<double> importance = extended(coarse_.importance, square->surface);
        const Result<Parameterization> map = flattenToSquare(*square, importance, {}, FlattenEffort::Trial);
        if (!map) return judged;
        judged.model = std::make_shared<LayoutModel>(*square, importance, map->st);
        judged.energy = judged.model->energy();
        return judged;
    }

    bool isAllowed(const BorderLayout& layout) const
    {
        for (size_t p = 0; p < needs_.size(); ++p)
            if (layout.pathLength[p] < needs_[p].minimum) return false;
        return isSound(layout, *disk_, coarse_.cut);
    }

    void tryEach(const std::vector<BorderLayout>& layouts, Judged& best) const
    {
        std::vector<Judged> tried(layouts.size());
        tbb::parallel_for(size_t{0}, tried.size(), [&](size_t i) {
            if (isAllowed(layouts[i])) tried[i] = judge(layouts[i]);
        });
        for (Judged& t : tried)
            if (t.energy < best.energy) best = std::move(t);
    }

    // All starts at multiples of `step` within a side; the square looks the same from each side.
    void turn(Judged& best, int step) const
    {
        std::vector<BorderLayout> turned;
        const int side = best.layout.lowest - 1;
        for (int start = 0; start < side; start += step) {
            if (start == best.layout.start % side) continue;
            turned.push_back(best.layout);
            turned.back().start = start;
        }
        tryEach(turned, best);
    }

    // A torus may be laid out without any cone point: opposite sides of the square are mates. One path takes
    // a side, the others share the next.
    std::vector<BorderLayout> flatTori(const BorderLayout& like) const
    {
        std::vector<BorderLayout> flat;
        const std::vector<DiskSide>& sides = disk_->sides;
        const size_t paths = needs_.size();
        if (sides.size() != 2 * paths || paths < 2 || paths > 3) return flat;
        for (size_t i = 0; i < paths; ++i)
            if (sides[i].path != sides[i + paths].path) return flat;
        const int side = like.lowest - 1;
        for (size_t i = 0; i < paths; ++i) {
            BorderLayout layout = like;
            const int alone = sides[i].path, next = sides[i + 1].path, last = sides[i + paths - 1].path;
            layout.pathLength[alone] = layout.pathLength[next] = side;
            if (next != last) {
                const double share = like.pathLength[next] + like.pathLength[last];
                layout.pathLength[next] = static_cast<int>(std::lround(side * like.pathLength[next] / share));
                layout.pathLength[last] = side - layout.pathLength[next];
            }
            layout.start = 4 * side;
            for (size_t k = 0; k < i; ++k) layout.start -= layout.pathLength[sides[k].path];
            layout.start %= 4 * side;
            flat.push_back(std::move(layout));
        }
        return flat;
    }

    // Lengths and start one unit to or fro: all layouts next to this one.
    template <class Visit> void forNeighbours(const BorderLayout& at, int unit, Visit visit) const
    {
        const int paths = static_cast<int>(needs_.size()), perimeter = 4 * (at.lowest - 1);
        BorderLayout next = at;
        for (int by : {-unit, unit}) {
            next.start = (at.start + by + perimeter) % perimeter;
            visit(next);
        }
        next = at;
        for (int p = 0; p < paths; ++p)
            for (int q = 0; q < paths; ++q) {
                if (p == q) continue;
                const bool same = needs_[p].multiplicity == needs_[q].multiplicity;
                next.pathLength[p] += unit * (same ? 1 : needs_[q].multiplicity);
                next.pathLength[q] -= unit * (same ? 1 : needs_[p].multiplicity);
                if (next.pathLength[q] >= needs_[q].minimum) visit(next);
                next.pathLength[p] = at.pathLength[p];
                next.pathLength[q] = at.pathLength[q];
            }
    }

    // The model's best layout within `moves` moves of `from`, not among the ones that failed.
    BorderLayout proposal(const Judged& from, int unit, int moves,
                          const std::vector<BorderLayout>& failed) const
    {
        BorderLayout at = from.layout;
        double lowest = kInfinity;
        for (int move = 0; move < moves; ++move) {
            BorderLayout best = at;
            double found = lowest;
            forNeighbours(at, unit, [&](const BorderLayout& next) {
                const std::optional<double> energy = from.model->energy(next);
                if (!energy || *energy >= found) return;
                if (std::find(failed.begin(), failed.end(), next) != failed.end() || !isAllowed(next)) return;
                found = *energy;
                best = next;
            });
            if (found >= lowest) break;
            lowest = found;
            at = best;
        }
        return at;
    }

    // Lengths and start at multiples of `unit`; an energy of infinity where there is no such layout.
    Judged aligned(const Judged& best, int unit) const
    {
        Judged found{best.layout, kInfinity, nullptr};
        std::vector<PathNeeds> needs = needs_;
        for (size_t p = 0; p < needs.size(); ++p) {
            needs[p].target = static_cast<double>(best.layout.pathLength[p]) / unit;
            needs[p].minimum = (needs[p].minimum + unit - 1) / unit;
        }
        int least = 0;
        for (const PathNeeds& need : needs) least += 2 * unit * need.multiplicity * need.minimum;
        if (least > 4 * (best.layout.lowest - 1)) return found; // hardly any choice is left
        const auto lengths = roundLengths(needs, 4 * (best.layout.lowest - 1) / unit);
        if (!lengths) return found;
        for (size_t p = 0; p < needs.size(); ++p) found.layout.pathLength[p] = unit * (*lengths)[p];
        const int perimeter = 4 * (best.layout.lowest - 1);
        found.layout.start = (best.layout.start + unit / 2) / unit * unit % perimeter;
        if (isAllowed(found.layout)) found = judge(found.layout);
        turn(found, std::max(unit, (best.layout.lowest - 1) / 8));
        if (found.model) descend(found, unit, 4);
        return found;
    }

    // At most `flattenings` of them.
    void descend(Judged& best, int unit, int flattenings) const
    {
        std::vector<BorderLayout> failed = {best.layout};
        for (int moves = 4; flattenings > 0; --flattenings) {
            const BorderLayout next = proposal(best, unit, moves, failed);
            if (next == best.layout) return;
            Judged tried = judge(next);
            if (tried.energy < best.energy) {
                best = std::move(tried);
            } else {
                failed.push_back(next);
                moves = std::max(1, moves / 2);
            }
        }
    }

    const CutSurface coarse_;
    const Result<DiskMesh> disk_;
    const std::vector<PathNeeds> needs_;
};

} // namespace

ImprovedLayout improveLayout(const Mesh& mesh, const CutGraph& cut, const BorderLayout& first)
{
    return LayoutSearch(mesh, cut).run(first);
}

} // namespace gimg

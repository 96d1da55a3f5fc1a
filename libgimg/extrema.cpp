#include "gimg/extrema.h"

#include "curvature_importance.h"
#include "gimg/cut.h"
#include "gimg/stretch.h"
#include "hierarchy.h"
#include "one_solver_thread.h"

#include <tbb/parallel_for_each.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace gimg {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kKept = 0.95; // of the energy; smaller gains are within what another layout would change

double flattenedEnergy(const Mesh& mesh, const CutGraph& cut, SquareLayout layout, FlattenEffort effort)
{
    BorderOptions options;
    options.layout = layout;
    const Result<SquareDisk> square = layOutBorder(mesh, cut, options);
    if (!square) return kInfinity;
    const Result<Parameterization> map =
        flattenToSquare(*square, curvatureImportance(square->surface, square->grid), {}, effort);
    return map ? quarticStretchEnergy(square->disk.mesh, map->st) : kInfinity;
}

struct Candidate
{
    int vertex;
    CutGraph cut; // extended to it
    double energy;
};

class FarthestVertex
{
public:
    explicit FarthestVertex(const Mesh& mesh) : mesh_(mesh), he_(mesh.faces, mesh.vertexCount()) {}

    // The vertex farthest along edges from the cut and from the vertices `others`; -1 if there is no other.
    int from(const CutGraph& cut, const std::vector<int>& others) const
    {
        std::vector<int> sources = others;
        for (const CutPath& path : cut.paths)
            sources.insert(sources.end(), path.vertices.begin(), path.vertices.end());
        return from(sources);
    }

    int from(const std::vector<int>& sources) const
    {
        std::vector<double> distance(mesh_.positions.size(), kInfinity);
        using Entry = std::pair<double, int>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        const auto reach = [&](int v, double d) {
            if (d >= distance[v]) return;
            distance[v] = d;
            queue.push({d, v});
        };
        for (int v : sources) reach(v, 0);
        int last = -1;
        while (!queue.empty()) {
            const auto [d, v] = queue.top();
            queue.pop();
            if (d > distance[v]) continue;
            if (d > 0) last = v;
            const int first = he_.outgoing(v);
            for (int h = first; h >= 0;) {
                for (int w : {he_.head(h), he_.tail(Halfedges::prev(h))})
                    reach(w, d + (mesh_.positions[w] - mesh_.positions[v]).norm());
                h = he_.rotateCcw(h);
                if (h == first) break;
            }
        }
        return last;
    }

private:
    const Mesh& mesh_;
    const Halfedges he_;
};

} // namespace

SimplifiedMesh simplify(const Mesh& mesh, int faces)
{
    std::vector<uint8_t> onBoundary(mesh.positions.size(), 0);
    const Halfedges he(mesh.faces, mesh.vertexCount());
    for (int h = 0; h < he.count(); ++h)
        if (he.onBoundary(h)) onBoundary[he.tail(h)] = onBoundary[he.head(h)] = 1;
    Hierarchy hierarchy(mesh, onBoundary);
    hierarchy.coarsenTo(faces / 2);
    SimplifiedMesh coarse;
    coarse.mesh = hierarchy.current(coarse.vertexOf);
    return coarse;
}

Extrema findExtrema(const Mesh& mesh, const ExtremaOptions& options, const Progress& progress)
{
    return findExtrema(simplify(mesh, options.faces), options, progress);
}

Extrema findExtrema(const SimplifiedMesh& simplified, const ExtremaOptions& options, const Progress& progress)
{
    constexpr double kTypicalCandidates = 8; // tells progress no more than roughly
    constexpr int kNone = -1;
    const Mesh& coarse = simplified.mesh;
    const FarthestVertex farthest(coarse);
    Extrema found;
    CutGraph cut = cutToDisk(coarse);
    std::vector<int> failed;
    double tried = 0;
    const OneSolverThread oneThread; // each
    const auto judge = [&](Candidate& candidate) {
        std::vector<int> vertices = found.vertices;
        if (candidate.vertex != kNone) vertices.push_back(candidate.vertex);
        candidate.cut = cutToDisk(coarse, vertices);
        candidate.energy = flattenedEnergy(coarse, candidate.cut, SquareLayout::Cut, options.effort);
    };
    // Most candidates fail, so the next one is tried at the same time as if this one did; the first, at the
    // same time as the cut without any.
    const int atOnce = tbb::this_task_arena::max_concurrency() > 1 ? 2 : 1;
    int rejections = 0;
    const auto next = [&](std::vector<Candidate> candidates) {
        std::vector<int> passed = failed;
        for (int left =
                 std::min(options.rejections - rejections, atOnce - static_cast<int>(candidates.size()));
             left > 0; --left) {
            const int vertex = farthest.from(cut, passed);
            if (vertex < 0) break;
            candidates.push_back({vertex, {}, 0});
            passed.push_back(vertex);
        }
        tbb::parallel_for_each(candidates, judge);
        return candidates;
    };
    std::vector<Candidate> candidates = next({{kNone, cut, 0}});
    found.energyWithout = found.energyWith = candidates[0].energy;
    candidates.erase(candidates.begin());
    while (std::isfinite(found.energyWith) && static_cast<int>(found.vertices.size()) < options.most) {
        for (Candidate& candidate : candidates) {
            ++tried;
            if (candidate.energy < kKept * found.energyWith) {
                found.vertices.push_back(candidate.vertex);
                found.energyWith = candidate.energy;
                cut = std::move(candidate.cut);
                rejections = 0;
                break; // the other one was for another cut
            }
            failed.push_back(candidate.vertex);
            ++rejections;
        }
        if (progress) progress(1 - kTypicalCandidates / (kTypicalCandidates + tried));
        candidates = next({});
        if (candidates.empty()) break;
    }
    for (int& v : found.vertices) v = simplified.vertexOf[v];
    return found;
}

StarTips findStarTips(const SimplifiedMesh& simplified)
{
    constexpr size_t kSpares = 2;
    const FarthestVertex farthest(simplified.mesh);
    std::vector<int> tips = {farthest.from(std::vector<int>{simplified.mesh.faces[0][0]})};
    while (tips.size() < 4 + kSpares && tips.back() >= 0) tips.push_back(farthest.from(tips));
    std::vector<StarTips> stars;
    for (size_t last = 3; last < tips.size() && tips[last] >= 0; ++last)
        stars.push_back({{tips[0], tips[1], tips[2], tips[last]}, kInfinity});
    const OneSolverThread oneThread; // each
    tbb::parallel_for_each(stars, [&](StarTips& star) {
        star.energy = flattenedEnergy(simplified.mesh, starCut(simplified.mesh, star.vertices),
                                      SquareLayout::Octahedral, FlattenEffort::Full);
    });
    StarTips best;
    best.energy = kInfinity;
    for (const StarTips& star : stars)
        if (star.energy < best.energy) best = star;
    for (int& v : best.vertices) v = simplified.vertexOf[v];
    return best;
}

} // namespace gimg

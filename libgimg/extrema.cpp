#include "gimg/extrema.h"

#include "curvature_importance.h"
#include "gimg/cut.h"
#include "gimg/stretch.h"
#include "hierarchy.h"

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
    const Mesh& coarse = simplified.mesh;
    const FarthestVertex farthest(coarse);
    Extrema found;
    CutGraph cut = cutToDisk(coarse);
    found.energyWithout = found.energyWith = flattenedEnergy(coarse, cut, SquareLayout::Cut, options.effort);
    std::vector<int> failed;
    double tried = 0;
    for (int rejections = 0; rejections < options.rejections; ++tried) {
        if (progress) progress(1 - kTypicalCandidates / (kTypicalCandidates + tried));
        if (std::isinf(found.energyWith) || static_cast<int>(found.vertices.size()) >= options.most) break;
        const int candidate = farthest.from(cut, failed);
        if (candidate < 0) break;
        found.vertices.push_back(candidate);
        CutGraph extended = cutToDisk(coarse, found.vertices);
        const double energy = flattenedEnergy(coarse, extended, SquareLayout::Cut, options.effort);
        if (energy < kKept * found.energyWith) {
            found.energyWith = energy;
            cut = std::move(extended);
            rejections = 0;
        } else {
            found.vertices.pop_back();
            failed.push_back(candidate);
            ++rejections;
        }
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
    StarTips best;
    best.energy = kInfinity;
    for (size_t last = 3; last < tips.size() && tips[last] >= 0; ++last) {
        const std::vector<int> four = {tips[0], tips[1], tips[2], tips[last]};
        const CutGraph star = starCut(simplified.mesh, four);
        const double energy =
            flattenedEnergy(simplified.mesh, star, SquareLayout::Octahedral, FlattenEffort::Full);
        if (!(energy < best.energy)) continue;
        best = {four, energy};
    }
    for (int& v : best.vertices) v = simplified.vertexOf[v];
    return best;
}

} // namespace gimg

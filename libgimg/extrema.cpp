#include "gimg/extrema.h"

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

// The mesh with few faces, its vertices some of the mesh's.
Mesh simplified(const Mesh& mesh, int faces, std::vector<int>& vertexOf)
{
    std::vector<uint8_t> onBoundary(mesh.positions.size(), 0);
    const Halfedges he(mesh.faces, mesh.vertexCount());
    for (int h = 0; h < he.count(); ++h)
        if (he.onBoundary(h)) onBoundary[he.tail(h)] = onBoundary[he.head(h)] = 1;
    Hierarchy hierarchy(mesh, onBoundary);
    hierarchy.coarsenTo(faces / 2);
    return hierarchy.current(vertexOf);
}

double flattenedEnergy(const Mesh& mesh, const CutGraph& cut)
{
    const Result<SquareDisk> square = layOutBorder(mesh, cut, {});
    if (!square) return kInfinity;
    const Result<Parameterization> map = flattenToSquare(*square);
    return map ? quarticStretchEnergy(square->disk.mesh, map->st) : kInfinity;
}

class FarthestVertex
{
public:
    explicit FarthestVertex(const Mesh& mesh) : mesh_(mesh), he_(mesh.faces, mesh.vertexCount()) {}

    // The vertex farthest along edges from the cut and from the vertices `others`; -1 if there is no other.
    int from(const CutGraph& cut, const std::vector<int>& others) const
    {
        std::vector<double> distance(mesh_.positions.size(), kInfinity);
        using Entry = std::pair<double, int>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        const auto reach = [&](int v, double d) {
            if (d >= distance[v]) return;
            distance[v] = d;
            queue.push({d, v});
        };
        for (const CutPath& path : cut.paths)
            for (int v : path.vertices) reach(v, 0);
        for (int v : others) reach(v, 0);
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

Extrema findExtrema(const Mesh& mesh, const ExtremaOptions& options, const Progress& progress)
{
    constexpr double kTypicalCandidates = 8; // tells progress no more than roughly
    std::vector<int> vertexOf;
    const Mesh coarse = simplified(mesh, options.faces, vertexOf);
    const FarthestVertex farthest(coarse);
    Extrema found;
    CutGraph cut = cutToDisk(coarse);
    found.energyWithout = found.energyWith = flattenedEnergy(coarse, cut);
    std::vector<int> failed;
    double tried = 0;
    for (int rejections = 0; rejections < options.rejections; ++tried) {
        if (progress) progress(1 - kTypicalCandidates / (kTypicalCandidates + tried));
        if (std::isinf(found.energyWith) || static_cast<int>(found.vertices.size()) >= options.most) break;
        const int candidate = farthest.from(cut, failed);
        if (candidate < 0) break;
        found.vertices.push_back(candidate);
        CutGraph extended = cutToDisk(coarse, found.vertices);
        const double energy = flattenedEnergy(coarse, extended);
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
    for (int& v : found.vertices) v = vertexOf[v];
    return found;
}

} // namespace gimg

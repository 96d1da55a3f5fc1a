#include "conformal/loop_finder.h"

#include "conformal/primitive_set.h"

#include <algorithm>
#include <limits>

namespace gimg {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TreeCotree decompositionFrom(const ClosedSurface& surface, ShortestPaths& paths, int root)
{
    paths.searchFrom(root, kInfinity);
    return treeCotree(surface, paths);
}

} // namespace

LoopFinder::LoopFinder(const ClosedSurface& surface)
    : surface_(surface), paths_(surface),
      decomposition_(decompositionFrom(surface, paths_, surface.surface.faces[0][0])),
      classes_(surface, decomposition_)
{
}

double LoopFinder::lengthOf(const std::vector<int>& halfedges) const
{
    double sum = 0;
    for (int h : halfedges) sum += surface_.length(h);
    return sum;
}

std::vector<LoopFinder::Candidate> LoopFinder::candidatesThrough(int root)
{
    std::vector<Candidate> candidates;
    const TreeCotree decomposition = decompositionFrom(surface_, paths_, root);
    for (int h : decomposition.loopEdges) {
        Loop loop{closedLoop(surface_, paths_, h)};
        const double length = lengthOf(loop.halfedges);
        Eigen::VectorXi homologyClass = classes_.of(loop.halfedges);
        candidates.push_back({length, std::move(homologyClass), std::move(loop)});
    }
    return candidates;
}

// Every set of candidates from one root is a basis; the shortest of all that still form one are taken.
std::vector<Loop> LoopFinder::basis()
{
    constexpr size_t kMostVisits = 10'000'000, kLeastRoots = 4;
    const size_t rank = static_cast<size_t>(classes_.size());
    if (rank == 0) return {};
    const std::vector<Candidate> first = candidatesThrough(surface_.surface.faces[0][0]);
    const size_t affordable = kMostVisits / static_cast<size_t>(surface_.topology.vertices);
    const size_t roots = std::min(rank, std::max(affordable, kLeastRoots));
    std::vector<Candidate> candidates = first;
    for (size_t i = 0; i < roots; ++i) {
        const std::vector<int>& loop = first[i].loop.halfedges;
        const int root = surface_.halfedges.tail(loop[loop.size() / 2]);
        for (Candidate& candidate : candidatesThrough(root)) candidates.push_back(std::move(candidate));
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.length < b.length; });
    PrimitiveSet chosen(classes_.size());
    std::vector<Loop> loops;
    for (Candidate& candidate : candidates)
        if (loops.size() < rank && chosen.add(candidate.homologyClass))
            loops.push_back(std::move(candidate.loop));
    if (loops.size() < rank) { // what was taken can be completed to a basis, but not by these
        loops.clear();
        for (const Candidate& candidate : first) loops.push_back(candidate.loop);
    }
    for (Loop& loop : loops) loop = tightened(std::move(loop));
    std::stable_sort(loops.begin(), loops.end(), [&](const Loop& a, const Loop& b) {
        return lengthOf(a.halfedges) < lengthOf(b.halfedges);
    });
    return loops;
}

// Replaces some first part of the loop, at most half of it, by a shortest path if both have the same class:
// the part for which that saves most.
bool LoopFinder::takeShortcut(std::vector<int>& loop)
{
    const double length = lengthOf(loop), leastSaving = 1e-9 * length;
    paths_.searchFrom(surface_.halfedges.tail(loop[0]), length / 2);
    Eigen::VectorXi between = Eigen::VectorXi::Zero(classes_.size());
    double walked = 0, saved = leastSaving;
    size_t end = 0;
    for (size_t i = 0; i < loop.size(); ++i) {
        const double before = walked;
        walked += surface_.length(loop[i]);
        if (before > length / 2) break;
        classes_.add(loop[i], 1, between);
        const int v = surface_.halfedges.head(loop[i]);
        if (!paths_.isReached(v) || walked - paths_.distance(v) <= saved) continue;
        if (classes_.of(paths_.pathTo(v)) != between) continue;
        saved = walked - paths_.distance(v);
        end = i + 1;
    }
    if (end == 0) return false;
    std::vector<int> shorter = paths_.pathTo(surface_.halfedges.head(loop[end - 1]));
    shorter.insert(shorter.end(), loop.begin() + static_cast<long>(end), loop.end());
    loop = std::move(shorter);
    return true;
}

Loop LoopFinder::tightened(Loop loop)
{
    constexpr int kRounds = 60, kInVain = 5;
    std::vector<int>& walk = loop.halfedges;
    for (int round = 0, inVain = 0; round < kRounds && inVain < kInVain && !walk.empty(); ++round) {
        inVain = takeShortcut(walk) ? 0 : inVain + 1;
        if (walk.empty()) break;
        const size_t third = std::max<size_t>(1, walk.size() * 3 / 8);
        std::rotate(walk.begin(), walk.begin() + static_cast<long>(third % walk.size()), walk.end());
    }
    return loop;
}

Loop LoopFinder::joined(std::span<const Loop> loops, const Eigen::VectorXi& multiplicity)
{
    const Halfedges& he = surface_.halfedges;
    std::vector<int> walk;
    for (Eigen::Index i = 0; i < multiplicity.size(); ++i) {
        if (multiplicity[i] == 0) continue;
        std::vector<int> next = loops[static_cast<size_t>(i)].halfedges;
        if (multiplicity[i] < 0) {
            std::reverse(next.begin(), next.end());
            for (int& h : next) h = he.twin(h);
        }
        std::vector<int> bridge;
        if (!walk.empty()) {
            std::vector<int> roots;
            for (int h : walk) roots.push_back(he.tail(h));
            paths_.searchFrom(roots, kInfinity);
            const auto nearest = std::min_element(next.begin(), next.end(), [&](int g, int h) {
                return paths_.distance(he.tail(g)) < paths_.distance(he.tail(h));
            });
            bridge = paths_.pathTo(he.tail(*nearest));
            std::rotate(next.begin(), nearest, next.end());
            const int from = bridge.empty() ? he.tail(next[0]) : he.tail(bridge[0]);
            std::rotate(walk.begin(),
                        std::find_if(walk.begin(), walk.end(), [&](int h) { return he.tail(h) == from; }),
                        walk.end());
        }
        walk.insert(walk.end(), bridge.begin(), bridge.end());
        for (int times = std::abs(multiplicity[i]); times > 0; --times)
            walk.insert(walk.end(), next.begin(), next.end());
        std::reverse(bridge.begin(), bridge.end());
        for (int h : bridge) walk.push_back(he.twin(h));
    }
    if (multiplicity.cwiseAbs().sum() == 1) return Loop{std::move(walk)}; // as tight as it was given
    return tightened(Loop{std::move(walk)});
}

} // namespace gimg

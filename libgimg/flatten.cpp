#include "gimg/flatten.h"

#include "border_ties.h"
#include "curvature_importance.h"
#include "gimg/mean_value.h"
#include "gimg/stretch.h"
#include "hierarchy.h"
#include "stretch_descent.h"
#include "stretch_element.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace gimg {
namespace {

constexpr int kGrowth = 4; // of the vertex count from level to level

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

// The kernel of a polygon whose edges are the outer edges of a star: all points that see every edge from its
// left. Clips `polygon` by each edge's line.
std::vector<Vec2> kernel(const std::vector<std::pair<Vec2, Vec2>>& edges, std::vector<Vec2> polygon)
{
    for (const auto& [from, to] : edges) {
        std::vector<Vec2> kept;
        for (size_t i = 0; i < polygon.size(); ++i) {
            const Vec2& p = polygon[i];
            const Vec2& q = polygon[(i + 1) % polygon.size()];
            const double dp = cross(to - from, p - from), dq = cross(to - from, q - from);
            if (dp >= 0) kept.push_back(p);
            if ((dp > 0 && dq < 0) || (dp < 0 && dq > 0)) kept.push_back(p + dp / (dp - dq) * (q - p));
        }
        polygon = std::move(kept);
    }
    return polygon;
}

// One vertex among its neighbours: where it may lie, and what stretch it causes there.
class Star
{
public:
    Star(const Mesh& disk, const std::vector<double>& importance, const std::vector<Triangle>& triangles,
         const std::vector<Vec2>& st)
    {
        for (const Triangle& t : triangles) {
            elements_.emplace_back(disk.positions[t[0]], disk.positions[t[1]], disk.positions[t[2]],
                                   meanImportance(importance, t));
            edges_.push_back({st[t[1]], st[t[2]]});
        }
    }

    double energy(const Vec2& p) const
    {
        double sum = 0;
        for (size_t i = 0; i < edges_.size(); ++i)
            sum += elements_[i].energy({p, edges_[i].first, edges_[i].second});
        return sum;
    }

    // A strictly inner point of the kernel, or false if rounding leaves none.
    bool place(Vec2& p) const
    {
        std::vector<Vec2> ring = {edges_[0].first};
        for (size_t i = 1; i < edges_.size(); ++i)
            for (const auto& edge : edges_)
                if (edge.first == ring.back()) {
                    ring.push_back(edge.second);
                    break;
                }
        const std::vector<Vec2> region = kernel(edges_, ring);
        if (region.empty()) return false;
        p = Vec2::Zero();
        for (const Vec2& corner : region) p += corner;
        p /= static_cast<double>(region.size());
        return std::isfinite(energy(p));
    }

    void descend(Vec2& p) const
    {
        double now = energy(p);
        for (int iteration = 0; iteration < 6; ++iteration) {
            Vec2 gradient = Vec2::Zero();
            Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
            for (size_t i = 0; i < edges_.size(); ++i) {
                const auto d = elements_[i].derivatives({p, edges_[i].first, edges_[i].second});
                gradient += Vec2(d.gradient[0], d.gradient[3]);
                hessian(0, 0) += d.hessian(0, 0);
                hessian(0, 1) += d.hessian(0, 3);
                hessian(1, 0) += d.hessian(3, 0);
                hessian(1, 1) += d.hessian(3, 3);
            }
            const Vec2 step = -hessian.inverse() * gradient;
            if (!step.allFinite()) return;
            double t = 1, lowered = now;
            for (; t > 1e-3; t *= 0.5) {
                lowered = energy(p + t * step);
                if (lowered < now) break;
            }
            if (!(lowered < now)) return;
            p += t * step;
            const bool settled = lowered > now * (1 - 1e-3);
            now = lowered;
            if (settled) return;
        }
    }

private:
    std::vector<StretchElement> elements_;
    std::vector<std::pair<Vec2, Vec2>> edges_; // outer edge of each triangle
};

// The hierarchy's current mesh by itself, with the positions of its vertices.
struct Level
{
    Level(const Hierarchy& hierarchy, const std::vector<double>& weight,
          const std::vector<uint8_t>& squareSides, const std::vector<Vec2>& st)
        : mesh(hierarchy.current(vertexOf))
    {
        for (int v : vertexOf) {
            fixed.push_back(squareSides[v] != 0);
            position.push_back(st[v]);
            if (!weight.empty()) importance.push_back(weight[v]);
        }
    }
    // Newton descent with the border where it is, or released: sliding where `ties` let it.
    void descend(const BorderTies& ties, bool released, const DescentOptions& options)
    {
        std::vector<Freedom> freedom(vertexOf.size());
        std::vector<std::array<int, 2>> row(ties.leader.size(), {-1, -1});
        int unknowns = 0;
        for (const Triangle& f : mesh.faces)
            for (int k : f) {
                if (fixed[k] && !released) continue;
                const int v = vertexOf[k], leader = ties.leader[v], turns = ties.motion[v].turns;
                for (int c = 0; c < 2; ++c)
                    if (ties.free[leader][c] && row[leader][c] < 0) row[leader][c] = unknowns++;
                // s of a copy that is turned by a quarter is -t of its leader, and so on.
                freedom[k].row = turns % 2 == 0 ? row[leader] : std::array{row[leader][1], row[leader][0]};
                freedom[k].sign = {turns == 1 || turns == 2 ? -1.0 : 1.0, turns >= 2 ? -1.0 : 1.0};
            }
        minimizeStretch(mesh, importance, freedom, unknowns, position, options);
    }
    void storePositions(std::vector<Vec2>& st) const
    {
        for (size_t i = 0; i < vertexOf.size(); ++i) st[vertexOf[i]] = position[i];
    }

    std::vector<int> vertexOf; // the disk's index of each vertex; declared before mesh, which fills it
    Mesh mesh;
    std::vector<double> importance;
    std::vector<bool> fixed;
    std::vector<Vec2> position;
};

// Moves vertices of the current mesh one by one: all of them twice, then those at slivers until none is left.
// Newton's global step is no longer than the worst sliver allows; this frees the slivers first.
void sweepVertices(const Mesh& disk, const std::vector<double>& importance, const Hierarchy& hierarchy,
                   const std::vector<uint8_t>& squareSides, std::vector<Vec2>& st)
{
    constexpr int kSweeps = 2, kSliverSweeps = 100;
    constexpr double kSliver = 1000; // times the mean energy for its area
    std::vector<int> vertexOf;
    const Mesh level = hierarchy.current(vertexOf);
    const auto descend = [&](int v) {
        if (squareSides[v] == 0) Star(disk, importance, hierarchy.star(v), st).descend(st[v]);
    };
    for (int sweep = 0; sweep < kSweeps; ++sweep)
        for (int v : vertexOf) descend(v);

    std::vector<StretchElement> elements;
    for (const Triangle& f : level.faces)
        elements.emplace_back(level.positions[f[0]], level.positions[f[1]], level.positions[f[2]]);
    for (int sweep = 0; sweep < kSliverSweeps; ++sweep) {
        std::vector<double> energy;
        double sum = 0, area = 0;
        for (size_t f = 0; f < elements.size(); ++f) {
            const Triangle& t = level.faces[f];
            energy.push_back(
                elements[f].energy({st[vertexOf[t[0]]], st[vertexOf[t[1]]], st[vertexOf[t[2]]]}));
            sum += energy.back();
            area += elements[f].area();
        }
        std::vector<bool> atSliver(vertexOf.size(), false);
        bool any = false;
        for (size_t f = 0; f < elements.size(); ++f) {
            if (energy[f] <= kSliver * sum / area * elements[f].area()) continue;
            any = true;
            for (int k : level.faces[f]) atSliver[k] = true;
        }
        if (!any) return;
        for (size_t i = 0; i < vertexOf.size(); ++i)
            if (atSliver[i]) descend(vertexOf[i]);
    }
}

// The coarsest level is a wheel: any convex combination of the border embeds it.
Status startCoarsest(Level& level)
{
    if (const Status mapped = meanValueMap(level.mesh, level.fixed, level.position); !mapped) return mapped;
    if (const int flipped = flippedTriangles(level.mesh.faces, level.position); flipped > 0)
        return Error{ErrorKind::FlippedTriangle, std::to_string(flipped) + " of " +
                                                     std::to_string(level.mesh.faceCount()) +
                                                     " triangles of the coarsest level are flipped"};
    return Done{};
}

} // namespace

Result<Parameterization> flattenToSquare(const SquareDisk& square, const Progress& progress, Density density)
{
    if (density == Density::Even) return flattenToSquare(square, std::vector<double>(), progress);
    return flattenToSquare(square, curvatureImportance(square.surface, square.grid), progress);
}

Result<Parameterization> flattenToSquare(const SquareDisk& square, const std::vector<double>& onSurface,
                                         const Progress& progress, FlattenEffort effort)
{
    // From so many vertices on a map that follows every bump is less smooth, and what it samples takes no
    // fewer bytes.
    constexpr int kFine = 10000;
    const bool trial = effort == FlattenEffort::Trial;
    const bool early = effort == FlattenEffort::Full && square.disk.mesh.vertexCount() >= kFine;
    constexpr DescentOptions kFirstDescent{50, 1e-4}, kLastDescent{12, 1e-3};
    const DescentOptions kReleaseDescent{200, trial ? 3e-3 : 1e-4};
    const DescentOptions kDescent{trial ? 4 : early ? 8 : 30, 1e-3};
    // From so many vertices on the seam may slide: fewer do not tell where to.
    constexpr int kReleased = 500;
    const BorderTies ties = borderTies(square);
    bool released = false;
    const Mesh& disk = square.disk.mesh;
    std::vector<double> importance;
    if (!onSurface.empty())
        for (int v : square.disk.origin) importance.push_back(onSurface[v]);
    Parameterization result;
    result.st = square.borderPosition;
    Hierarchy hierarchy(disk, square.squareSides);
    const int interior = hierarchy.interiorCount();
    hierarchy.coarsen();
    if (progress) progress(0.1);

    Level coarsest(hierarchy, importance, square.squareSides, result.st);
    if (const Status started = startCoarsest(coarsest); !started) return started.error();
    coarsest.descend(ties, false, kFirstDescent);
    coarsest.storePositions(result.st);

    for (bool full = hierarchy.isFull(); !full;) {
        const int target = hierarchy.interiorCount() * kGrowth;
        while (!hierarchy.isFull() && hierarchy.interiorCount() < target) {
            const int v = hierarchy.refine();
            const Star star(disk, importance, hierarchy.star(v), result.st);
            if (!star.place(result.st[v]))
                return Error{ErrorKind::FlippedTriangle, "no room left in the plane for surface vertex " +
                                                             std::to_string(square.disk.origin[v])};
            star.descend(result.st[v]);
        }
        sweepVertices(disk, importance, hierarchy, square.squareSides, result.st);
        Level level(hierarchy, importance, square.squareSides, result.st);
        const int reached = hierarchy.interiorCount();
        full = hierarchy.isFull();
        const bool release = full || reached >= kReleased;
        if (release && !released)
            level.descend(ties, true, kReleaseDescent);
        else if (!full)
            level.descend(ties, release, kDescent);
        else if (!early)
            level.descend(ties, true, kLastDescent);
        released = release;
        level.storePositions(result.st);
        if (progress) progress(0.1 + 0.9 * reached / std::max(1, interior));
    }
    if (const int flipped = flippedTriangles(disk.faces, result.st); flipped > 0)
        return Error{ErrorKind::FlippedTriangle, std::to_string(flipped) + " flipped triangles"};
    result.efficiency = stretchEfficiency(disk, result.st);
    return result;
}

} // namespace gimg

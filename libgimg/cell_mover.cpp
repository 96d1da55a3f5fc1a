#include "cell_mover.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

namespace gimg {
namespace {

constexpr double kFacing = 0.2; // least cosine between a triangle's normal and the mesh's
constexpr double kMissed = 4;   // weight of the gap to the point that is wanted

/// Where the distance of a triangle from the mesh is looked at, as weights of its corners; the middle is
/// last.
const std::vector<Vec3>& placesOnTriangle()
{
    static const std::vector<Vec3> places = {{1.0 / 2, 1.0 / 2, 0},       {0, 1.0 / 2, 1.0 / 2},
                                             {1.0 / 2, 0, 1.0 / 2},       {2.0 / 3, 1.0 / 6, 1.0 / 6},
                                             {1.0 / 6, 2.0 / 3, 1.0 / 6}, {1.0 / 6, 1.0 / 6, 2.0 / 3},
                                             {1.0 / 3, 1.0 / 3, 1.0 / 3}};
    return places;
}

Vec3 placeOn(const std::vector<Vec3>& x, const Triangle& t, const Vec3& weights)
{
    return weights[0] * x[t[0]] + weights[1] * x[t[1]] + weights[2] * x[t[2]];
}

} // namespace

CellMover::CellMover(GridSurface& surface, const NearestTree& mesh) : surface_(surface), mesh_(mesh)
{
    surface_.findCells();
}

bool CellMover::tryMove(int vertex, const Vec3& to, const Vec3& wanted)
{
    const Vec3 from = surface_.positions()[vertex];
    const Quality before = qualityAt(vertex, wanted);
    surface_.place(vertex, to);
    const Quality after = qualityAt(vertex, wanted);
    if (after.error <= before.error && after.facing >= std::min(before.facing, kFacing)) return true;
    surface_.place(vertex, from);
    return false;
}

/// Errors are fourth powers of distances: the largest ones are to fall.
CellMover::Quality CellMover::qualityAt(int vertex, const Vec3& wanted) const
{
    const std::vector<Vec3>& x = surface_.positions();
    Quality quality;
    double missed2 = std::numeric_limits<double>::infinity();
    int near = 0;
    for (const int cell : surface_.cellsAt(vertex))
        for (const int f : {2 * cell, 2 * cell + 1}) {
            const Triangle& t = surface_.faces()[f];
            for (const Vec3& weights : placesOnTriangle()) {
                const NearestTree::Found found = mesh_.nearest(placeOn(x, t, weights), near);
                near = found.face;
                quality.error += found.distance2 * found.distance2;
            }
            const Vec3 across = (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
            const double size = across.norm();
            const double facing = size > 0 ? across.dot(mesh_.faceNormal(near)) / size : -1;
            quality.facing = std::min(quality.facing, facing);
            missed2 = std::min(missed2, squaredDistanceToTriangle(wanted, x[t[0]], x[t[1]], x[t[2]]));
        }
    quality.error += kMissed * missed2 * missed2;
    return quality;
}

std::vector<CellMover::Apart> CellMover::farthestApart(double negligible) const
{
    constexpr double kPart = 0.5;
    constexpr size_t kMost = 500;
    const NearestTree grid(surface_.positions(), surface_.faces());
    const auto faces = static_cast<int>(surface_.faces().size()),
               meshFaces = static_cast<int>(mesh_.faces().size());
    std::vector<Apart> all(static_cast<size_t>(faces) + static_cast<size_t>(meshFaces));
    tbb::parallel_for(tbb::blocked_range<int>(0, faces, 256), [&](const tbb::blocked_range<int>& range) {
        int near = 0;
        for (int f = range.begin(); f < range.end(); ++f) all[f] = apartFromMesh(f, near);
    });
    tbb::parallel_for(tbb::blocked_range<int>(0, meshFaces, 256), [&](const tbb::blocked_range<int>& range) {
        int near = 0;
        for (int f = range.begin(); f < range.end(); ++f)
            all[static_cast<size_t>(faces) + f] = apartFromGrid(grid, f, near);
    });
    double worst = negligible * negligible / (kPart * kPart);
    for (const Apart& apart : all) worst = std::max(worst, apart.distance2);
    std::erase_if(all, [&](const Apart& apart) { return !(apart.distance2 > kPart * kPart * worst); });
    std::stable_sort(all.begin(), all.end(),
                     [](const Apart& a, const Apart& b) { return a.distance2 > b.distance2; });
    if (all.size() > kMost) all.resize(kMost);
    return all;
}

CellMover::Apart CellMover::apartFromMesh(int face, int& near) const
{
    Apart apart;
    apart.face = face;
    for (const Vec3& weights : placesOnTriangle()) {
        const Vec3 place = placeOn(surface_.positions(), surface_.faces()[face], weights);
        const NearestTree::Found found = mesh_.nearest(place, near);
        near = found.face;
        if (found.distance2 <= apart.distance2) continue;
        apart.distance2 = found.distance2;
        apart.point = mesh_.pointOfFace(near, mesh_.nearestOnFace(place, near));
    }
    return apart;
}

CellMover::Apart CellMover::apartFromGrid(const NearestTree& grid, int meshFace, int& near) const
{
    Apart apart;
    const auto look = [&](const Vec3& weights) {
        const Vec3 place = mesh_.pointOfFace(meshFace, weights);
        const NearestTree::Found found = grid.nearest(place, near);
        near = found.face;
        if (found.distance2 > apart.distance2) apart = {found.distance2, near, place};
    };
    for (int k = 0; k < 3; ++k) {
        look(Vec3::Unit(k));
        look((Vec3::Ones() - Vec3::Unit(k)) / 2);
    }
    return apart;
}

} // namespace gimg

#include "surface_pull.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace gimg {
namespace {

constexpr uint64_t kSeed = 2;   // not that of SurfaceMeasure: it would judge by the samples fitted to
constexpr double kAlong = 0.02; // weight of a gap along the mesh, where 1 is that of one across it

// Places on a triangle that stand for equal parts of it, as weights of its corners: on a fine grid the three
// that integrate squares of linear functions exactly, on a coarse one, whose triangles span more of the mesh,
// the centres of 9 or 16 equal triangles.
std::vector<Vec3> placesOnTriangle(size_t triangles)
{
    constexpr double kPlaces = 4e5; // about as many on all triangles
    const auto rows = static_cast<int>(std::lround(std::sqrt(kPlaces / static_cast<double>(triangles))));
    std::vector<Vec3> places;
    if (rows <= 2) {
        for (int k = 0; k < 3; ++k) places.push_back((Vec3::Ones() + 3 * Vec3::Unit(k)) / 6);
        return places;
    }
    const int parts = std::min(rows, 4);
    for (int u = 0; u < parts; ++u)
        for (int v = 0; v < 2 * (parts - u) - 1; ++v) { // upright and inverted triangles in turn
            const double centre = v % 2 == 0 ? 1.0 / 3 : 2.0 / 3;
            const double b = (u + centre) / parts, c = (v / 2 + centre) / parts;
            places.emplace_back(1 - b - c, b, c);
        }
    return places;
}

} // namespace

struct SurfacePull::Surface
{
    const std::vector<Vec3>& positions;
    const std::vector<Triangle>& faces;

    Vec3 at(const Triangle& t, const Vec3& weights) const
    {
        return weights[0] * positions[t[0]] + weights[1] * positions[t[1]] + weights[2] * positions[t[2]];
    }
    Vec3 areaVector(const Triangle& t) const
    {
        return (positions[t[1]] - positions[t[0]]).cross(positions[t[2]] - positions[t[0]]) / 2;
    }
};

/// weight ((1 - kAlong) (normal . gap)^2 + kAlong |gap|^2),  gap = target - sum weights_k corner_k
struct SurfacePull::Pair
{
    Vec3 weights, gap, normal;
    double area;

    void addTo(TriangleEquations& e) const
    {
        const Vec3 pull = area * ((1 - kAlong) * normal.dot(gap) * normal + kAlong * gap);
        for (int k = 0; k < 3; ++k) {
            e.pair[k].add(area * weights[k] * weights[k], 1 - kAlong, normal, kAlong);
            e.pair[3 + k].add(area * weights[k] * weights[(k + 1) % 3], 1 - kAlong, normal, kAlong);
            e.right[k] += weights[k] * pull;
        }
    }
};

SurfacePull::SurfacePull(NearestTree mesh, int samples)
    : mesh_(std::move(mesh)), samples_(samples), hits_(samples), byFace_(samples)
{
    const AreaSampler sampler(mesh_.positions(), mesh_.faces());
    sampleArea_ = sampler.area() / samples;
    tbb::parallel_for(0, samples, [&](int i) { samples_[i] = sampler.sample(i, samples, kSeed); });
}

std::vector<TriangleEquations> SurfacePull::equations(const std::vector<Vec3>& positions,
                                                      const std::vector<Triangle>& faces)
{
    const Surface surface{positions, faces};
    findHits(surface);
    std::vector<TriangleEquations> equations(faces.size());
    const std::vector<Vec3> places = placesOnTriangle(faces.size());
    tbb::parallel_for(tbb::blocked_range<int>(0, static_cast<int>(faces.size()), 64),
                      [&](const tbb::blocked_range<int>& range) {
                          int near = 0;
                          for (int f = range.begin(); f < range.end(); ++f)
                              equations[f] = onFace(surface, f, places, near);
                      });
    return equations;
}

void SurfacePull::findHits(const Surface& surface)
{
    const NearestTree tree(surface.positions, surface.faces);
    const auto count = static_cast<int>(samples_.size());
    tbb::parallel_for(tbb::blocked_range<int>(0, count, 256), [&](const tbb::blocked_range<int>& range) {
        int near = hits_[range.begin()].face;
        for (int i = range.begin(); i < range.end(); ++i) {
            near = tree.nearest(samples_[i].point, near).face;
            hits_[i] = {near, tree.nearestOnFace(samples_[i].point, near)};
        }
    });
    firstOf_.assign(surface.faces.size() + 1, 0);
    for (const Hit& hit : hits_) ++firstOf_[hit.face + 1];
    for (size_t f = 0; f < surface.faces.size(); ++f) firstOf_[f + 1] += firstOf_[f];
    std::vector<int> next(firstOf_.begin(), firstOf_.end() - 1);
    for (int i = 0; i < count; ++i) byFace_[next[hits_[i].face]++] = i;
}

TriangleEquations SurfacePull::onFace(const Surface& surface, int face, const std::vector<Vec3>& places,
                                      int& near) const
{
    TriangleEquations sum;
    const Triangle& t = surface.faces[face];
    const Vec3 areaVector = surface.areaVector(t);
    for (int k = firstOf_[face]; k < firstOf_[face + 1]; ++k) {
        const AreaSampler::Sample& sample = samples_[byFace_[k]];
        const Vec3& normal = mesh_.faceNormal(sample.face);
        const Vec3& weights = hits_[byFace_[k]].weights;
        if (normal.dot(areaVector) > 0)
            Pair{weights, sample.point - surface.at(t, weights), normal, sampleArea_}.addTo(sum);
    }
    const double area = areaVector.norm() / static_cast<double>(places.size());
    for (const Vec3& weights : places) {
        const Vec3 place = surface.at(t, weights);
        near = mesh_.nearest(place, near).face;
        const Vec3& normal = mesh_.faceNormal(near);
        if (!(normal.dot(areaVector) > 0)) continue;
        const Vec3 target = mesh_.pointOfFace(near, mesh_.nearestOnFace(place, near));
        Pair{weights, target - place, normal, area}.addTo(sum);
    }
    return sum;
}

} // namespace gimg

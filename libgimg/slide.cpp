#include "slide.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace gimg {
namespace {

constexpr double kOvershoot = 0.2;   // of the way from the decoded sample to the mesh, past it
constexpr double kLeastCosine = 0.2; // between the mesh's normal and the grid's
constexpr double kLongestJump = 2;   // spacings from the target before

template <class Body> void forEach(size_t count, const Body& body)
{
    tbb::parallel_for(tbb::blocked_range<size_t>(0, count, 256),
                      [&](const tbb::blocked_range<size_t>& range) {
                          for (size_t k = range.begin(); k < range.end(); ++k) body(k);
                      });
}

} // namespace

Result<SlideSurface> SlideSurface::of(const Mesh& mesh)
{
    Result<NearestSurface> nearest = NearestSurface::of(mesh);
    if (!nearest) return nearest.error();
    std::vector<Vec3> normals;
    for (const Triangle& t : mesh.faces) normals.push_back(areaVector(mesh.positions, t).stableNormalized());
    return SlideSurface{std::move(*nearest), std::move(normals)};
}

Result<SampleSlide> SampleSlide::of(std::shared_ptr<const SlideSurface> surface, const GridSeam& seam,
                                    const FloatImage& image)
{
    Result<GluedGrid> grid = GluedGrid::of(seam, image.width);
    if (!grid) return grid.error();
    return SampleSlide(std::move(surface), std::move(*grid), image);
}

SampleSlide::SampleSlide(std::shared_ptr<const SlideSurface> surface, GluedGrid grid, const FloatImage& image)
    : surface_(std::move(surface)), grid_(std::move(grid)), height_(grid_.vertexCount()),
      hint_(grid_.vertexCount())
{
    const std::vector<Vec3> position = grid_.positions(image.samples);
    forEach(position.size(), [&](size_t v) {
        const NearestPoint foot = surface_->nearest.to(position[v]);
        height_[v] = (position[v] - foot.point).dot(surface_->faceNormals[foot.face]);
        hint_[v] = foot.face;
    });
}

void SampleSlide::operator()(std::span<const float> decoded, std::span<float> targets)
{
    FloatImage image;
    image.width = image.height = grid_.side();
    image.samples.assign(decoded.begin(), decoded.end());
    const std::vector<Triangle> faces = grid_.faces(image);
    const std::vector<Vec3> at = grid_.positions(decoded), before = grid_.positions(targets);
    std::vector<Vec3> normal(at.size(), Vec3::Zero());
    std::vector<double> area(at.size(), 0);
    for (const Triangle& t : faces) {
        const Vec3 a = areaVector(at, t);
        for (const int v : t) normal[v] += a, area[v] += a.norm() / 3;
    }
    std::vector<Vec3> after = before;
    forEach(at.size(), [&](size_t v) {
        if (grid_.onBoundary(static_cast<int>(v))) return;
        const NearestPoint foot = surface_->nearest.to(at[v], hint_[v]);
        hint_[v] = foot.face;
        const Vec3& facing = surface_->faceNormals[foot.face];
        if (!(normal[v].dot(facing) >= kLeastCosine * normal[v].norm())) return;
        if ((foot.point - before[v]).squaredNorm() > kLongestJump * kLongestJump * area[v]) return;
        const Vec3 wanted = foot.point + height_[v] * facing;
        after[v] = wanted + kOvershoot * (wanted - at[v]);
    });
    keepCellsUnfolded(before, after, faces);
    for (int s = 0; s < grid_.side() * grid_.side(); ++s) {
        const Vec3& p = after[grid_.vertexOf(s)];
        for (int c = 0; c < 3; ++c) targets[size_t{3} * s + c] = static_cast<float>(p[c]);
    }
}

// Corners of a triangle that would turn over go back, which may turn others: so again, until none does.
void SampleSlide::keepCellsUnfolded(const std::vector<Vec3>& before, std::vector<Vec3>& after,
                                    const std::vector<Triangle>& faces) const
{
    for (bool any = true; any;) {
        any = false;
        for (const Triangle& t : faces) {
            if (after[t[0]] == before[t[0]] && after[t[1]] == before[t[1]] && after[t[2]] == before[t[2]])
                continue;
            const Vec3 was = areaVector(before, t);
            if (areaVector(after, t).dot(was) > 0 || was.isZero(0)) continue;
            for (const int v : t) after[v] = before[v];
            any = true;
        }
    }
}

} // namespace gimg

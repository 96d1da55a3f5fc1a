#include "gimg/nearest.h"

#include "mesh_check.h"
#include "nearest_tree.h"

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <exception>

namespace gimg {

struct NearestSurface::Parts
{
    UnitFrame frame;
    NearestTree tree;

    explicit Parts(const Mesh& mesh) : frame(mesh), tree(frame.inside(mesh), mesh.faces)
    {
        tree.makeNormals();
    }

    int faceOr0(int face) const;
};

NearestSurface::NearestSurface(std::unique_ptr<const Parts> parts) : parts_(std::move(parts)) {}
NearestSurface::~NearestSurface() = default;
NearestSurface::NearestSurface(NearestSurface&&) noexcept = default;
NearestSurface& NearestSurface::operator=(NearestSurface&&) noexcept = default;

Result<NearestSurface> NearestSurface::of(const Mesh& mesh)
try {
    if (const std::optional<Error> error = objectionToTriangles(mesh, "the mesh")) return *error;
    auto parts = std::make_unique<const Parts>(mesh);
    if (parts->tree.tooLarge()) return Error{ErrorKind::BadArgument, "the mesh is too large"};
    return NearestSurface(std::move(parts));
} catch (const std::exception& failure) {
    return Error{ErrorKind::BadArgument, failure.what()};
}

int NearestSurface::Parts::faceOr0(int face) const
{
    return face >= 0 && static_cast<size_t>(face) < tree.faces().size() ? face : 0;
}

NearestPoint NearestSurface::to(const Vec3& q, int near) const
{
    const auto& [frame, tree] = *parts_;
    const Vec3 inside = frame.inside(q);
    const NearestTree::Found found = tree.nearest(inside, parts_->faceOr0(near));
    NearestPoint nearest;
    nearest.face = found.face;
    nearest.barycentric = tree.nearestOnFace(inside, found.face);
    nearest.point = frame.outside(tree.pointOfFace(found.face, nearest.barycentric));
    nearest.distance = tree.distance(found.distance2) / frame.scale;
    return nearest;
}

Vec3 NearestSurface::normalNearest(const Vec3& q, int near) const
{
    NearestTree::Found found{parts_->faceOr0(near), 0};
    return parts_->tree.nearestNormal(parts_->frame.inside(q), found);
}

std::vector<double> NearestSurface::distances(std::span<const Vec3> points, int threads) const
{
    std::vector<double> distances(points.size());
    const int cores = tbb::info::default_concurrency();
    tbb::task_arena arena(threads > 0 ? std::min(threads, cores) : cores);
    const auto measure = [&](const tbb::blocked_range<size_t>& range) {
        NearestTree::Found found{0, 0};
        for (size_t i = range.begin(); i < range.end(); ++i) {
            found = parts_->tree.nearest(parts_->frame.inside(points[i]), found.face);
            distances[i] = parts_->tree.distance(found.distance2) / parts_->frame.scale;
        }
    };
    arena.execute([&] { tbb::parallel_for(tbb::blocked_range<size_t>(0, points.size(), 256), measure); });
    return distances;
}

} // namespace gimg

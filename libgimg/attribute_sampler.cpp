#include "attribute_sampler.h"

#include "gimg/decode.h"
#include "glued_grid.h"
#include "on_triangles.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gimg {
namespace {

/// What has open borders is looked up this far inside them, in cells: on its own side of a jump.
constexpr double kInside = 1e-3;

std::string listed(const std::vector<VertexAttribute>& attributes)
{
    std::string names;
    for (const VertexAttribute& attribute : attributes) names += (names.empty() ? "" : ", ") + attribute.name;
    return names.empty() ? "none" : names;
}

bool isGridSize(int n) { return n >= 3 && n <= 4097 && ((n - 1) & (n - 2)) == 0; }

bool isAlong(const Vec3& a, const Vec3& b) { return a.dot(b) > 0; }

} // namespace

AttributeSampler::AttributeSampler(NearestSurface nearest, const Mesh& mesh, std::vector<Asked> asked)
    : nearest_(std::move(nearest)), faces_(mesh.faces), diagonal_(boundingBoxDiagonal(mesh)),
      asked_(std::move(asked))
{
    for (const Triangle& t : mesh.faces)
        normals_.push_back(
            (mesh.positions[t[1]] - mesh.positions[t[0]]).cross(mesh.positions[t[2]] - mesh.positions[t[0]]));
}

Result<AttributeSampler> AttributeSampler::of(const AttributedSurface& surface,
                                              const std::vector<AttributeRequest>& requests)
{
    std::vector<Asked> asked;
    for (const AttributeRequest& request : requests) {
        const VertexAttribute* attribute = findAttribute(surface.attributes, request.name);
        if (attribute == nullptr)
            return Error{ErrorKind::BadArgument,
                         "no attribute " + request.name + "; the mesh has: " + listed(surface.attributes)};
        if (request.grid != 0 && !isGridSize(request.grid))
            return Error{ErrorKind::BadArgument, "attribute " + request.name + ": a grid of " +
                                                     std::to_string(request.grid) +
                                                     " is not 2^k + 1 between 3 and 4097"};
        for (const Asked& before : asked)
            if (before.attribute.name == request.name)
                return Error{ErrorKind::BadArgument, "attribute " + request.name + " is asked for twice"};
        const auto count = static_cast<size_t>(attribute->channels) * surface.mesh.positions.size();
        if (attribute->channels < 1 || attribute->channels > GIM_MAX_CHANNELS ||
            attribute->values.size() != count)
            return Error{ErrorKind::BadArgument,
                         "attribute " + request.name + ": its values do not fit the vertices"};
        const auto bad = std::find_if(attribute->values.begin(), attribute->values.end(),
                                      [](float value) { return !std::isfinite(value); });
        if (bad != attribute->values.end())
            return Error{ErrorKind::NotFinite, "attribute " + request.name + " is not finite everywhere"};
        asked.push_back({*attribute, request.grid, request.lossless, request.name != "uv"});
    }
    Result<NearestSurface> nearest = NearestSurface::of(surface.mesh);
    if (!nearest) return nearest.error();
    return AttributeSampler(std::move(*nearest), surface.mesh, std::move(asked));
}

// Inside a thin wall the far side may be nearer than the own one, which farther out it is not.
NearestPoint AttributeSampler::nearestFacing(const Vec3& point, const Vec3& normal, int near) const
{
    const NearestPoint hit = nearest_.to(point, near);
    const double length = normal.norm();
    if (isAlong(normals_[hit.face], normal) || !(length > 0)) return hit;
    double away = std::max(hit.distance, 1e-6 * diagonal_);
    for (int k = 0; k < 6; ++k, away *= 2) {
        const NearestPoint other = nearest_.to(point + (away / length) * normal, hit.face);
        if (isAlong(normals_[other.face], normal)) return other;
    }
    return hit;
}

Result<std::vector<SampledAttribute>> AttributeSampler::at(const FloatImage& geometry,
                                                           const GridSeam& seam) const
{
    const std::vector<Triangle> cells = gridMesh(geometry).faces;
    const int last = geometry.width - 1;
    std::vector<SampledAttribute> out;
    for (const Asked& asked : asked_) {
        const VertexAttribute& attribute = asked.attribute;
        const int n = asked.grid != 0 ? asked.grid : geometry.width;
        const Result<GluedGrid> grid = GluedGrid::of(seam, n);
        if (!grid) return grid.error();
        // Glued samples lie at one place: the first of them is looked up.
        std::vector<int> looked(static_cast<size_t>(n) * n);
        std::iota(looked.begin(), looked.end(), 0);
        if (asked.glued)
            for (int s = 0; s < n * n; ++s) looked[s] = grid->sampleOf(grid->vertexOf(s));
        const double inset = asked.glued ? 0 : kInside;
        SampledAttribute sampled;
        const auto channels = static_cast<size_t>(attribute.channels);
        sampled.samples.resize(channels * looked.size());
        const auto place = [&](int k) {
            return std::clamp(static_cast<double>(k) * last / (n - 1), inset, last - inset);
        };
        tbb::parallel_for(tbb::blocked_range<int>(0, n * n, 256), [&](const auto& range) {
            int near = 0;
            for (int s = range.begin(); s < range.end(); ++s) {
                if (looked[s] != s) continue;
                const OnTriangle on = onTriangles(geometry, cells, place(s % n), place(s / n));
                const NearestPoint hit = nearestFacing(on.point, on.normal, near);
                near = hit.face;
                const Triangle& t = faces_[hit.face];
                for (size_t c = 0; c < channels; ++c) {
                    double value = 0;
                    for (int k = 0; k < 3; ++k)
                        value += hit.barycentric[k] * double{attribute.values[channels * t[k] + c]};
                    if (attribute.type != GIM_F32) value = std::floor(value + 0.5);
                    sampled.samples[channels * s + c] = static_cast<float>(value);
                }
            }
        });
        for (int s = 0; s < n * n; ++s)
            if (looked[s] != s)
                std::copy_n(&sampled.samples[channels * looked[s]], channels, &sampled.samples[channels * s]);
        sampled.source = {attribute.name,
                          static_cast<uint32_t>(n),
                          static_cast<unsigned>(attribute.channels),
                          attribute.type,
                          asked.glued,
                          attribute.normalized,
                          asked.lossless,
                          {}};
        out.push_back(std::move(sampled));
    }
    return out;
}

} // namespace gimg

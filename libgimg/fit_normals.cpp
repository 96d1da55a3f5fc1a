#include "gimg/fit.h"

#include "gimg/decode.h"
#include "gimg/nearest.h"
#include "glued_grid.h"
#include "on_triangles.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace gimg {
namespace {

Vec3 pixel(const FloatImage& image, int i, int j)
{
    return {image.at(i, j, 0), image.at(i, j, 1), image.at(i, j, 2)};
}

} // namespace

Result<FloatImage> fitNormals(const Mesh& mesh, const FloatImage& geometry, const GridSeam& seam,
                              const FloatImage& normals)
{
    for (const FloatImage* image : {&geometry, &normals})
        if (const std::optional<Error> error = objectionToImage(*image)) return *error;
    if (const Result<GluedGrid> ofGeometry = GluedGrid::of(seam, geometry.width); !ofGeometry)
        return ofGeometry.error();
    const Result<GluedGrid> grid = GluedGrid::of(seam, normals.width);
    if (!grid) return grid.error();
    const Result<NearestSurface> surface = NearestSurface::of(mesh);
    if (!surface) return surface.error();

    const std::vector<Triangle> cells = gridMesh(geometry).faces;
    const std::vector<Vec3> ofVertex = vertexNormals(mesh);
    const int n = normals.width, last = geometry.width - 1;
    std::vector<Vec3> fitted(grid->vertexCount());
    tbb::parallel_for(tbb::blocked_range<int>(0, grid->vertexCount(), 256), [&](const auto& range) {
        int near = 0;
        for (int v = range.begin(); v < range.end(); ++v) {
            const int i = grid->sampleOf(v) % n, j = grid->sampleOf(v) / n;
            const NearestPoint hit =
                surface->to(onTriangles(geometry, cells, static_cast<double>(i) * last / (n - 1),
                                        static_cast<double>(j) * last / (n - 1))
                                .point,
                            near);
            near = hit.face;
            const Triangle& t = mesh.faces[hit.face];
            Vec3 normal = Vec3::Zero();
            for (int k = 0; k < 3; ++k) normal += hit.barycentric[k] * ofVertex[t[k]];
            const Vec3 before = pixel(normals, i, j);
            fitted[v] = normal.dot(before) > 0 ? Vec3(normal.normalized()) : before;
        }
    });
    FloatImage image = normals;
    for (int s = 0; s < n * n; ++s)
        for (int c = 0; c < 3; ++c)
            image.samples[size_t{3} * s + c] = static_cast<float>(fitted[grid->vertexOf(s)][c]);
    return image;
}

} // namespace gimg

#include "gimg/fit.h"

#include "grid_surface.h"
#include "mesh_check.h"

#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <string>

namespace gimg {
namespace {

Result<double> psnrOf(const GluedGrid& grid, const FloatImage& image, const SurfaceMeasure& measure)
{
    const Result<SurfaceDistance> distance = measure.against(meshOf(grid, image));
    if (!distance) return distance.error();
    return distance->psnr();
}

FloatImage fitted(const Mesh& mesh, const FloatImage& image, const GluedGrid& grid, const FitOptions& options)
{
    const UnitFrame frame(mesh);
    NearestTree tree(frame.inside(mesh), mesh.faces);
    tree.makeNormals();
    SurfacePull pull(std::move(tree), pullSamplesFor(image.width * image.height));
    GridSurface surface(grid, frame, image);
    for (int round = 0; round < options.rounds; ++round) surface.fit(pull, options.smoothing);
    return surface.image();
}

} // namespace

Result<FittedGeometry> fitGeometry(const Mesh& mesh, const SurfaceMeasure& measure, const FloatImage& image,
                                   const GridSeam& seam, const FitOptions& options)
try {
    if (const std::optional<Error> error = objectionToTriangles(mesh, "the mesh")) return *error;
    if (const std::optional<Error> error =
            objectionToRounds(options.rounds, options.smoothing, options.threads))
        return *error;
    const Result<GluedGrid> grid = gridOf(image, seam);
    if (!grid) return grid.error();
    const Result<double> before = psnrOf(*grid, image, measure);
    if (!before) return before.error();
    if (std::isinf(*before)) return FittedGeometry{image, *before, *before};

    const int cores = tbb::info::default_concurrency();
    tbb::task_arena arena(options.threads > 0 ? std::min(options.threads, cores) : cores);
    FloatImage moved = arena.execute([&] { return fitted(mesh, image, *grid, options); });
    const Result<double> after = psnrOf(*grid, moved, measure);
    if (!after || !(*after > *before)) return FittedGeometry{image, *before, *before};
    return FittedGeometry{std::move(moved), *before, *after};
} catch (const std::exception& failure) {
    return Error{ErrorKind::BadArgument, failure.what()};
}

Result<FittedGeometry> fitGeometry(const Mesh& mesh, const FloatImage& image, const GridSeam& seam,
                                   const FitOptions& options)
{
    return fitGeometry(mesh, SurfaceMeasure(mesh, {.threads = options.threads}), image, seam, options);
}

} // namespace gimg

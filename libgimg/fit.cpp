#include "gimg/fit.h"

#include "fit_rounds.h"
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

NearestTree treeWithNormals(const Mesh& mesh, const UnitFrame& frame)
{
    NearestTree tree(frame.inside(mesh), mesh.faces);
    tree.makeNormals();
    return tree;
}

} // namespace

FitRounds::FitRounds(const Mesh& mesh, int pixels)
    : frame_(mesh), pull_(treeWithNormals(mesh, frame_), pullSamplesFor(pixels))
{
}

FloatImage FitRounds::run(const GluedGrid& grid, const FloatImage& image, int rounds, double smoothing)
{
    GridSurface surface(grid, frame_, image);
    for (int round = 0; round < rounds; ++round) surface.fit(pull_, smoothing);
    return surface.image();
}

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
    FloatImage moved = arena.execute([&] {
        return FitRounds(mesh, image.width * image.height)
            .run(*grid, image, options.rounds, options.smoothing);
    });
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

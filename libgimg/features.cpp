#include "gimg/features.h"

#include "crease_snap.h"
#include "mesh_check.h"

#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>
#include <string>

namespace gimg {
namespace {

std::optional<Error> objection(const FeatureOptions& options)
{
    if (!(options.angle > 0 && options.angle < 180))
        return Error{ErrorKind::BadArgument, "the angle of a sharp edge is not between 0 and 180 degrees"};
    if (!(options.shortest >= 0 && std::isfinite(options.shortest)))
        return Error{ErrorKind::BadArgument, "the shortest chain has no length"};
    return objectionToRounds(options.rounds, options.smoothing, options.threads);
}

/// Of the grids that are tried it takes the one with the smallest maximum whose PSNR did not fall.
class BestGrid
{
public:
    BestGrid(const GluedGrid& grid, const SurfaceMeasure& measure, FeatureGeometry& best)
        : grid_(grid), measure_(measure), best_(best)
    {
    }

    void take(const FloatImage& image, const CreaseSnap& snap)
    {
        const Result<SurfaceDistance> distance = measure_.against(meshOf(grid_, image));
        FeatureReport& report = best_.report;
        if (!distance || distance->psnr() < report.psnrBefore || distance->hausdorff() > report.maxAfter)
            return;
        best_.image = image;
        report.kept = true;
        report.psnrAfter = distance->psnr();
        report.maxAfter = distance->hausdorff();
        report.onCreases = snap.onCreases();
        report.onCorners = snap.onCorners();
        report.crossings = snap.crossings();
    }

private:
    const GluedGrid& grid_;
    const SurfaceMeasure& measure_;
    FeatureGeometry& best_;
};

void follow(const Mesh& mesh, const SurfaceMeasure& measure, const GluedGrid& grid,
            const FeatureOptions& options, FeatureGeometry& out)
{
    constexpr double kNegligible = 0.01;
    const UnitFrame frame(mesh);
    std::vector<Vec3> inside = frame.inside(mesh);
    const double spacing = frame.scale * std::sqrt(surfaceArea(mesh)) / (grid.side() - 1);
    const CreaseNet net(inside, mesh.faces, options.angle, options.shortest * spacing);
    out.report.length = net.length() / frame.scale;
    out.report.creases = net.chainCount();
    out.report.corners = static_cast<int>(net.corners().size());
    if (net.segments().empty()) return;

    NearestTree tree(std::move(inside), mesh.faces);
    tree.makeNormals();
    SurfacePull pull(std::move(tree), pullSamplesFor(out.image.width * out.image.height));
    GridSurface surface(grid, frame, out.image);
    CreaseSnap snap(surface, net, pull.mesh());
    BestGrid best(grid, measure, out);
    for (int round = 0;; ++round) {
        snap.snap();
        best.take(surface.image(), snap);
        if (round == options.rounds) break;
        surface.fit(pull, options.smoothing, snap.rails());
        snap.bringBack();
    }
    if (!options.ease) return;
    snap.easeWorst(kNegligible * spacing);
    best.take(surface.image(), snap);
}

} // namespace

Result<FeatureGeometry> followFeatures(const Mesh& mesh, const SurfaceMeasure& measure,
                                       const FloatImage& image, const GridSeam& seam,
                                       const FeatureOptions& options)
try {
    if (const std::optional<Error> error = objectionToTriangles(mesh, "the mesh")) return *error;
    if (const std::optional<Error> error = objection(options)) return *error;
    const Result<GluedGrid> grid = gridOf(image, seam);
    if (!grid) return grid.error();
    const Result<SurfaceDistance> before = measure.against(meshOf(*grid, image));
    if (!before) return before.error();

    FeatureGeometry out{image, {}};
    out.report.psnrBefore = out.report.psnrAfter = before->psnr();
    out.report.maxBefore = out.report.maxAfter = before->hausdorff();
    const int cores = tbb::info::default_concurrency();
    tbb::task_arena arena(options.threads > 0 ? std::min(options.threads, cores) : cores);
    arena.execute([&] { follow(mesh, measure, *grid, options, out); });
    return out;
} catch (const std::exception& failure) {
    return Error{ErrorKind::BadArgument, failure.what()};
}

Result<FeatureGeometry> followFeatures(const Mesh& mesh, const FloatImage& image, const GridSeam& seam,
                                       const FeatureOptions& options)
{
    return followFeatures(mesh, SurfaceMeasure(mesh, {.threads = options.threads}), image, seam, options);
}

} // namespace gimg

#include "gimg/fit.h"

#include "block_system.h"
#include "glued_grid.h"
#include "mesh_check.h"
#include "nearest_tree.h"
#include "surface_pull.h"

#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <string>

namespace gimg {
namespace {

constexpr double kHold = 0.05; // weight of staying in place, where 1 is that of a gap to the mesh
constexpr double kTolerance = 1e-3;
constexpr int kMostIterations = 200;

Vec3 areaVector(const std::vector<Vec3>& x, const Triangle& t)
{
    return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]) / 2;
}

/// The samples of the image as vertices in the frame of the mesh.
class GridSurface
{
public:
    GridSurface(const GluedGrid& grid, const UnitFrame& frame, const FloatImage& image)
        : grid_(grid), frame_(frame), image_(image), faces_(grid.faces(image)), fixed_(grid.vertexCount())
    {
        for (int v = 0; v < grid.vertexCount(); ++v) {
            const size_t at = size_t{3} * grid.sampleOf(v);
            positions_.push_back(
                frame.inside(Vec3(image.samples[at], image.samples[at + 1], image.samples[at + 2])));
            fixed_[v] = grid.onBoundary(v);
        }
    }

    const FloatImage& image() const { return image_; }

    void fit(SurfacePull& pull, double smoothing)
    {
        std::vector<Vec3> step = equations(pull, smoothing).solve(kTolerance, kMostIterations);
        shortenWhereCellsFold(step);
        for (size_t v = 0; v < step.size(); ++v) positions_[v] += step[v];
        image_ = imageOf(positions_);
        faces_ = grid_.faces(image_);
    }

private:
    BlockSystem equations(SurfacePull& pull, double smoothing) const
    {
        std::vector<SymmetricBlock> own(positions_.size());
        std::vector<Vec3> right(positions_.size());
        hold(smoothing, own, right);
        return BlockSystem(faces_, pull.equations(positions_, faces_), own, right, fixed_);
    }

    /// Adds  kHold area_v |step_v - smoothing T_v (middle of v's neighbours - x_v)|^2,  T_v along the
    /// surface.
    void hold(double smoothing, std::vector<SymmetricBlock>& own, std::vector<Vec3>& right) const
    {
        std::vector<Vec3> normal(positions_.size(), Vec3::Zero());
        std::vector<double> area(positions_.size(), 0);
        double total = 0;
        for (const Triangle& t : faces_) {
            const Vec3 a = areaVector(positions_, t);
            for (const int v : t) normal[v] += a, area[v] += a.norm() / 3;
            total += a.norm();
        }
        // Vertices between triangles without area need a hold too.
        const double least = 1e-6 * total / static_cast<double>(positions_.size());
        for (size_t v = 0; v < positions_.size(); ++v) {
            const double weight = kHold * std::max(area[v], least);
            const Vec3 n = normal[v].normalized(); // zero stays zero
            const Vec3 off = offMiddle(static_cast<int>(v));
            own[v].add(weight, 0, n, 1);
            right[v] = weight * smoothing * (off - n.dot(off) * n);
        }
    }

    Vec3 offMiddle(int v) const
    {
        const std::array<int, 4>& around = grid_.around(v);
        if (around[0] == GluedGrid::kNone) return Vec3::Zero();
        Vec3 sum = Vec3::Zero();
        for (const int neighbour : around) sum += positions_[neighbour];
        return sum / 4 - positions_[v];
    }

    /// A cell folds where one of its triangles does not face as the cell did before, and both did then.
    void shortenWhereCellsFold(std::vector<Vec3>& step) const
    {
        constexpr int kHalvings = 6; // then they stay, which ends it
        std::vector<Vec3> moved(positions_.size());
        for (int attempt = 0;; ++attempt) {
            for (size_t v = 0; v < moved.size(); ++v) moved[v] = positions_[v] + step[v];
            const std::vector<bool> shorter = cornersOfFolds(moved);
            if (std::find(shorter.begin(), shorter.end(), true) == shorter.end()) return;
            for (size_t v = 0; v < step.size(); ++v)
                if (shorter[v]) step[v] *= attempt < kHalvings ? 0.5 : 0.0;
        }
    }

    std::vector<bool> cornersOfFolds(const std::vector<Vec3>& moved) const
    {
        constexpr double kLeast = 0.02; // of the cell's area that a triangle keeps
        const std::vector<Triangle> faces = grid_.faces(imageOf(moved));
        std::vector<bool> corner(moved.size(), false);
        for (size_t f = 0; f < faces_.size(); f += 2) {
            const Vec3 cell = areaVector(positions_, faces_[f]) + areaVector(positions_, faces_[f + 1]);
            const auto turned = [&](const std::vector<Vec3>& x, const Triangle& t) {
                return !(areaVector(x, t).dot(cell) > kLeast * cell.squaredNorm());
            };
            if (!turned(moved, faces[f]) && !turned(moved, faces[f + 1])) continue;
            if (turned(positions_, faces_[f]) || turned(positions_, faces_[f + 1])) continue;
            for (const size_t g : {f, f + 1})
                for (const int v : faces_[g]) corner[v] = true;
        }
        return corner;
    }

    FloatImage imageOf(const std::vector<Vec3>& positions) const
    {
        FloatImage image = image_;
        const int samples = image.width * image.height;
        for (int s = 0; s < samples; ++s) {
            const int v = grid_.vertexOf(s);
            if (fixed_[v]) continue;
            const Vec3 p = frame_.outside(positions[v]);
            for (int c = 0; c < 3; ++c) image.samples[size_t{3} * s + c] = static_cast<float>(p[c]);
        }
        return image;
    }

    const GluedGrid& grid_;
    const UnitFrame& frame_;
    FloatImage image_;
    std::vector<Triangle> faces_;
    std::vector<Vec3> positions_;
    std::vector<bool> fixed_;
};

std::optional<Error> objection(const FitOptions& options)
{
    if (options.rounds < 1 || options.rounds > 100)
        return Error{ErrorKind::BadArgument,
                     std::to_string(options.rounds) + " rounds: 1 to 100 are allowed"};
    if (options.threads < 0) return Error{ErrorKind::BadArgument, "the number of threads is negative"};
    if (!(options.smoothing >= 0 && options.smoothing <= 1))
        return Error{ErrorKind::BadArgument, "smoothing is not between 0 and 1"};
    return std::nullopt;
}

std::optional<Error> objectionToMates(const FloatImage& image, const GluedGrid& grid)
{
    const int samples = image.width * image.height;
    for (int s = 0; s < samples; ++s) {
        const int mate = grid.sampleOf(grid.vertexOf(s));
        const float *a = &image.samples[size_t{3} * s], *b = &image.samples[size_t{3} * mate];
        if (!std::equal(a, a + 3, b))
            return Error{ErrorKind::BadArgument, "samples " + std::to_string(mate) + " and " +
                                                     std::to_string(s) + " are glued, but differ"};
    }
    return std::nullopt;
}

Result<double> psnrOf(const GluedGrid& grid, const FloatImage& image, const SurfaceMeasure& measure)
{
    Mesh mesh;
    for (int v = 0; v < grid.vertexCount(); ++v) {
        const size_t at = size_t{3} * grid.sampleOf(v);
        mesh.positions.emplace_back(image.samples[at], image.samples[at + 1], image.samples[at + 2]);
    }
    mesh.faces = grid.faces(image);
    const Result<SurfaceDistance> distance = measure.against(mesh);
    if (!distance) return distance.error();
    return distance->psnr();
}

// Samples drawn on the mesh: as many as the image has, more if they are few.
int samplesFor(int pixels)
{
    constexpr int kFew = 100000, kMostAPixel = 16;
    return std::max(pixels, std::min(kFew, kMostAPixel * pixels));
}

FloatImage fitted(const Mesh& mesh, const FloatImage& image, const GluedGrid& grid, const FitOptions& options)
{
    const UnitFrame frame(mesh);
    NearestTree tree(frame.inside(mesh), mesh.faces);
    tree.makeNormals();
    SurfacePull pull(std::move(tree), samplesFor(image.width * image.height));
    GridSurface surface(grid, frame, image);
    for (int round = 0; round < options.rounds; ++round) surface.fit(pull, options.smoothing);
    return surface.image();
}

} // namespace

Result<FittedGeometry> fitGeometry(const Mesh& mesh, const SurfaceMeasure& measure, const FloatImage& image,
                                   const GridSeam& seam, const FitOptions& options)
try {
    if (const std::optional<Error> error = objectionToTriangles(mesh, "the mesh")) return *error;
    if (const std::optional<Error> error = objection(options)) return *error;
    if (const std::optional<Error> error = objectionToImage(image)) return *error;
    const Result<GluedGrid> grid = GluedGrid::of(seam, image.width);
    if (!grid) return grid.error();
    if (const std::optional<Error> error = objectionToMates(image, *grid)) return *error;
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

#include "grid_surface.h"

#include <algorithm>
#include <string>

namespace gimg {
namespace {

constexpr double kHold = 0.05; // weight of staying in place, where 1 is that of a gap to the mesh
constexpr double kRail = 1e3;  // weight of staying on a line
constexpr double kTolerance = 1e-3;
constexpr int kMostIterations = 200;

} // namespace

GridSurface::GridSurface(const GluedGrid& grid, const UnitFrame& frame, const FloatImage& image)
    : grid_(grid), frame_(frame), image_(image), faces_(grid.faces(image)), fixed_(grid.vertexCount())
{
    for (const Vec3& p : grid.positions(image.samples)) positions_.push_back(frame.inside(p));
    for (int v = 0; v < grid.vertexCount(); ++v) fixed_[v] = grid.onBoundary(v);
}

void GridSurface::fit(SurfacePull& pull, double smoothing, const std::vector<Rail>& rails)
{
    std::vector<Vec3> step = equations(pull, smoothing, rails).solve(kTolerance, kMostIterations);
    for (size_t v = 0; v < rails.size(); ++v) // what the weight leaves
        if (rails[v].freedom == Freedom::Along)
            step[v] = rails[v].direction.dot(step[v]) * rails[v].direction;
    shortenWhereCellsFold(step);
    std::vector<Vec3> moved = positions_;
    for (size_t v = 0; v < step.size(); ++v) moved[v] += step[v];
    take(moved);
}

void GridSurface::place(int vertex, const Vec3& to)
{
    const Vec3 p = frame_.outside(to);
    for (int k = firstSample_[vertex]; k < firstSample_[vertex + 1]; ++k)
        for (int c = 0; c < 3; ++c) image_.samples[size_t{3} * samples_[k] + c] = static_cast<float>(p[c]);
    positions_[vertex] = frame_.inside(p.cast<float>().cast<double>());
    for (const int cell : cellsAt(vertex)) splitAgain(cell);
}

void GridSurface::splitAgain(int cell)
{
    const int n = grid_.side(), i = cell % (n - 1), j = cell / (n - 1);
    if (i == 0 || i == n - 2 || j == 0 || j == n - 2) return; // their diagonals do not depend on the samples
    const auto length2 = [&](int from, int to) {
        double sum = 0;
        for (int c = 0; c < 3; ++c) {
            const double d =
                double{image_.samples[size_t{3} * from + c]} - double{image_.samples[size_t{3} * to + c]};
            sum += d * d;
        }
        return sum;
    };
    const int s = j * n + i;
    const bool rising = length2(s, s + n + 1) <= length2(s + 1, s + n);
    const auto vertex = [&](int sample) { return grid_.vertexOf(sample); };
    const int a = vertex(s), b = vertex(s + 1), c = vertex(s + n + 1), d = vertex(s + n);
    faces_[2 * cell] = {a, b, rising ? c : d};
    faces_[2 * cell + 1] = {rising ? a : b, c, d};
}

void GridSurface::findCells()
{
    const int n = grid_.side(), samples = n * n;
    firstSample_.assign(positions_.size() + 1, 0);
    for (int s = 0; s < samples; ++s) ++firstSample_[grid_.vertexOf(s) + 1];
    for (size_t v = 0; v < positions_.size(); ++v) firstSample_[v + 1] += firstSample_[v];
    samples_.resize(samples);
    std::vector<int> next(firstSample_.begin(), firstSample_.end() - 1);
    for (int s = 0; s < samples; ++s) samples_[next[grid_.vertexOf(s)]++] = s;
    firstCell_.assign(1, 0);
    for (size_t v = 0; v < positions_.size(); ++v) {
        std::vector<int> cells;
        for (int k = firstSample_[v]; k < firstSample_[v + 1]; ++k) {
            const int i = samples_[k] % n, j = samples_[k] / n;
            for (const auto& [x, y] : {std::pair(i - 1, j - 1), {i, j - 1}, {i - 1, j}, {i, j}})
                if (x >= 0 && y >= 0 && x < n - 1 && y < n - 1) cells.push_back(y * (n - 1) + x);
        }
        std::sort(cells.begin(), cells.end());
        cells_.insert(cells_.end(), cells.begin(), std::unique(cells.begin(), cells.end()));
        firstCell_.push_back(static_cast<int>(cells_.size()));
    }
}

void GridSurface::take(const std::vector<Vec3>& positions)
{
    positions_ = positions;
    image_ = imageOf(positions_);
    faces_ = grid_.faces(image_);
}

BlockSystem GridSurface::equations(SurfacePull& pull, double smoothing, const std::vector<Rail>& rails) const
{
    std::vector<SymmetricBlock> own(positions_.size());
    std::vector<Vec3> right(positions_.size());
    hold(smoothing, rails, own, right);
    std::vector<bool> fixed = fixed_;
    for (size_t v = 0; v < rails.size(); ++v)
        if (rails[v].freedom == Freedom::None) fixed[v] = true;
    return BlockSystem(faces_, pull.equations(positions_, faces_), own, right, fixed);
}

/// Adds  kHold area_v |step_v - smoothing T_v (middle of v's neighbours - x_v)|^2,  T_v along the surface.
void GridSurface::hold(double smoothing, const std::vector<Rail>& rails, std::vector<SymmetricBlock>& own,
                       std::vector<Vec3>& right) const
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
        if (rails.empty() || rails[v].freedom != Freedom::Along) continue;
        const Vec3& d = rails[v].direction;
        own[v].add(kRail * std::max(area[v], least), -1, d, 1);
        right[v] = d.dot(right[v]) * d;
    }
}

Vec3 GridSurface::offMiddle(int v) const
{
    const std::array<int, 4>& around = grid_.around(v);
    if (around[0] == GluedGrid::kNone) return Vec3::Zero();
    Vec3 sum = Vec3::Zero();
    for (const int neighbour : around) sum += positions_[neighbour];
    return sum / 4 - positions_[v];
}

/// A cell folds where one of its triangles does not face as the cell did before, and both did then.
void GridSurface::shortenWhereCellsFold(std::vector<Vec3>& step) const
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

std::vector<bool> GridSurface::cornersOfFolds(const std::vector<Vec3>& moved) const
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

FloatImage GridSurface::imageOf(const std::vector<Vec3>& positions) const
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

int pullSamplesFor(int pixels)
{
    constexpr int kFew = 100000, kMostAPixel = 16;
    return std::max(pixels, std::min(kFew, kMostAPixel * pixels));
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

Result<GluedGrid> gridOf(const FloatImage& image, const GridSeam& seam)
{
    if (const std::optional<Error> error = objectionToImage(image)) return *error;
    Result<GluedGrid> grid = GluedGrid::of(seam, image.width);
    if (!grid) return grid;
    if (const std::optional<Error> error = objectionToMates(image, *grid)) return *error;
    return grid;
}

std::optional<Error> objectionToRounds(int rounds, double smoothing, int threads)
{
    if (rounds < 1 || rounds > 100)
        return Error{ErrorKind::BadArgument, std::to_string(rounds) + " rounds: 1 to 100 are allowed"};
    if (threads < 0) return Error{ErrorKind::BadArgument, "the number of threads is negative"};
    if (!(smoothing >= 0 && smoothing <= 1))
        return Error{ErrorKind::BadArgument, "smoothing is not between 0 and 1"};
    return std::nullopt;
}

Mesh meshOf(const GluedGrid& grid, const FloatImage& image)
{
    Mesh mesh;
    mesh.positions = grid.positions(image.samples);
    mesh.faces = grid.faces(image);
    return mesh;
}

} // namespace gimg

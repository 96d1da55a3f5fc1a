#include "gimg/distance.h"

#include "area_sampler.h"
#include "mesh_check.h"
#include "nearest_tree.h"

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace gimg {

double SurfaceDistance::rms() const { return std::max(rmsRefToTest, rmsTestToRef); }
double SurfaceDistance::hausdorff() const { return std::max(maxRefToTest, maxTestToRef); }
double SurfaceDistance::psnr() const
{
    return rms() > 0 ? 20 * std::log10(diagonal / rms()) : std::numeric_limits<double>::infinity();
}
std::optional<double> SurfaceDistance::normalRms() const
{
    if (!normalsRefToTest || !normalsTestToRef) return std::nullopt;
    return std::max(normalsRefToTest->rms, normalsTestToRef->rms);
}

namespace {

/// A surface in the frame of the reference: a tree for nearest points, samples, and the vertices.
class Surface
{
public:
    Surface(const Mesh& mesh, const UnitFrame& frame, const DistanceOptions& options)
        : tree_(frame.inside(mesh), mesh.faces)
    {
        if (tooFar()) return;
        const AreaSampler sampler(tree_.positions(), tree_.faces());
        hasArea_ = sampler.hasArea();
        if (!hasArea_) return;
        takePoints(sampler, options);
        if (options.normals) tree_.makeNormals();
    }

    bool tooFar() const { return tree_.tooLarge(); }
    bool hasArea() const { return hasArea_; }
    const NearestTree& tree() const { return tree_; }

    /// The samples, then every vertex of a face.
    const std::vector<Vec3>& points() const { return points_; }
    /// Of every sample, where normals are asked for.
    const std::vector<int>& sampleFaces() const { return sampleFaces_; }

private:
    void takePoints(const AreaSampler& sampler, const DistanceOptions& options)
    {
        const std::vector<Vec3>& positions = tree_.positions();
        points_.reserve(static_cast<size_t>(options.samples) + positions.size());
        for (int i = 0; i < options.samples; ++i) {
            const AreaSampler::Sample sample = sampler.sample(i, options.samples, options.seed);
            if (options.normals) sampleFaces_.push_back(sample.face);
            points_.push_back(sample.point);
        }
        std::vector<bool> taken(positions.size(), false);
        for (const Triangle& t : tree_.faces())
            for (int v : t) {
                if (!taken[v]) points_.push_back(positions[v]);
                taken[v] = true;
            }
    }

    NearestTree tree_;
    bool hasArea_ = false;
    std::vector<Vec3> points_;
    std::vector<int> sampleFaces_;
};

struct OneSided
{
    double rms = 0;
    double max = 0;
    Vec3 maxAt = Vec3::Zero();
    double quantile = 0;
    std::optional<NormalError> normals;
};

/// In degrees; negative where one of them is no normal. Exact for small angles, which acos is not.
double angleBetween(const Vec3& a, const Vec3& b)
{
    if (a.isZero(0) || b.isZero(0)) return -1;
    return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
}

std::optional<NormalError> meanAngle(const std::vector<double>& angles)
{
    double sum = 0, sumOfSquares = 0;
    int64_t count = 0;
    for (double angle : angles) {
        if (angle < 0) continue;
        ++count;
        sum += angle;
        sumOfSquares += angle * angle;
    }
    if (count == 0) return std::nullopt;
    return NormalError{std::sqrt(sumOfSquares / static_cast<double>(count)),
                       sum / static_cast<double>(count)};
}

/// The smallest value that is not exceeded by the part `q` of all values.
double quantile(std::vector<double> values, double q)
{
    const double rank = std::ceil(q * static_cast<double>(values.size()));
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

OneSided distances(const Surface& from, const Surface& to, const DistanceOptions& options)
{
    const std::vector<Vec3>& points = from.points();
    const size_t withNormal = options.normals ? from.sampleFaces().size() : 0;
    std::vector<double> distance(points.size()), angle(withNormal);
    const int cores = tbb::info::default_concurrency();
    tbb::task_arena arena(options.threads > 0 ? std::min(options.threads, cores) : cores);
    const auto measure = [&](const tbb::blocked_range<size_t>& range) {
        // Points follow the faces, so the face nearest to one is near the next; what is found is the same
        // from any.
        NearestTree::Found found{0, 0};
        for (size_t i = range.begin(); i < range.end(); ++i) {
            if (i < withNormal)
                angle[i] = angleBetween(from.tree().faceNormal(from.sampleFaces()[i]),
                                        to.tree().nearestNormal(points[i], found));
            else
                found = to.tree().nearest(points[i], found.face);
            distance[i] = to.tree().distance(found.distance2);
        }
    };
    arena.execute([&] { tbb::parallel_for(tbb::blocked_range<size_t>(0, points.size(), 256), measure); });
    // Summed in order, so that the threads leave no trace.
    double sum = 0;
    for (int i = 0; i < options.samples; ++i) sum += distance[i] * distance[i];
    const auto farthest = std::max_element(distance.begin(), distance.end());
    OneSided result;
    result.rms = std::sqrt(sum / options.samples);
    result.max = *farthest;
    result.maxAt = points[static_cast<size_t>(farthest - distance.begin())];
    result.normals = meanAngle(angle);
    if (options.quantile > 0)
        result.quantile = quantile({distance.begin(), distance.begin() + options.samples}, options.quantile);
    return result;
}

} // namespace

struct SurfaceMeasure::Reference
{
    DistanceOptions options;
    std::optional<Error> error;
    std::optional<UnitFrame> frame;
    std::optional<Surface> surface;
    double diagonal = 0;

    Reference(const Mesh& mesh, const DistanceOptions& o)
        : options(o), error(objectionToTriangles(mesh, "the reference mesh"))
    {
        if (options.samples < 1) error = Error{ErrorKind::BadArgument, "no samples"};
        if (!(options.quantile >= 0 && options.quantile <= 1))
            error = Error{ErrorKind::BadArgument, "a quantile lies between 0 and 1"};
        if (error) return;
        try {
            build(mesh);
        } catch (const std::exception& failure) {
            error = Error{ErrorKind::BadArgument, failure.what()};
        }
    }

    void build(const Mesh& mesh)
    {
        frame.emplace(mesh);
        diagonal = boundingBoxDiagonal(mesh);
        surface.emplace(mesh, *frame, options);
        if (!surface->hasArea()) error = Error{ErrorKind::EmptyMesh, "the reference mesh has no area"};
    }
};

SurfaceMeasure::SurfaceMeasure(const Mesh& reference, const DistanceOptions& options)
    : reference_(std::make_unique<const Reference>(reference, options))
{
}
SurfaceMeasure::~SurfaceMeasure() = default;
SurfaceMeasure::SurfaceMeasure(SurfaceMeasure&&) noexcept = default;
SurfaceMeasure& SurfaceMeasure::operator=(SurfaceMeasure&&) noexcept = default;

Result<SurfaceDistance> SurfaceMeasure::against(const Mesh& test) const
try {
    const Reference& ref = *reference_;
    if (ref.error) return *ref.error;
    if (const std::optional<Error> error = objectionToTriangles(test, "the test mesh")) return *error;
    const Surface surface(test, *ref.frame, ref.options);
    if (surface.tooFar())
        return Error{ErrorKind::BadArgument, "the meshes differ in size or place beyond measure"};
    if (!surface.hasArea()) return Error{ErrorKind::EmptyMesh, "the test mesh has no area"};
    const OneSided forth = distances(*ref.surface, surface, ref.options);
    const OneSided back = distances(surface, *ref.surface, ref.options);
    const double unit = 1 / ref.frame->scale;
    SurfaceDistance d;
    d.diagonal = ref.diagonal;
    d.rmsRefToTest = forth.rms * unit;
    d.maxRefToTest = forth.max * unit;
    d.maxRefToTestAt = ref.frame->outside(forth.maxAt);
    d.rmsTestToRef = back.rms * unit;
    d.maxTestToRef = back.max * unit;
    d.maxTestToRefAt = ref.frame->outside(back.maxAt);
    d.quantileRefToTest = forth.quantile * unit;
    d.quantileTestToRef = back.quantile * unit;
    d.normalsRefToTest = forth.normals;
    d.normalsTestToRef = back.normals;
    return d;
} catch (const std::exception& failure) {
    return Error{ErrorKind::BadArgument, failure.what()};
}

Result<SurfaceDistance> compareSurfaces(const Mesh& reference, const Mesh& test,
                                        const DistanceOptions& options)
{
    return SurfaceMeasure(reference, options).against(test);
}

} // namespace gimg

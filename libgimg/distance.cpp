#include "gimg/distance.h"

#include <embree3/rtcore.h>
#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <new>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace gimg {

double SurfaceDistance::rms() const { return std::max(rmsRefToTest, rmsTestToRef); }
double SurfaceDistance::hausdorff() const { return std::max(maxRefToTest, maxTestToRef); }
double SurfaceDistance::psnr() const
{
    return rms() > 0 ? 20 * std::log10(diagonal / rms()) : std::numeric_limits<double>::infinity();
}

namespace {

constexpr double kLargestCoordinate = 1e9;  // in units of the reference: beyond, floats cull nothing
constexpr double kRoundingDistance = 1e-14; // samples of a triangle lie this far off it
constexpr double kSliverSine2 = 1e-20;      // below, a normal is mostly rounding

/// The unit in which Embree's floats are safe: the reference centred, its longest side between 1/2 and 1. The
/// scale is a power of two, so that it costs no precision.
struct Frame
{
    Vec3 center = Vec3::Zero();
    double scale = 1;

    explicit Frame(const Mesh& mesh)
    {
        Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
        Vec3 high = -low;
        for (const Triangle& t : mesh.faces)
            for (int v : t) {
                low = low.cwiseMin(mesh.positions[v]);
                high = high.cwiseMax(mesh.positions[v]);
            }
        center = low + (high - low) / 2;
        int exponent = 0;
        std::frexp((high - low).maxCoeff(), &exponent);
        scale = std::ldexp(1.0, -exponent);
    }
    Vec3 inside(const Vec3& p) const { return (p - center) * scale; }
    Vec3 outside(const Vec3& p) const { return p / scale + center; }
};

/// Random numbers in [0, 1), a sequence of its own for every seed and index (SplitMix64).
class Random
{
public:
    Random(uint64_t seed, uint64_t index) : state_(mixed(mixed(seed + kStep) ^ index)) {}
    double next() { return static_cast<double>(mixed(state_ += kStep) >> 11) * 0x1p-53; }

private:
    static constexpr uint64_t kStep = 0x9e3779b97f4a7c15U;

    static uint64_t mixed(uint64_t z)
    {
        z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9U;
        z = (z ^ z >> 27) * 0x94d049bb133111ebU;
        return z ^ z >> 31;
    }

    uint64_t state_;
};

double squaredDistanceToSegment(const Vec3& q, const Vec3& a, const Vec3& b)
{
    const Vec3 ab = b - a, aq = q - a;
    const double length2 = ab.squaredNorm();
    const double t = length2 > 0 ? std::clamp(aq.dot(ab) / length2, 0.0, 1.0) : 0.0;
    return (aq - t * ab).squaredNorm();
}

double squaredDistanceToTriangle(const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c)
{
    const Vec3 ab = b - a, ac = c - a, bc = c - b;
    const Vec3 aq = q - a, bq = q - b;
    const Vec3 n = ab.cross(ac);
    const double n2 = n.squaredNorm();
    const bool hasNormal = n2 > kSliverSine2 * ab.squaredNorm() * ac.squaredNorm();
    if (hasNormal && ab.cross(aq).dot(n) >= 0 && bc.cross(bq).dot(n) >= 0 && aq.cross(ac).dot(n) >= 0) {
        const double h = aq.dot(n);
        return h * h / n2;
    }
    return std::min({squaredDistanceToSegment(q, a, b), squaredDistanceToSegment(q, b, c),
                     squaredDistanceToSegment(q, a, c)});
}

template <auto release> struct Release
{
    template <class T> void operator()(T* object) const { release(object); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release<rtcReleaseDevice>>;
using Scene = std::unique_ptr<std::remove_pointer_t<RTCScene>, Release<rtcReleaseScene>>;
using Geometry = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, Release<rtcReleaseGeometry>>;

/// A surface in the frame of the reference: a tree for nearest points, samples, and the vertices.
class Surface
{
public:
    Surface(const Mesh& mesh, const Frame& frame, const DistanceOptions& options, RTCDevice device)
        : faces_(mesh.faces), positions_(mesh.positions.size(), Vec3::Zero())
    {
        for (const Triangle& t : faces_)
            for (int v : t) {
                positions_[v] = frame.inside(mesh.positions[v]);
                extent_ = std::max(extent_, positions_[v].cwiseAbs().maxCoeff());
            }
        if (!(extent_ <= kLargestCoordinate)) return; // the tree would be of no use; see tooFar()
        double area = 0;
        areaUpTo_.reserve(faces_.size());
        for (const Triangle& t : faces_) {
            const Vec3& p = positions_[t[0]];
            areaUpTo_.push_back(area += (positions_[t[1]] - p).cross(positions_[t[2]] - p).norm());
        }
        if (!(area > 0)) return;
        takePoints(options);
        buildTree(device);
    }

    bool tooFar() const { return !(extent_ <= kLargestCoordinate); }
    bool hasArea() const { return !areaUpTo_.empty() && areaUpTo_.back() > 0; }

    /// The samples, then every vertex of a face.
    const std::vector<Vec3>& points() const { return points_; }

    /// @param nearestFace  in: any face, best one near q; out: the nearest one
    double distance(const Vec3& q, int& nearestFace) const
    {
        // Embree culls with rounded coordinates: neither those of the triangles nor that of the query may
        // hide the nearest triangle, so the search radius stays a little larger than the distance found.
        struct Nearest
        {
            const Surface& surface;
            const Vec3& q;
            double slack;
            int face;
            double distance2;

            float radius() const { return static_cast<float>(std::sqrt(distance2) * (1 + 1e-5) + slack); }
        };
        Nearest nearest{*this, q, 4e-7 * (extent_ + q.cwiseAbs().maxCoeff()), nearestFace,
                        squaredDistanceToFace(q, nearestFace)};
        const Eigen::Vector3f rounded = q.cast<float>();
        RTCPointQuery query{};
        query.x = rounded[0];
        query.y = rounded[1];
        query.z = rounded[2];
        query.radius = nearest.radius();
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        const auto visit = [](RTCPointQueryFunctionArguments* arguments) {
            Nearest& n = *static_cast<Nearest*>(arguments->userPtr);
            const int face = static_cast<int>(arguments->primID);
            const double distance2 = n.surface.squaredDistanceToFace(n.q, face);
            if (distance2 >= n.distance2) return false;
            n.distance2 = distance2;
            n.face = face;
            if (n.radius() >= arguments->query->radius) return false;
            arguments->query->radius = n.radius();
            return true;
        };
        rtcPointQuery(scene_.get(), &query, &context, visit, &nearest);
        nearestFace = nearest.face;
        const double distance = std::sqrt(nearest.distance2);
        return distance > kRoundingDistance * std::max(1.0, extent_) ? distance : 0.0;
    }

private:
    double squaredDistanceToFace(const Vec3& q, int face) const
    {
        const Triangle& t = faces_[face];
        return squaredDistanceToTriangle(q, positions_[t[0]], positions_[t[1]], positions_[t[2]]);
    }

    void takePoints(const DistanceOptions& options)
    {
        // One sample in each of equal slices of the area, in the order of the faces.
        points_.reserve(static_cast<size_t>(options.samples) + positions_.size());
        for (int i = 0; i < options.samples; ++i) {
            Random random(options.seed, static_cast<uint64_t>(i));
            const double area = areaUpTo_.back() * (i + random.next()) / options.samples;
            const auto at =
                std::upper_bound(areaUpTo_.begin(), areaUpTo_.end(), std::min(area, areaUpTo_.back()));
            const auto f = at != areaUpTo_.end() ? at - areaUpTo_.begin() : lastWithArea();
            const Triangle& t = faces_[static_cast<size_t>(f)];
            const double s = std::sqrt(random.next()), r = random.next();
            points_.push_back((1 - s) * positions_[t[0]] + s * (1 - r) * positions_[t[1]] +
                              s * r * positions_[t[2]]);
        }
        std::vector<bool> taken(positions_.size(), false);
        for (const Triangle& t : faces_)
            for (int v : t) {
                if (!taken[v]) points_.push_back(positions_[v]);
                taken[v] = true;
            }
    }

    std::ptrdiff_t lastWithArea() const
    {
        return std::lower_bound(areaUpTo_.begin(), areaUpTo_.end(), areaUpTo_.back()) - areaUpTo_.begin();
    }

    void buildTree(RTCDevice device)
    {
        const Geometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
        auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX,
                                                                     0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                                     positions_.size()));
        auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
            geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), faces_.size()));
        if (!vertices || !indices) throw std::bad_alloc();
        for (const Vec3& p : positions_)
            for (double x : p) *vertices++ = static_cast<float>(x);
        for (const Triangle& t : faces_)
            for (int v : t) *indices++ = static_cast<unsigned>(v);
        rtcCommitGeometry(geometry.get());
        scene_.reset(rtcNewScene(device));
        rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
        rtcAttachGeometry(scene_.get(), geometry.get());
        rtcCommitScene(scene_.get());
        if (rtcGetDeviceError(device) != RTC_ERROR_NONE) throw std::bad_alloc();
    }

    std::vector<Triangle> faces_;
    std::vector<Vec3> positions_;
    double extent_ = 0; ///< largest absolute coordinate
    std::vector<double> areaUpTo_;
    std::vector<Vec3> points_;
    Scene scene_;
};

struct OneSided
{
    double rms = 0;
    double max = 0;
    Vec3 maxAt = Vec3::Zero();
};

OneSided distances(const Surface& from, const Surface& to, const DistanceOptions& options)
{
    const std::vector<Vec3>& points = from.points();
    std::vector<double> distance(points.size());
    const int cores = tbb::info::default_concurrency();
    tbb::task_arena arena(options.threads > 0 ? std::min(options.threads, cores) : cores);
    arena.execute([&] {
        tbb::parallel_for(tbb::blocked_range<size_t>(0, points.size(), 256),
                          [&](const tbb::blocked_range<size_t>& range) {
                              // Points follow the faces, so the face nearest to one is near the next; the
                              // distance is the same from any.
                              int nearestFace = 0;
                              for (size_t i = range.begin(); i < range.end(); ++i)
                                  distance[i] = to.distance(points[i], nearestFace);
                          });
    });
    // Summed in order, so that the threads leave no trace.
    double sum = 0;
    for (int i = 0; i < options.samples; ++i) sum += distance[i] * distance[i];
    const auto farthest = std::max_element(distance.begin(), distance.end());
    return {std::sqrt(sum / options.samples), *farthest,
            points[static_cast<size_t>(farthest - distance.begin())]};
}

/// Empty where the mesh can be measured.
std::optional<Error> objection(const Mesh& mesh, const std::string& which)
{
    if (mesh.faces.empty()) return Error{ErrorKind::EmptyMesh, "the " + which + " mesh has no faces"};
    for (size_t f = 0; f < mesh.faces.size(); ++f)
        for (int v : mesh.faces[f]) {
            if (v < 0 || v >= mesh.vertexCount())
                return Error{ErrorKind::BadArgument, "the " + which + " mesh: face " + std::to_string(f) +
                                                         " names vertex " + std::to_string(v) + " of " +
                                                         std::to_string(mesh.vertexCount())};
            if (!mesh.positions[v].allFinite())
                return Error{ErrorKind::NotFinite,
                             "the " + which + " mesh: vertex " + std::to_string(v) + " is not finite"};
        }
    return std::nullopt;
}

} // namespace

struct SurfaceMeasure::Reference
{
    DistanceOptions options;
    std::optional<Error> error;
    Device device;
    std::optional<Frame> frame;
    std::optional<Surface> surface;
    double diagonal = 0;

    Reference(const Mesh& mesh, const DistanceOptions& o) : options(o), error(objection(mesh, "reference"))
    {
        if (options.samples < 1) error = Error{ErrorKind::BadArgument, "no samples"};
        if (error) return;
        try {
            build(mesh);
        } catch (const std::exception& failure) {
            error = Error{ErrorKind::BadArgument, failure.what()};
        }
    }

    void build(const Mesh& mesh)
    {
        device.reset(rtcNewDevice(nullptr));
        if (!device) throw std::bad_alloc();
        frame.emplace(mesh);
        diagonal = boundingBoxDiagonal(mesh);
        surface.emplace(mesh, *frame, options, device.get());
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
    if (const std::optional<Error> error = objection(test, "test")) return *error;
    const Surface surface(test, *ref.frame, ref.options, ref.device.get());
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

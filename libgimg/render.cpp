#include "gimg/render.h"

#include "embree_scene.h"
#include "mesh_check.h"

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <string>
#include <vector>

namespace gimg {

namespace {

constexpr double kFill = 0.94;     // of the image, by the mesh that the camera was made for
constexpr int kLargestSide = 8192; // pixels
constexpr int kLargestSupersampling = 8;
constexpr double kLargestCoordinate = 1e9; // in units of the camera: beyond, floats see nothing
constexpr double kSmallestUpAngleSine = 1e-6;

std::optional<Error> objection(const RenderOptions& options)
{
    const auto outside = [](int value, int largest) { return value < 1 || value > largest; };
    if (outside(options.width, kLargestSide) || outside(options.height, kLargestSide))
        return Error{ErrorKind::BadArgument, "an image of " + std::to_string(options.width) + " x " +
                                                 std::to_string(options.height) + " pixels"};
    if (outside(options.supersampling, kLargestSupersampling))
        return Error{ErrorKind::BadArgument, "supersampling " + std::to_string(options.supersampling)};
    return std::nullopt;
}

/// The mesh as the camera sees it: x to the right, y upwards, z towards the eye, in units of the image's
/// larger side.
struct Seen
{
    const Mesh& mesh;
    const RenderOptions& options;
    double pixel = 0;     ///< size of a pixel in the camera's unit
    Eigen::Matrix3d turn; ///< rows: right, up, towards the eye
    std::vector<Vec3> vertexNormals;
    EmbreeScene tree;
    float nearest = 0; ///< largest z
};

Vec3 faceNormal(const Mesh& mesh, int face)
{
    const Triangle& t = mesh.faces[face];
    const Vec3& p = mesh.positions[t[0]];
    return (mesh.positions[t[1]] - p).stableNormalized().cross((mesh.positions[t[2]] - p).stableNormalized());
}

struct Hit
{
    int face = -1;
    float depth = std::numeric_limits<float>::infinity();
    double u = 0, v = 0; ///< weights of the second and third corner
};

/// Embree shows every triangle on the ray to this filter, which takes none: which of several triangles at
/// one depth comes first would depend on the shape of the tree.
struct NearestOfAll : RTCIntersectContext
{
    Hit hit;

    static void take(const RTCFilterFunctionNArguments* arguments)
    {
        arguments->valid[0] = 0;
        const auto& ray = *reinterpret_cast<const RTCRay*>(arguments->ray);
        const auto& found = *reinterpret_cast<const RTCHit*>(arguments->hit);
        Hit& best = static_cast<NearestOfAll*>(arguments->context)->hit;
        const int face = static_cast<int>(found.primID);
        if (ray.tfar > best.depth || (ray.tfar == best.depth && face > best.face)) return;
        best = {face, ray.tfar, double{found.u}, double{found.v}};
    }
};

Hit shoot(const Seen& scene, double x, double y)
{
    NearestOfAll context;
    rtcInitIntersectContext(&context);
    context.filter = NearestOfAll::take;
    RTCRayHit ray{};
    ray.ray.org_x = static_cast<float>(x);
    ray.ray.org_y = static_cast<float>(y);
    ray.ray.org_z = scene.nearest;
    ray.ray.dir_z = -1;
    ray.ray.tfar = std::numeric_limits<float>::infinity();
    ray.ray.mask = ~0U;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene.tree.get(), &context, &ray);
    return context.hit;
}

double positive(double x) { return std::max(x, 0.0); }

/// @param normal  of unit length, in the camera's axes, towards the eye
Vec3 lit(const Vec3& color, const Vec3& normal, double shade)
{
    static const Vec3 key = Vec3(-0.5, 0.7, 0.65).normalized();
    static const Vec3 fill = Vec3(0.8, 0.1, 0.4).normalized();
    static const Vec3 halfway = (key + Vec3(0, 0, 1)).normalized();
    const double light = 0.3 + 0.75 * positive(normal.dot(key)) + 0.15 * positive(normal.dot(fill));
    const double shine = std::pow(positive(normal.dot(halfway)), 40);
    return color + shade * ((light - 1) * color + Vec3::Constant(25 * shine));
}

Vec3 shaded(const Seen& scene, const Hit& hit)
{
    const RenderOptions& options = scene.options;
    const auto vec = [](const Color& c) { return Vec3(c[0], c[1], c[2]); };
    const Triangle& t = scene.mesh.faces[hit.face];
    const Vec3 at(1 - hit.u - hit.v, hit.u, hit.v);
    Vec3 normal = (scene.turn * faceNormal(scene.mesh, hit.face)).normalized();
    const bool back = normal[2] < 0;
    if (options.smooth) {
        Vec3 smooth = Vec3::Zero();
        for (int k = 0; k < 3; ++k) smooth += at[k] * scene.vertexNormals[t[k]];
        if (smooth.squaredNorm() > 0) normal = (scene.turn * smooth).normalized();
    }
    if (normal[2] < 0) normal = -normal;
    Vec3 color = vec(options.surface);
    if (back && options.inside)
        color = vec(*options.inside);
    else if (options.color) {
        Vec3 point = Vec3::Zero();
        for (int k = 0; k < 3; ++k) point += at[k] * scene.mesh.positions[t[k]];
        color = vec(options.color(hit.face, at, point));
    }
    return lit(color, normal, options.shade).cwiseMax(0).cwiseMin(255);
}

Color pixel(const Seen& scene, int column, int row)
{
    const RenderOptions& options = scene.options;
    const int n = options.supersampling;
    Vec3 sum = Vec3::Zero();
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const double x = column + (i + 0.5) / n - options.width / 2.0;
            const double y = options.height / 2.0 - row - (j + 0.5) / n;
            const Hit hit = shoot(scene, x * scene.pixel, y * scene.pixel);
            for (int c = 0; hit.face < 0 && c < 3; ++c) sum[c] += options.background[c];
            if (hit.face >= 0) sum += shaded(scene, hit);
        }
    Color color;
    for (int c = 0; c < 3; ++c) color[c] = static_cast<uint8_t>(std::lround(sum[c] / (n * n)));
    return color;
}

/// The vertices in the camera's axes and unit; empty where floats cannot hold them.
std::vector<Vec3> seen(const Mesh& mesh, const Camera& camera, const Eigen::Matrix3d& turn, double unit)
{
    std::vector<Vec3> positions(mesh.positions.size(), Vec3::Zero());
    for (const Triangle& t : mesh.faces)
        for (int v : t) {
            positions[v] = turn * ((mesh.positions[v] - camera.center) / unit);
            if (!(positions[v].cwiseAbs().maxCoeff() < kLargestCoordinate)) return {};
        }
    return positions;
}

Eigen::Matrix3d axes(const Camera& camera)
{
    Eigen::Matrix3d turn;
    turn << camera.right.transpose(), camera.up.transpose(), -camera.toward.transpose();
    return turn;
}

RgbImage image(const Seen& scene)
{
    const RenderOptions& options = scene.options;
    RgbImage image{options.width, options.height, {}};
    image.samples.resize(3 * static_cast<size_t>(options.width) * static_cast<size_t>(options.height));
    const int cores = tbb::info::default_concurrency();
    tbb::task_arena arena(options.threads > 0 ? std::min(options.threads, cores) : cores);
    arena.execute([&] {
        tbb::parallel_for(0, options.height, [&](int row) {
            uint8_t* out = &image.samples[3 * static_cast<size_t>(row) * static_cast<size_t>(options.width)];
            for (int column = 0; column < options.width; ++column)
                for (uint8_t sample : pixel(scene, column, row)) *out++ = sample;
        });
    });
    return image;
}

} // namespace

Result<Camera> cameraFor(const Mesh& mesh, const View& view)
{
    if (const std::optional<Error> error = objectionToTriangles(mesh, "the mesh")) return *error;
    Camera camera;
    camera.toward = view.toward.stableNormalized();
    const Vec3 across = camera.toward.cross(view.up.stableNormalized());
    if (!(across.norm() > kSmallestUpAngleSine))
        return Error{ErrorKind::BadArgument, "the view has no direction, or up lies along it"};
    camera.right = across.normalized();
    camera.up = camera.right.cross(camera.toward);
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    const Eigen::Matrix3d turn = axes(camera);
    for (const Triangle& t : mesh.faces)
        for (int v : t) {
            const Vec3 p = turn * mesh.positions[v];
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
    camera.center = turn.transpose() * (low + (high - low) / 2);
    camera.width = (high[0] - low[0]) / kFill;
    camera.height = (high[1] - low[1]) / kFill;
    if (!(camera.width > 0 || camera.height > 0)) camera.width = camera.height = 1;
    return camera;
}

Result<RgbImage> render(const Mesh& mesh, const RenderOptions& options)
try {
    if (const std::optional<Error> error = objectionToTriangles(mesh, "the mesh")) return *error;
    if (const std::optional<Error> error = objection(options)) return *error;
    const Result<Camera> camera = options.camera ? *options.camera : cameraFor(mesh, options.view);
    if (!camera) return camera.error();
    // A pixel is square, and the camera's rectangle lies within the image.
    const double size = std::max(camera->width / options.width, camera->height / options.height);
    const int side = std::max(options.width, options.height);
    if (!(size > 0)) return Error{ErrorKind::BadArgument, "the camera shows nothing"};
    Seen scene{mesh, options, 1.0 / side, axes(*camera), {}, {}};
    const std::vector<Vec3> positions = seen(mesh, *camera, scene.turn, size * side);
    if (positions.empty())
        return Error{ErrorKind::BadArgument, "the mesh is too large or too far off for the camera"};
    double nearest = -kLargestCoordinate;
    for (const Triangle& t : mesh.faces)
        for (int v : t) nearest = std::max(nearest, positions[v][2]);
    scene.nearest = static_cast<float>(nearest + 0.5);
    scene.tree = EmbreeScene(positions, mesh.faces, RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    if (options.smooth) scene.vertexNormals = vertexNormals(mesh);
    return image(scene);
} catch (const std::exception& failure) {
    return Error{ErrorKind::BadArgument, failure.what()};
}

} // namespace gimg

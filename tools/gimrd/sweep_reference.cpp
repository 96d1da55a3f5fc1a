#include "sweep_reference.h"

#include "../cli.h"

#include "gimg/decode.h"
#include "gimg/encode.h"
#include "gimg/mesh_io.h"

namespace gimg::gimrd {
namespace {

namespace fs = std::filesystem;

constexpr size_t kHashInNames = 12;
constexpr int kThumbnailSide = 224;

// Messages of the readers begin with the path: the name is enough, and the same on every machine.
Error named(Error error, const fs::path& path, const SweepMesh& mesh)
{
    const size_t at = error.message.find(path.string());
    if (at != std::string::npos)
        error.message.replace(at, path.string().size(), mesh.path.filename().string());
    return error;
}

struct Surface
{
    Mesh mesh;
    std::string note;
};

Result<Surface> readSurface(const fs::path& path, const SweepMesh& mesh)
{
    Result<MeshFile> whole = readMesh(path.string());
    if (whole) return Surface{std::move(whole->mesh), ""};
    const std::string refusal = named(whole.error(), path, mesh).message;
    Result<Mesh> triangles = readTriangles(path.string());
    if (!triangles) return named(triangles.error(), path, mesh);
    return Surface{std::move(*triangles), refusal};
}

// The grid mesh goes through a file, as a user's mesh would, so that the twins on its border are welded.
Result<Surface> readImageSurface(const SweepMesh& mesh, SweepFolder& folder)
{
    const Result<FloatImage> image = readF32(mesh.path.string());
    if (!image) return named(image.error(), mesh.path, mesh);
    const fs::path open = folder.temporary(".ply");
    const Status written = writeMesh(gridMesh(*image), open.string());
    if (!written) return written.error();
    Result<Surface> surface = readSurface(open, mesh);
    std::error_code ignored;
    fs::remove(open, ignored);
    return surface;
}

std::string hashed(const std::string& stem, const std::string& sha256, const std::string& extension)
{
    return stem + '-' + sha256.substr(0, kHashInNames) + extension;
}

} // namespace

Result<std::shared_ptr<SweepReference>> makeReference(const SweepMesh& mesh, const std::string& sha256,
                                                      SweepFolder& folder, int samples, int threads)
{
    Result<Surface> surface =
        isGridImage(mesh.path) ? readImageSurface(mesh, folder) : readSurface(mesh.path, mesh);
    if (!surface) return surface.error();
    const Result<Camera> camera = cameraFor(surface->mesh);
    if (!camera) return camera.error();
    const fs::path ply = folder.work(mesh.name) / hashed("input", sha256, ".ply");
    const fs::path draft = folder.temporary(".ply");
    Status written = writeMesh(surface->mesh, draft.string());
    if (written) written = folder.publish(draft, ply);
    if (!written) return written.error();
    const Status drawn =
        drawThumbnail(surface->mesh, *camera, folder, folder.thumbnail(mesh.name, "original"), threads);
    if (!drawn) return drawn.error();

    DistanceOptions options;
    options.samples = samples;
    options.normals = true;
    options.threads = threads;
    SurfaceMeasure measure(surface->mesh, options);
    Eigen::AlignedBox3d box;
    for (const Triangle& t : surface->mesh.faces)
        for (const int v : t) box.extend(surface->mesh.positions[v]);
    const double diagonal = box.diagonal().norm();
    return std::make_shared<SweepReference>(SweepReference{std::move(surface->mesh), std::move(surface->note),
                                                           diagonal, std::move(measure), *camera, ply});
}

Result<fs::path> makeGridImage(const SweepMesh& mesh, const std::string& sha256,
                               const SweepReference& reference, int grid, SweepFolder& folder, int threads)
{
    if (isGridImage(mesh.path)) return mesh.path;
    const fs::path place = folder.work(mesh.name) / hashed("grid-" + std::to_string(grid), sha256, ".f32");
    if (sideOfF32(place.string()) == grid) return place;
    EncodeOptions options;
    options.target = EncodeTarget::RawFloat;
    options.grid = grid;
    options.threads = threads;
    const Result<EncodedMesh> encoded = encodeMesh(reference.mesh, options);
    if (!encoded) return encoded.error();
    const Result<DecodedImages> images = decodeImages(encoded->file);
    if (!images) return images.error();
    const fs::path draft = folder.temporary(".f32");
    Status written = writeF32(images->geometry, draft.string());
    if (written) written = folder.publish(draft, place);
    if (!written) return written.error();
    return place;
}

Status drawThumbnail(const Mesh& mesh, const Camera& camera, SweepFolder& folder, const fs::path& place,
                     int threads)
{
    RenderOptions options;
    options.width = options.height = kThumbnailSide;
    options.camera = camera;
    options.threads = threads;
    const Result<RgbImage> image = render(mesh, options);
    if (!image) return image.error();
    const Result<std::vector<uint8_t>> png = pngBytes(*image);
    if (!png) return png.error();
    return folder.publishText(std::string(png->begin(), png->end()), place);
}

} // namespace gimg::gimrd

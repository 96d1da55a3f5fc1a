// gimg_no_cracks MESH...: encodes each mesh in 12,000 bytes and checks the mesh of every level of detail: a
// manifold of the input's genus and boundary loops, one vertex a class of grid points, all finite. Exit code
// 1 if one is not.
#include "gimg/decode.h"
#include "gimg/encode.h"
#include "gimg/mesh_io.h"
#include "manifold_check.h"

#include <algorithm>
#include <cstdio>

namespace {

using namespace gimg;

int zeroAreaTriangles(const Mesh& mesh)
{
    return static_cast<int>(std::count_if(mesh.faces.begin(), mesh.faces.end(), [&](const Triangle& f) {
        const Vec3& p = mesh.positions[f[0]];
        return !((mesh.positions[f[1]] - p).cross(mesh.positions[f[2]] - p).norm() > 0);
    }));
}

// What is wrong with a level, or nothing.
std::string fault(const Mesh& level, const Topology& expected)
{
    for (const Vec3& p : level.positions)
        if (!p.allFinite()) return "a vertex is not finite";
    const test::ManifoldCheck check = test::checkManifold(level.faces);
    if (!check.fault.empty()) return check.fault;
    if (check.genus != expected.genus || check.boundaries != expected.boundaries)
        return "genus " + std::to_string(check.genus) + ", " + std::to_string(check.boundaries) +
               " boundaries";
    return {};
}

bool checkMesh(const std::string& path)
{
    const Result<MeshFile> read = readMesh(path, {Weld::Auto, true});
    if (!read) return std::printf("%s\n", read.error().message.c_str()), false;
    EncodeOptions options;
    options.bytes = 12000;
    const Result<EncodedMesh> encoded = encodeMesh(read->mesh, options);
    if (!encoded) return std::printf("%s: %s\n", path.c_str(), encoded.error().message.c_str()), false;
    const Result<DecodedImages> images = decodeImages(encoded->file);
    if (!images) return std::printf("%s: %s\n", path.c_str(), images.error().message.c_str()), false;

    bool good = encoded->file.size() <= options.bytes;
    int zeroArea = 0;
    for (unsigned level = 0; level < images->info.levels; ++level) {
        const Result<Mesh> mesh = levelMesh(encoded->file, *images, level);
        const std::string wrong = mesh ? fault(*mesh, encoded->topology) : mesh.error().message;
        if (!wrong.empty()) std::printf("%s: level %u: %s\n", path.c_str(), level, wrong.c_str());
        good = good && wrong.empty();
        if (mesh) zeroArea += zeroAreaTriangles(*mesh);
    }
    const EncodeSeconds& s = encoded->seconds;
    std::printf("%-4s %-24s %7d faces  genus %3d  loops %3d  grid %4d  levels %u  %zu bytes  %.2f dB  "
                "efficiency %.3f  "
                "zero-area %d  %.1f s\n",
                good ? "ok" : "BAD", path.substr(path.rfind('/') + 1).c_str(), encoded->topology.faces,
                encoded->topology.genus, encoded->topology.boundaries, encoded->grid, images->info.levels,
                encoded->file.size(), encoded->psnr, encoded->stretchEfficiency, zeroArea,
                s.cut + s.parameterize + s.sample + s.code);
    return good;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc < 2) return std::fprintf(stderr, "usage: gimg_no_cracks MESH...\n"), 2;
    bool good = true;
    for (int i = 1; i < argc; ++i) {
        good = checkMesh(argv[i]) && good;
        std::fflush(stdout);
    }
    return good ? 0 : 1;
}

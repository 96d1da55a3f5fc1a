// Whether the search for extrema decides on a simplified mesh what it would decide on the mesh itself.
#include "gimg/cut.h"
#include "gimg/extrema.h"
#include "gimg/mesh_io.h"
#include "gimg/stretch.h"
#include "tools/cli.h"

#include <cstdio>
#include <limits>

using namespace gimg;

namespace {

// quarticStretchEnergy of the mesh itself, cut to the vertices and flattened.
double energyOf(const Mesh& mesh, const std::vector<int>& vertices)
{
    const Result<SquareDisk> square = layOutBorder(mesh, cutToDisk(mesh, vertices), {});
    if (!square) return std::numeric_limits<double>::infinity();
    const Result<Parameterization> map = flattenToSquare(*square);
    return map ? quarticStretchEnergy(square->disk.mesh, map->st) : std::numeric_limits<double>::infinity();
}

bool compare(const std::string& path)
{
    const Result<MeshFile> read = readMesh(path, {Weld::Auto, true});
    if (!read) return std::printf("%s: %s\n", path.c_str(), read.error().message.c_str()), false;
    const Mesh& mesh = read->mesh;
    ExtremaOptions whole;
    whole.faces = mesh.faceCount();
    const std::vector<int> simplified = findExtrema(mesh).vertices, full = findExtrema(mesh, whole).vertices;
    const double plain = energyOf(mesh, {});
    std::printf("| %s | %d | %zu | %zu | %.3f | %.3f |\n", path.c_str(), mesh.faceCount(), simplified.size(),
                full.size(), energyOf(mesh, simplified) / plain, energyOf(mesh, full) / plain);
    std::fflush(stdout);
    return true;
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App app(
        "Extrema found on a simplified mesh and on the mesh itself: their number, and what they leave "
        "of the energy of the mesh itself",
        "gimg_extrema_scale");
    std::vector<std::string> meshes;
    app.add_option("MESH", meshes, "meshes to search")->required();
    if (const auto done = cli::parse(app, argc, argv)) return *done;
    std::printf("| mesh | faces | extrema, simplified | extrema, mesh | energy, simplified | energy, mesh |\n"
                "|---|--:|--:|--:|--:|--:|\n");
    bool good = true;
    for (const std::string& mesh : meshes) good = compare(mesh) && good;
    return good ? cli::Done : cli::Refused;
}

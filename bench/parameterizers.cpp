// gimg_parameterizers [--repeat N] MESH...: maps of the same cut-open meshes to the plane, gimg's beside
// CGAL's.
#include "cgal_maps.h"
#include "tools/cli.h"

#include "gimg/extrema.h"
#include "gimg/linear_maps.h"
#include "gimg/mesh_io.h"
#include "gimg/stretch.h"

#include <CLI/App.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <limits>

namespace {

using namespace gimg;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double signedArea(const Mesh& mesh, const std::vector<Vec2>& st)
{
    double sum = 0;
    for (const Triangle& f : mesh.faces) {
        const Vec2 a = st[f[1]] - st[f[0]], b = st[f[2]] - st[f[0]];
        sum += 0.5 * (a.x() * b.y() - a.y() * b.x());
    }
    return sum;
}

struct Judged
{
    int flipped = 0;
    double stretch = 0; ///< L2, of an isometry 1; flipped triangles count as if they were not
};

// Maps may be mirrored (CGAL's borders run the other way) and of any size.
Judged judge(const Mesh& mesh, std::vector<Vec2> st)
{
    if (signedArea(mesh, st) < 0)
        for (Vec2& p : st) p.x() = -p.x();
    Judged judged;
    judged.flipped = flippedTriangles(mesh.faces, st);
    double energy = 0, planeArea = 0;
    for (Triangle f : mesh.faces) {
        const Mesh one{{mesh.positions[f[0]], mesh.positions[f[1]], mesh.positions[f[2]]}, {{0, 1, 2}}};
        std::vector<Vec2> corners = {st[f[0]], st[f[1]], st[f[2]]};
        if (signedArea(one, corners) < 0)
            for (Vec2& p : corners) p.x() = -p.x();
        energy += stretchEnergy(one, corners);
        planeArea += signedArea(one, corners);
    }
    // stretchEnergy's own scale is that of a map onto an area of 1.
    judged.stretch = std::sqrt(energy * planeArea) / surfaceArea(mesh);
    return judged;
}

struct Timed
{
    std::vector<Vec2> st;
    double seconds = 0; ///< of processor time on all threads, median
};

Timed timed(int repeat, const std::function<std::vector<Vec2>()>& run)
{
    Timed result;
    std::vector<double> seconds;
    for (int i = 0; i < repeat; ++i) {
        const std::clock_t start = std::clock();
        result.st = run();
        seconds.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    }
    std::nth_element(seconds.begin(), seconds.begin() + repeat / 2, seconds.end());
    result.seconds = seconds[static_cast<size_t>(repeat / 2)];
    return result;
}

class Table
{
public:
    Table(std::string name, const Mesh& mesh) : name_(std::move(name)), mesh_(mesh) {}

    Judged row(const std::string& map, const std::string& border, const Timed& timed,
               const std::string& error)
    {
        if (timed.st.empty()) {
            std::printf("%-12s %-18s %-11s %s\n", name_.c_str(), map.c_str(), border.c_str(), error.c_str());
            return {0, kInfinity};
        }
        const Judged judged = judge(mesh_, timed.st);
        std::printf("%-12s %-18s %-11s %10.4g %7d %8.2f\n", name_.c_str(), map.c_str(), border.c_str(),
                    judged.stretch, judged.flipped, timed.seconds);
        std::fflush(stdout);
        return judged;
    }

private:
    std::string name_;
    const Mesh& mesh_;
};

// A disk with the border on the square, whatever layout `unfold` would choose; the cut reaches the extrema.
Result<SquareDisk> openMesh(const std::string& path)
{
    const Result<MeshFile> read = readMesh(path, {Weld::Auto, true});
    if (!read) return read.error();
    const Extrema extrema = findExtrema(read->mesh);
    return layOutBorder(read->mesh, cutToDisk(read->mesh, extrema.vertices), {});
}

std::vector<Vec2> ourMap(const SquareDisk& square, MapKind kind, std::string& error)
{
    if (kind == MapKind::Stretch) {
        Result<Parameterization> map = mapToSquare(square, kind, {}, Density::Even);
        if (map) return std::move(map->st);
        return error = map.error().message, std::vector<Vec2>{};
    }
    Result<std::vector<Vec2>> st = linearMap(square, kind);
    if (st) return std::move(*st);
    return error = st.error().message, std::vector<Vec2>{};
}

bool compare(const std::string& path, int repeat)
{
    const Result<SquareDisk> square = openMesh(path);
    if (!square) return std::printf("%s: %s\n", path.c_str(), square.error().message.c_str()), false;
    std::string name = path.substr(path.rfind('/') + 1);
    name.resize(std::min(name.size(), name.rfind('.')));
    Table table(name, square->disk.mesh);

    double ours = 0, floater = 0, bestCgal = kInfinity, seconds = 0;
    for (MapKind kind : kMapKinds) {
        std::string error;
        const Timed run = timed(repeat, [&] { return ourMap(*square, kind, error); });
        const Judged judged = table.row(std::string("gimg ") + mapName(kind), "gimg's", run, error);
        if (kind == MapKind::Stretch) ours = judged.stretch, seconds = run.seconds;
        if (kind == MapKind::MeanValue) floater = judged.stretch;
    }
    const bench::CgalDisk cgal(*square);
    std::string beside = "ARAP fails";
    for (const bench::CgalMap& map : bench::cgalMaps()) {
        std::string error;
        const Timed run = timed(repeat, [&] { return cgal.run(map, error); });
        const Judged judged = table.row("CGAL " + map.map, map.border, run, error);
        if (!map.border.empty())
            bestCgal = std::min(bestCgal, judged.stretch);
        else if (!run.st.empty())
            beside = std::to_string(seconds / run.seconds) + " of ARAP's time";
    }
    std::printf("%-12s %d triangles; stretch is %.3g of CGAL's best square, %.3g of gimg mvc; %s\n\n",
                name.c_str(), square->disk.mesh.faceCount(), ours / bestCgal, ours / floater, beside.c_str());
    return true;
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App app("L2 stretch, flipped triangles and seconds of maps of the same cut-open meshes",
                 "gimg_parameterizers");
    int repeat = 3;
    std::vector<std::string> meshes;
    app.add_option("--repeat", repeat, "runs, of which the median time counts")->check(CLI::PositiveNumber);
    app.add_option("MESH", meshes, "meshes to compare on")->required();
    if (const auto done = cli::parse(app, argc, argv)) return *done;
    std::printf("%-12s %-18s %-11s %10s %7s %8s\n", "mesh", "map", "border", "L2 stretch", "flipped",
                "CPU s");
    bool good = true;
    for (const std::string& mesh : meshes) good = compare(mesh, repeat) && good;
    return good ? cli::Done : cli::Refused;
}

// gimshape NAME OUT: writes one of the analytic surfaces of shapes.h.
#include "gimg/mesh_io.h"
#include "shapes.h"

#include <CLI/App.hpp>
#include <functional>
#include <iostream>
#include <map>

namespace {

using gimg::Mesh;
using gimg::Vec3;
namespace shapes = gimg::shapes;

struct Options
{
    int resolution = 32;
    int genus = 2;
    int loops = 0;
};

using Maker = std::function<Mesh(const Options&)>;

const std::map<std::string, Maker> kShapes = {
    {"sphere", [](const Options& o) { return shapes::sphere(1, o.resolution); }},
    {"wavy-sphere", [](const Options& o) { return shapes::wavySphere(1, 0.3, 5, o.resolution); }},
    {"torus", [](const Options& o) { return shapes::torus(1, 0.4, 2 * o.resolution, o.resolution); }},
    {"trefoil", [](const Options& o) { return shapes::trefoil(0.4, 10 * o.resolution, o.resolution); }},
    {"cylinder", [](const Options& o) { return shapes::cylinder(1, 2, 3 * o.resolution, o.resolution); }},
    {"disk", [](const Options& o) { return shapes::disk(1, o.resolution); }},
    {"box", [](const Options& o) { return shapes::box(Vec3(3, 2, 1), o.resolution); }},
    {"plate", [](const Options& o) { return shapes::plate(o.loops > 0 ? o.loops - 1 : 0, o.resolution); }},
    {"genus", [](const Options& o) { return shapes::surfaceOfGenus(o.genus, o.loops, o.resolution); }},
};

} // namespace

int main(int argc, char** argv)
{
    std::string name, path;
    Options options;
    CLI::App app{"Writes a surface of known topology, area and volume.", "gimshape"};
    app.set_version_flag("--version", GIMG_VERSION);
    app.add_option("NAME", name, "Which surface")->required()->check(CLI::IsMember(kShapes));
    app.add_option("OUT", path, "The file to write: .ply, .obj, .off or .stl")->required();
    app.add_option("--resolution", options.resolution, "Segments along the surface's shortest feature")
        ->check(CLI::Range(3, 1000))
        ->capture_default_str();
    app.add_option("--genus", options.genus, "Of `genus`")->check(CLI::Range(0, 100))->capture_default_str();
    app.add_option("--loops", options.loops,
                   "Boundary loops of `plate` and `genus`; at most 4 (genus + 1) of `genus`")
        ->check(CLI::Range(0, 100))
        ->capture_default_str();
    try {
        app.parse(argc, argv);
        if (name == "genus" && options.loops > 4 * (options.genus + 1))
            throw CLI::ValidationError("--loops", "more than 4 (genus + 1)");
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    }

    const Mesh mesh = kShapes.at(name)(options);
    if (const gimg::Status written = gimg::writeMesh(mesh, path); !written) {
        std::cerr << "gimshape: " << written.error().message << '\n';
        return 1;
    }
    const gimg::Topology t = gimg::topology(mesh);
    std::cout << path << ": " << t.vertices << " vertices, " << t.faces << " faces, genus " << t.genus << ", "
              << t.boundaries << " loops\n";
}

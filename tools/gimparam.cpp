// gimparam: a mesh is cut open and mapped to the square; nothing is sampled or coded.
#include "cli.h"
#include "gimenc/status_line.h"

#include "gimg/mesh_io.h"
#include "gimg/stretch.h"
#include "gimg/unfold.h"
#include "gimg/unfolded_io.h"

#include <CLI/App.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>

namespace {

using namespace gimg;

struct Arguments
{
    std::string input, output, json;
    ReadOptions read;
    UnfoldOptions unfold;
    bool quiet = false;
};

// An option whose values are names.
template <class Value>
void addChoice(CLI::App& app, const char* name, std::map<std::string, Value> values, Value& value,
               const char* text)
{
    std::vector<std::string> names;
    for (const auto& entry : values) names.push_back(entry.first);
    app.add_option_function<std::string>(
           name, [values, &value](const std::string& key) { value = values.at(key); }, text)
        ->check(CLI::IsMember(names));
}

std::optional<int> parseArguments(int argc, char** argv, Arguments& a)
{
    CLI::App app{"Cuts a triangle mesh (OBJ, PLY, OFF, STL) open and maps it to the unit square, as gimenc "
                 "does before it samples, and writes the surface with its map and its cut.",
                 "gimparam"};
    app.footer("Exit codes: 0 done, 1 input refused, 2 usage, 3 target not reachable.");
    app.set_version_flag("--version", GIMG_VERSION);
    app.add_option("INPUT", a.input, "mesh to map")->required();
    app.add_option("OUTPUT", a.output,
                   "to write: .obj (texture coordinates, the cut as lines), or .ply (opened along the cut, "
                   "with s and t; each face's stretch as quality)")
        ->required();
    app.add_option("--grid", a.unfold.grid,
                   "samples a side that the layout is made for, 2^j + 1 (default: 257)");
    app.add_option("--lowest", a.unfold.lowest,
                   "samples a side of the lowest level of detail, 2^l + 1 (default: 33, or as needed)");
    addChoice<SquareLayout>(
        app, "--layout",
        {{"auto", SquareLayout::Auto}, {"cut", SquareLayout::Cut}, {"octahedral", SquareLayout::Octahedral}},
        a.unfold.layout, "cut, octahedral (a closed surface of genus 0 folds up from the four sides), auto");
    std::map<std::string, MapKind> maps;
    for (MapKind kind : kMapKinds) maps[mapName(kind)] = kind;
    addChoice<MapKind>(app, "--param", maps, a.unfold.param,
                       "stretch (even samples), or linear: mvc (mean values), tutte, harmonic");
    addChoice<Density>(app, "--density", {{"curvature", Density::Curvature}, {"even", Density::Even}},
                       a.unfold.density, "samples: closer where the surface bends (curvature), or even");
    app.add_option("--extrema", a.unfold.extrema,
                   "extend the cut to the first N tips, whether that helps or not (default: as many as help)")
        ->check(CLI::NonNegativeNumber);
    app.add_option("--component", "of several components take the largest")
        ->check(CLI::IsMember({"largest"}))
        ->each([&a](const std::string&) { a.read.largestComponent = true; });
    addChoice<Weld>(app, "--weld", {{"auto", Weld::Auto}, {"always", Weld::Always}, {"never", Weld::Never}},
                    a.read.weld,
                    "merge vertices at equal positions: auto (where that harms nothing), always, never");
    app.add_option("--json", a.json, "write a report to this file, or - for standard output");
    app.add_flag("--quiet", a.quiet, "print nothing but errors");
    return cli::parse(app, argc, argv);
}

cli::Exit exitFor(ErrorKind kind)
{
    if (kind == ErrorKind::TargetUnreachable) return cli::Unreachable;
    return kind == ErrorKind::BadArgument || kind == ErrorKind::FormatUnknown ? cli::Usage : cli::Refused;
}

// Of the opened surface, so that it stands for what OUTPUT holds.
nlohmann::ordered_json report(const Mesh& mesh, const Arguments& a, const Unfolded& unfolded)
{
    const Topology type = topology(mesh);
    const Mesh& disk = unfolded.square.disk.mesh;
    const std::vector<double> stretch = faceStretch(disk, unfolded.map.st);
    nlohmann::ordered_json json;
    json["vertices"] = type.vertices;
    json["faces"] = type.faces;
    json["genus"] = type.genus;
    json["boundaries"] = type.boundaries;
    json["grid"] = unfolded.square.grid;
    json["lowest"] = unfolded.square.lowest;
    json["layout"] = unfolded.layout == SquareLayout::Octahedral ? "octahedral" : "cut";
    json["param"] = mapName(a.unfold.param);
    json["stretch_efficiency"] = unfolded.map.efficiency;
    json["energy"] = quarticStretchEnergy(disk, unfolded.map.st) / std::pow(surfaceArea(disk), 3);
    json["stretch_max"] = *std::max_element(stretch.begin(), stretch.end());
    json["flipped"] = flippedTriangles(disk.faces, unfolded.map.st);
    json["cut"] = {{"nodes", unfolded.cut.nodeCount()},
                   {"paths", unfolded.cut.paths.size()},
                   {"extrema", unfolded.extrema},
                   {"length", cutLength(mesh, unfolded.cut)}};
    return json;
}

} // namespace

int main(int argc, char** argv)
{
    Arguments a;
    if (const std::optional<int> exit = parseArguments(argc, argv, a)) return *exit;
    const Result<MeshFile> file = readMesh(a.input, a.read);
    if (!file) {
        const bool several = file.error().kind == ErrorKind::SeveralComponents;
        return cli::fail("gimparam", cli::Refused,
                         file.error().message + (several ? "; --component largest takes the largest" : ""));
    }
    const gimenc::StatusLine progress(!a.quiet);
    const Result<Unfolded> unfolded =
        unfold(file->mesh, a.unfold, {}, [&](const char* stage, double fraction) {
            progress.show(std::string(stage) + " " + std::to_string(std::lround(100 * fraction)) + " %");
        });
    progress.wipe();
    if (!unfolded)
        return cli::fail("gimparam", exitFor(unfolded.error().kind),
                         a.input + ": " + unfolded.error().message);
    if (const Status status = writeUnfolded(unfolded->square, unfolded->map, a.output); !status)
        return cli::fail("gimparam", exitFor(status.error().kind), status.error().message);
    if (!a.quiet)
        for (const std::string& warning : warnings(file->report))
            std::cerr << "gimparam: " << warning << '\n';
    if (!a.json.empty() && !cli::writeJson(a.json, report(file->mesh, a, *unfolded)))
        return cli::fail("gimparam", cli::Refused, a.json + ": cannot be written");
    return cli::Done;
}

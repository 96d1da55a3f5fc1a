// A mesh is cut open and mapped to the square; nothing is sampled or coded.
#include "command.h"
#include "input.h"

#include "../gimenc/status_line.h"

#include "gimg/stretch.h"
#include "gimg/unfold.h"
#include "gimg/unfolded_io.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace gimg::gimparam {
namespace {

struct SquareOptions
{
    Input input;
    std::string output;
    UnfoldOptions unfold;
};

void addOptions(CLI::App& command, SquareOptions& o)
{
    addInput(command, o.input);
    command
        .add_option("OUTPUT", o.output,
                    "to write: .obj (texture coordinates, the cut as lines), or .ply (opened along the cut, "
                    "with s and t; each face's stretch as quality)")
        ->required();
    command.add_option("--grid", o.unfold.grid,
                       "samples a side that the layout is made for, 2^j + 1 (default: 257)");
    command.add_option("--lowest", o.unfold.lowest,
                       "samples a side of the lowest level of detail, 2^l + 1 (default: 33, or as needed)");
    addChoice<SquareLayout>(
        command, "--layout",
        {{"auto", SquareLayout::Auto}, {"cut", SquareLayout::Cut}, {"octahedral", SquareLayout::Octahedral}},
        o.unfold.layout, "cut, octahedral (a closed surface of genus 0 folds up from the four sides), auto");
    std::map<std::string, MapKind> maps;
    for (MapKind kind : kMapKinds) maps[mapName(kind)] = kind;
    maps[mapName(MapKind::Conformal)] = MapKind::Conformal;
    addChoice<MapKind>(
        command, "--param", maps, o.unfold.param,
        "stretch (even samples), or linear: mvc (mean values), tutte, harmonic; conformal for tori");
    addChoice<Density>(command, "--density", {{"curvature", Density::Curvature}, {"even", Density::Even}},
                       o.unfold.density, "samples: closer where the surface bends (curvature), or even");
    command
        .add_option(
            "--extrema", o.unfold.extrema,
            "extend the cut to the first N tips, whether that helps or not (default: as many as help)")
        ->check(CLI::NonNegativeNumber);
}

// Of the opened surface, so that it stands for what OUTPUT holds.
nlohmann::ordered_json report(const Mesh& mesh, const SquareOptions& o, const Unfolded& unfolded)
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
    json["param"] = mapName(o.unfold.param);
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

int mapToSquare(const SquareOptions& o)
{
    const Result<MeshFile> file = readInput(o.input);
    if (!file) return cli::fail("gimparam", cli::Refused, file.error().message);
    const gimenc::StatusLine progress(!o.input.quiet);
    const Result<Unfolded> unfolded =
        unfold(file->mesh, o.unfold, {}, [&](const char* stage, double fraction) {
            progress.show(std::string(stage) + " " + std::to_string(std::lround(100 * fraction)) + " %");
        });
    progress.wipe();
    if (!unfolded) return failWith(unfolded.error(), o.input.path);
    if (const Status status = writeUnfolded(unfolded->square, unfolded->map, o.output); !status)
        return failWith(status.error());
    return finish(o.input, *file,
                  o.input.json.empty() ? nlohmann::ordered_json() : report(file->mesh, o, *unfolded));
}

} // namespace

Command addSquare(CLI::App& app)
{
    const auto options = std::make_shared<SquareOptions>();
    CLI::App* sub =
        app.add_subcommand("square", "Cut the mesh open and map it to the unit square, as gimenc does before "
                                     "it samples (also without the word square)");
    addOptions(*sub, *options);
    return {sub, [options] { return mapToSquare(*options); }};
}

} // namespace gimg::gimparam

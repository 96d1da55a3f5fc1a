// A closed surface of genus 0 on the unit sphere.
#include "command.h"
#include "input.h"

#include "gimg/sphere_map.h"

#include <nlohmann/json.hpp>

#include <memory>

namespace gimg::gimparam {
namespace {

struct SphereOptions
{
    Input input;
    SphereMapOptions map;
    std::string output;
};

nlohmann::ordered_json report(const Mesh& mesh, const SphereMap& map)
{
    nlohmann::ordered_json json;
    json["vertices"] = mesh.vertexCount();
    json["faces"] = mesh.faceCount();
    json["flipped"] = flippedOnSphere(mesh.faces, map.position);
    json["mass_centre"] = map.massCentre.norm();
    json["angle_error"] = {{"median_degrees", map.quality.medianAngleError},
                           {"degrees_95", map.quality.angleError95},
                           {"quasi_conformal_ratio", map.quality.quasiConformalRatio}};
    json["area_distortion"] = map.quality.areaDistortion;
    json["untangled"] = map.untangled;
    json["inflated"] = map.inflated;
    return json;
}

int mapToSphere(const SphereOptions& o)
{
    const Result<MeshFile> file = readInput(o.input);
    if (!file) return cli::fail("gimparam", cli::Refused, file.error().message);
    const Result<SphereMap> map = sphereMap(file->mesh, o.map);
    if (!map) return failWith(map.error(), o.input.path);
    const Mesh sphere{map->position, file->mesh.faces};
    if (const Status status = writeMesh(sphere, o.output); !status) return failWith(status.error());
    return finish(o.input, *file, report(file->mesh, *map));
}

} // namespace

Command addSphere(CLI::App& app)
{
    const auto options = std::make_shared<SphereOptions>();
    CLI::App* sub =
        app.add_subcommand("sphere", "Conformal map of a closed surface of genus 0 to the unit sphere");
    addInput(*sub, options->input);
    sub->add_option("OUTPUT", options->output, "to write: the mesh on the sphere (.obj, .ply, .off, .stl)")
        ->required();
    return {sub, [options] { return mapToSphere(*options); }};
}

} // namespace gimg::gimparam

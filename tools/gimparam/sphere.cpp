// A closed surface of genus 0 on the unit sphere.
#include "command.h"
#include "input.h"
#include "mesh_length.h"

#include "gimg/sphere_map.h"
#include "gimg/topology_noise.h"

#include <nlohmann/json.hpp>

#include <memory>
#include <optional>

namespace gimg::gimparam {
namespace {

struct SphereOptions
{
    Input input;
    SphereMapOptions map;
    std::optional<cli::MeshLength> closeHoles;
    std::string output;
};

nlohmann::ordered_json report(const Mesh& mesh, size_t holes, const SphereMap& map)
{
    nlohmann::ordered_json json;
    json["vertices"] = mesh.vertexCount();
    json["faces"] = mesh.faceCount();
    json["holes_closed"] = holes;
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
    Mesh mesh = file->mesh;
    size_t holes = 0;
    if (o.closeHoles) {
        Result<HoleClosing> closing = closeHoles(mesh, o.closeHoles->of(boundingBoxDiagonal(mesh)));
        if (!closing) return failWith(closing.error(), o.input.path);
        mesh = std::move(closing->mesh);
        holes = closing->holes.size();
    }
    const Result<SphereMap> map = sphereMap(mesh, o.map);
    if (!map) return failWith(map.error(), o.input.path);
    const nlohmann::ordered_json json = report(mesh, holes, *map);
    mesh.positions = map->position;
    if (const Status status = writeMesh(mesh, o.output); !status) return failWith(status.error());
    return finish(o.input, *file, json);
}

} // namespace

Command addSphere(CLI::App& app)
{
    const auto options = std::make_shared<SphereOptions>();
    CLI::App* sub =
        app.add_subcommand("sphere", "Conformal map of a closed surface of genus 0 to the unit sphere");
    addInput(*sub, options->input);
    cli::addMeshLength(*sub, "--close-holes", options->closeHoles,
                       "first close boundary loops up to this long, in the mesh's unit or % of the bounding "
                       "box's diagonal; their triangles are on the sphere, too");
    sub->add_option("OUTPUT", options->output, "to write: the mesh on the sphere (.obj, .ply, .off, .stl)")
        ->required();
    return {sub, [options] { return mapToSphere(*options); }};
}

} // namespace gimg::gimparam

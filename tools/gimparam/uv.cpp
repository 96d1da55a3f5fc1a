// Global conformal parameterization: a holomorphic form integrated over the surface cut open.
#include "command.h"
#include "form_choice.h"
#include "input.h"
#include "picture.h"

#include "gimg/handle_separation.h"

#include <nlohmann/json.hpp>

#include <iostream>
#include <memory>

namespace gimg::gimparam {
namespace {

constexpr int kMostSubdivisions = 3; // until handles come apart

struct UvOptions
{
    Input input;
    FormChoice form;
    PictureOptions picture;
    std::string output;
    std::vector<int> punctures; // vertices, or
    int tips = 0;               // how many are to be found
    int subdivide = 0;          // times, before all else
    bool handles = false, modular = false;
};

/// What the command works on and finds, stage by stage.
struct Work
{
    Mesh mesh; // punctured, and subdivided where handles need it
    std::vector<int> punctures;
    SurfaceForms forms;
    ChosenForm chosen;
    BoundedBranchPoints branch; // `inside` of a closed surface are all
    PlaneMap plane;
    int subdivisions = 0;
    std::optional<HandleSeparation> separation;
    std::optional<CornerMap> modular;
};

Status punctureMesh(const UvOptions& o, Work& work)
{
    work.punctures = o.punctures;
    if (o.tips > 0) {
        const Result<std::vector<int>> tips = puncturesOf(work.mesh, o.tips, o.input.quiet);
        if (!tips) return tips.error();
        work.punctures = *tips;
    }
    if (work.punctures.empty()) return Done{};
    Result<PuncturedSurface> punctured = puncture(work.mesh, work.punctures);
    if (!punctured) return punctured.error();
    work.mesh = std::move(punctured->mesh);
    return Done{};
}

Status findBranchPoints(Work& work)
{
    if (work.forms.hasBoundary()) {
        Result<BoundedBranchPoints> branch = branchPoints(*work.forms.cover, work.chosen.onCover);
        if (!branch) return branch.error();
        work.branch = std::move(*branch);
        return Done{};
    }
    Result<BranchPoints> branch = branchPoints(work.mesh, work.chosen.form);
    if (!branch) return branch.error();
    work.branch.total = branch->total;
    work.branch.inside = std::move(*branch);
    return Done{};
}

// Subdivides the mesh as often as handles need it to come apart.
Status separate(const UvOptions& o, Work& work)
{
    if (!o.handles && !o.modular) return Done{};
    for (;; ++work.subdivisions) {
        Result<HandleSeparation> separation = separateHandles(work.mesh, work.chosen.form);
        if (separation) {
            work.separation = std::move(*separation);
            break;
        }
        if (separation.error().kind != ErrorKind::TargetUnreachable || work.subdivisions == kMostSubdivisions)
            return separation.error();
        SubdividedForm fine = subdivided(work.mesh, work.chosen.form);
        work.mesh = std::move(fine.mesh);
        work.chosen.form = std::move(fine.form);
    }
    if (!o.modular) return Done{};
    Result<CornerMap> modular = modularCoordinates(work.mesh, work.chosen.form, *work.separation);
    if (!modular) return modular.error();
    work.modular = std::move(*modular);
    return Done{};
}

Status parameterize(const UvOptions& o, Work& work)
{
    for (int k = 0; k < o.subdivide; ++k)
        work.mesh = subdivided(work.mesh, ComplexOneForm::Zero(3 * work.mesh.faceCount())).mesh;
    if (const Status status = punctureMesh(o, work); !status) return status;
    Result<SurfaceForms> forms = formsOf(work.mesh, o.input.quiet);
    if (!forms) return forms.error();
    work.forms = std::move(*forms);
    Result<ChosenForm> chosen = chosenForm(work.mesh, work.forms, o.form);
    if (!chosen) return chosen.error();
    work.chosen = std::move(*chosen);
    if (const Status status = findBranchPoints(work); !status) return status;
    if (const Status status = separate(o, work); !status) return status;
    Result<PlaneMap> plane = integrateOverDisk(work.mesh, work.chosen.form);
    if (!plane) return plane.error();
    work.plane = std::move(*plane);
    return Done{};
}

std::vector<int> branchVertices(const Work& work)
{
    // Of the covering, mirrored ones included: the first copy has the surface's numbers, others are left out.
    std::vector<int> vertices;
    for (const BranchPoints* points : {&work.branch.inside, &work.branch.onBoundary})
        for (const BranchPoint& point : points->points) {
            int v = point.vertex;
            if (work.forms.hasBoundary()) v = std::min(v, work.forms.cover->mirror[v]);
            if (v < work.mesh.vertexCount()) vertices.push_back(v);
        }
    return vertices;
}

nlohmann::ordered_json toJson(const BranchPoints& points, bool boundary)
{
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const BranchPoint& point : points.points)
        list.push_back({{"position", gimparam::toJson(point.position)},
                        {"multiplicity", point.multiplicity},
                        {"on_boundary", boundary}});
    return list;
}

nlohmann::ordered_json toJson(const Handle& handle)
{
    nlohmann::ordered_json json;
    json["period_a"] = gimparam::toJson(handle.periodA);
    json["period_b"] = gimparam::toJson(handle.periodB);
    json["parallelogram_area"] = handle.parallelogramArea();
    json["area"] = handle.area;
    json["separators"] = handle.boundary.size();
    return json;
}

nlohmann::ordered_json report(const Work& work)
{
    const Topology type = topology(work.mesh);
    const AngleErrors angles = angleErrors(work.mesh, work.chosen.form, branchVertices(work));
    nlohmann::ordered_json json;
    json["vertices"] = type.vertices;
    json["faces"] = type.faces;
    json["genus"] = type.genus;
    json["boundaries"] = type.boundaries;
    if (!work.punctures.empty()) json["punctures"] = work.punctures;
    if (work.forms.hasBoundary()) json["covering_genus"] = work.forms.structure.genus;
    json["coefficients"] = gimparam::toJson(work.chosen.coefficients);
    json["most_even"] = work.chosen.even;
    json["unevenness"] = unevenness(work.mesh, work.chosen.form);
    json["angle_error"] = {{"median_degrees", angles.medianDegrees},
                           {"degrees_95", angles.degrees95},
                           {"of_faces", angles.faces},
                           {"flipped", angles.flipped}};
    json["branch_points"] = work.branch.total;
    json["branch_point_list"] = toJson(work.branch.inside, false);
    for (const auto& point : toJson(work.branch.onBoundary, true)) json["branch_point_list"].push_back(point);
    json["negative_places"] = work.branch.inside.negative + work.branch.onBoundary.negative;
    nlohmann::ordered_json jumps = nlohmann::ordered_json::array();
    for (size_t p = 0; p < work.plane.jumps.size(); ++p)
        if (!work.plane.cut.paths[p].boundary) jumps.push_back(gimparam::toJson(work.plane.jumps[p]));
    json["jumps"] = jumps;
    json["jump_error"] = work.plane.jumpError;
    if (work.separation) {
        json["subdivisions"] = work.subdivisions;
        json["handles"] = nlohmann::ordered_json::array();
        for (const Handle& handle : work.separation->handles) json["handles"].push_back(toJson(handle));
    }
    return json;
}

int writeUv(const UvOptions& o)
{
    const Result<MeshFile> file = readInput(o.input);
    if (!file) return cli::fail("gimparam", cli::Refused, file.error().message);
    Work work;
    work.mesh = file->mesh;
    if (const Status status = parameterize(o, work); !status) return failWith(status.error(), o.input.path);
    const CornerMap& written = work.modular ? *work.modular : work.plane.map;
    if (const Status status =
            writeCornerMap(work.mesh, written, o.output, conformalFactor(work.mesh, work.chosen.form));
        !status)
        return failWith(status.error());
    if (o.picture.wanted()) {
        std::vector<Vec3> marks;
        for (const BranchPoints* points : {&work.branch.inside, &work.branch.onBoundary})
            for (const BranchPoint& point : points->points) marks.push_back(point.position);
        const double side = fieldSide(work.plane.map, o.picture.fields);
        const std::vector<int> parts = work.separation ? work.separation->handleOf : std::vector<int>();
        const Status status =
            work.modular ? writePicture(work.mesh, seamlessFields(*work.separation, *work.modular, side), 1,
                                        parts, marks, o.picture)
                         : writePicture(work.mesh, work.plane.map, side, parts, marks, o.picture);
        if (!status) return failWith(status.error());
    }
    return finish(o.input, *file, o.input.json.empty() ? nlohmann::ordered_json() : report(work));
}

} // namespace

Command addUv(CLI::App& app)
{
    const auto o = std::make_shared<UvOptions>();
    CLI::App* sub = app.add_subcommand(
        "uv",
        "Conformal map of a surface to the plane, by integrating a holomorphic 1-form; handles and holes "
        "are what it needs, at least one handle or two holes");
    addInput(*sub, o->input);
    sub->add_option("OUTPUT", o->output,
                    "to write: .obj (texture coordinates), .ply (texture coordinates of faces; each face's "
                    "conformal factor as quality)")
        ->required();
    addFormChoice(*sub, o->form);
    sub->add_option("--puncture", o->punctures,
                    "leave out these vertices V1,V2,..., counted from 0 as in the mesh, with the faces "
                    "around them: holes at "
                    "the tips of limbs spread the limbs out")
        ->delimiter(',')
        ->allow_extra_args(false);
    sub->add_option("--puncture-tips", o->tips,
                    "leave out N vertices, one by one at the far end of what is shrunken most")
        ->excludes("--puncture")
        ->check(CLI::PositiveNumber);
    sub->add_option(
           "--subdivide", o->subdivide,
           "split every triangle into four, N times, before all else: the same surface, its map finer")
        ->check(CLI::Range(0, 6));
    sub->add_flag("--handles", o->handles,
                  "separate the handles of a closed surface, subdividing the mesh where that needs it");
    sub->add_flag(
        "--modular", o->modular,
        "write coordinates in the parallelogram of each handle, which repeat with the unit square; the "
        "picture then has seams at the separators only");
    addPicture(*sub, o->picture);
    return {sub, [o] { return writeUv(*o); }};
}

} // namespace gimg::gimparam

// A canonical homology basis of a closed surface, as loops along its edges.
#include "command.h"
#include "input.h"

#include "gimg/corner_map.h"
#include "gimg/homology.h"

#include <nlohmann/json.hpp>

#include <memory>

namespace gimg::gimparam {
namespace {

struct HomologyOptions
{
    Input input;
    std::string output;
};

nlohmann::ordered_json report(const Mesh& mesh, const std::vector<Loop>& loops)
{
    const PolyhedralSurface surface = polyhedralSurface(mesh);
    const Eigen::MatrixXi crossings = intersectionMatrix(Halfedges(mesh.faces, mesh.vertexCount()), loops);
    const size_t genus = loops.size() / 2;
    nlohmann::ordered_json json;
    json["vertices"] = mesh.vertexCount();
    json["faces"] = mesh.faceCount();
    json["genus"] = genus;
    json["loops"] = nlohmann::ordered_json::array();
    for (size_t i = 0; i < loops.size(); ++i)
        json["loops"].push_back({{"name", (i < genus ? "a" : "b") + std::to_string(i % genus + 1)},
                                 {"edges", loops[i].halfedges.size()},
                                 {"length", loopLength(surface, loops[i])}});
    json["intersections"] = nlohmann::ordered_json::array();
    for (Eigen::Index row = 0; row < crossings.rows(); ++row) {
        nlohmann::ordered_json numbers = nlohmann::ordered_json::array();
        for (Eigen::Index column = 0; column < crossings.cols(); ++column)
            numbers.push_back(crossings(row, column));
        json["intersections"].push_back(numbers);
    }
    return json;
}

int writeBasis(const HomologyOptions& o)
{
    const Result<MeshFile> file = readInput(o.input);
    if (!file) return cli::fail("gimparam", cli::Refused, file.error().message);
    const Mesh& mesh = file->mesh;
    const Result<CanonicalBasis> basis = canonicalBasis(mesh);
    if (!basis) return failWith(basis.error(), o.input.path);
    std::vector<Loop> loops = basis->a;
    loops.insert(loops.end(), basis->b.begin(), basis->b.end());

    const Halfedges he(mesh.faces, mesh.vertexCount());
    std::vector<std::vector<int>> lines;
    for (const Loop& loop : loops) {
        lines.emplace_back();
        for (int h : loop.halfedges) lines.back().push_back(he.tail(h));
        lines.back().push_back(lines.back().front());
    }
    if (const Status status = writeLines(mesh, lines, o.output); !status) return failWith(status.error());
    return finish(o.input, *file, report(mesh, loops));
}

} // namespace

Command addHomology(CLI::App& app)
{
    const auto options = std::make_shared<HomologyOptions>();
    CLI::App* sub = app.add_subcommand(
        "homology",
        "Loops a1 .. ag, b1 .. bg that cut a closed surface open: aj and bj cross once, no others");
    addInput(*sub, options->input);
    sub->add_option("OUTPUT", options->output, "to write: .obj (loops as lines l), .ply (as edges)")
        ->required();
    return {sub, [options] { return writeBasis(*options); }};
}

} // namespace gimg::gimparam

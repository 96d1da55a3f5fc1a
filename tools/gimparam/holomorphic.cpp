// The holomorphic 1-forms of a surface, as numbers on its edges.
#include "command.h"
#include "form_choice.h"
#include "input.h"

#include "gimg/corner_map.h"

#include <nlohmann/json.hpp>

#include <memory>

namespace gimg::gimparam {
namespace {

struct HolomorphicOptions
{
    Input input;
    FormChoice form;
    std::string output;
};

nlohmann::ordered_json report(const Mesh& mesh, const SurfaceForms& forms)
{
    const Topology type = topology(mesh);
    nlohmann::ordered_json json;
    json["vertices"] = type.vertices;
    json["faces"] = type.faces;
    json["genus"] = type.genus;
    json["boundaries"] = type.boundaries;
    json["forms"] = forms.basis.size();
    if (forms.hasBoundary()) json["covering_genus"] = forms.structure.genus;
    json["asymmetry"] = forms.structure.asymmetry;
    json["star_residual"] = forms.structure.starResidual;
    return json;
}

int writeHolomorphic(const HolomorphicOptions& o)
{
    const Result<MeshFile> file = readInput(o.input);
    if (!file) return cli::fail("gimparam", cli::Refused, file.error().message);
    const Result<SurfaceForms> forms = formsOf(file->mesh, o.input.quiet);
    if (!forms) return failWith(forms.error(), o.input.path);
    std::vector<ComplexOneForm> written = forms->basis;
    if (!o.form.coefficients.empty()) {
        const Result<ChosenForm> chosen = chosenForm(file->mesh, *forms, o.form);
        if (!chosen) return failWith(chosen.error());
        written = {chosen->form};
    }
    if (const Status status = writeForms(file->mesh, written, o.output); !status)
        return failWith(status.error());
    return finish(o.input, *file, report(file->mesh, *forms));
}

} // namespace

Command addHolomorphic(CLI::App& app)
{
    const auto options = std::make_shared<HolomorphicOptions>();
    CLI::App* sub = app.add_subcommand(
        "holomorphic",
        "Basis of holomorphic 1-forms: complex numbers on the edges. A surface with boundary has "
        "those that are real along it");
    addInput(*sub, options->input);
    addFormChoice(*sub, options->form, "all forms of a basis, one by one");
    sub->add_option("OUTPUT", options->output, "to write: .ply (each form a list of numbers of the faces)")
        ->required();
    return {sub, [options] { return writeHolomorphic(*options); }};
}

} // namespace gimg::gimparam

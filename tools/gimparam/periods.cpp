// The period matrix of a closed surface, and the numbers that go with it.
#include "command.h"
#include "form_choice.h"
#include "input.h"

#include "gimg/global_parameterization.h"
#include "gimg/periods.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <memory>

namespace gimg::gimparam {
namespace {

struct PeriodsOptions
{
    Input input;
    FormChoice form;
};

struct Periods
{
    std::optional<std::complex<double>> tau; // of a torus, as is `shape`
    std::optional<ShapeFactors> shape;
    std::optional<ReducedPeriods> reduced; // of a surface of genus > 1
    BranchPoints branch;
};

Result<Periods> measure(const Mesh& mesh, const SurfaceForms& forms, const FormChoice& choice)
{
    const Eigen::MatrixXcd& matrix = forms.structure.periodMatrix;
    Periods periods;
    if (forms.structure.genus == 1) {
        const Result<std::complex<double>> tau = reducedModulus(matrix(0, 0));
        if (!tau) return tau.error();
        const Result<ShapeFactors> shape = shapeFactors(*tau);
        if (!shape) return shape.error();
        periods.tau = *tau;
        periods.shape = *shape;
    } else {
        Result<ReducedPeriods> reduced = siegelReduced(matrix);
        if (!reduced) return reduced.error();
        periods.reduced = std::move(*reduced);
    }
    const Result<ChosenForm> form = chosenForm(mesh, forms, choice);
    if (!form) return form.error();
    Result<BranchPoints> branch = branchPoints(mesh, form->form);
    if (!branch) return branch.error();
    periods.branch = std::move(*branch);
    return periods;
}

int multiplicity(const BranchPoints& branch)
{
    int sum = 0;
    for (const BranchPoint& point : branch.points) sum += point.multiplicity;
    return sum;
}

nlohmann::ordered_json report(const Mesh& mesh, const ConformalStructure& structure, const Periods& periods)
{
    nlohmann::ordered_json json;
    json["vertices"] = mesh.vertexCount();
    json["faces"] = mesh.faceCount();
    json["genus"] = structure.genus;
    json["period_matrix"] = toJson(structure.periodMatrix);
    if (periods.tau) json["tau"] = toJson(*periods.tau);
    if (periods.shape)
        json["shape_factors"] = {{"angle_degrees", periods.shape->angleDegrees},
                                 {"length_ratio", periods.shape->lengthRatio}};
    if (periods.reduced) json["reduced_period_matrix"] = toJson(periods.reduced->periodMatrix);
    json["asymmetry"] = structure.asymmetry;
    json["star_residual"] = structure.starResidual;
    json["branch_points"] = multiplicity(periods.branch);
    json["branch_point_list"] = nlohmann::ordered_json::array();
    for (const BranchPoint& point : periods.branch.points)
        json["branch_point_list"].push_back({{"vertex", point.vertex},
                                             {"position", toJson(point.position)},
                                             {"multiplicity", point.multiplicity}});
    return json;
}

void print(const ConformalStructure& structure, const Periods& periods)
{
    std::printf("genus            %d\n", structure.genus);
    for (Eigen::Index row = 0; row < structure.periodMatrix.rows(); ++row) {
        std::printf("%s", row == 0 ? "period matrix   " : "                ");
        for (Eigen::Index column = 0; column < structure.periodMatrix.cols(); ++column) {
            const std::complex<double> z = structure.periodMatrix(row, column);
            std::printf(" %.6g%+.6gi", z.real(), z.imag());
        }
        std::printf("\n");
    }
    if (periods.tau) std::printf("tau              %.6g%+.6gi\n", periods.tau->real(), periods.tau->imag());
    if (periods.shape)
        std::printf("shape            %.4f degrees, sides %.5g : 1\n", periods.shape->angleDegrees,
                    periods.shape->lengthRatio);
    std::printf("asymmetry        %.3g\n", structure.asymmetry);
    std::printf("residual of *    %.3g\n", structure.starResidual);
    std::printf("branch points    %d\n", multiplicity(periods.branch));
}

int computePeriods(const PeriodsOptions& o)
{
    const Result<MeshFile> file = readInput(o.input);
    if (!file) return cli::fail("gimparam", cli::Refused, file.error().message);
    if (topology(file->mesh).boundaries > 0)
        return cli::fail("gimparam", cli::Refused,
                         o.input.path + ": periods are those of a closed surface, this one has a boundary");
    const Result<SurfaceForms> forms = formsOf(file->mesh, o.input.quiet);
    if (!forms) return failWith(forms.error(), o.input.path);
    const Result<Periods> periods = measure(file->mesh, *forms, o.form);
    if (!periods) return failWith(periods.error(), o.input.path);
    if (!o.input.quiet && o.input.json != "-") print(forms->structure, *periods);
    return finish(o.input, *file, report(file->mesh, forms->structure, *periods));
}

} // namespace

Command addPeriods(CLI::App& app)
{
    const auto options = std::make_shared<PeriodsOptions>();
    CLI::App* sub = app.add_subcommand(
        "periods", "Period matrix of a closed surface, its shape factors and branch points");
    addInput(*sub, options->input);
    addFormChoice(*sub, options->form);
    return {sub, [options] { return computePeriods(*options); }};
}

} // namespace gimg::gimparam

#include "gimg/global_parameterization.h"

#include <string>

namespace gimg {
namespace {

constexpr double kIndependent = 1e-6; // of a form's energy must be left beside those chosen before

// Real inner products of forms, as measured on the triangles: of Re a and Re b, which for holomorphic forms
// is half of the whole.
Eigen::MatrixXd realGram(const PolyhedralSurface& surface, const std::vector<ComplexOneForm>& forms)
{
    const Eigen::Index n = static_cast<Eigen::Index>(forms.size());
    std::vector<OneForm> parts;
    for (const ComplexOneForm& form : forms) parts.push_back(form.real());
    Eigen::MatrixXd gram(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j <= i; ++j)
            gram(i, j) = gram(j, i) =
                starWedge(surface, parts[static_cast<size_t>(i)], parts[static_cast<size_t>(j)]);
    return gram;
}

// Picks independent forms, always the one that has the largest part beside those chosen before. Its share of
// `norms` counts: what is left of a form with almost no symmetric part is rounding.
std::vector<size_t> independent(Eigen::MatrixXd gram, const Eigen::VectorXd& norms, size_t count)
{
    std::vector<size_t> chosen;
    while (chosen.size() < count) {
        Eigen::Index best = 0;
        gram.diagonal().cwiseQuotient(norms).maxCoeff(&best);
        if (!(gram(best, best) > kIndependent * norms[best])) break;
        chosen.push_back(static_cast<size_t>(best));
        const Eigen::VectorXd column = gram.col(best);
        gram -= column * column.transpose() / column[best];
    }
    return chosen;
}

Result<SurfaceForms> formsOfBounded(const Mesh& mesh, const Topology& type, const ConformalOptions& options)
{
    const int genus = 2 * type.genus + type.boundaries - 1;
    if (genus == 0) return Error{ErrorKind::WrongGenus, "a disk has no holomorphic 1-forms"};
    Result<DoubleCover> cover = doubleCover(mesh);
    if (!cover) return cover.error();
    Result<ConformalStructure> structure = conformalStructure(cover->mesh, options);
    if (!structure) return structure.error();

    const PolyhedralSurface surface = polyhedralSurface(cover->mesh);
    std::vector<ComplexOneForm> candidates;
    Eigen::VectorXd norms(2 * genus);
    const std::complex<double> i(0, 1);
    for (const ComplexOneForm& form : structure->holomorphic) {
        const double energy = starWedge(surface, form.real(), form.real());
        norms.segment<2>(static_cast<Eigen::Index>(candidates.size())).setConstant(energy);
        candidates.push_back(symmetricPart(*cover, form));
        candidates.push_back(symmetricPart(*cover, i * form));
    }
    const std::vector<size_t> chosen =
        independent(realGram(surface, candidates), norms, static_cast<size_t>(genus));
    if (chosen.size() != static_cast<size_t>(genus))
        return Error{ErrorKind::SolverFailure, "found " + std::to_string(chosen.size()) +
                                                   " symmetric forms of " + std::to_string(genus)};
    SurfaceForms forms;
    for (size_t k : chosen) {
        forms.basis.push_back(restrictToSurface(*cover, candidates[k]));
        forms.coverBasis.push_back(std::move(candidates[k]));
    }
    forms.structure = std::move(*structure);
    forms.cover = std::move(*cover);
    return forms;
}

} // namespace

Result<SurfaceForms> surfaceForms(const Mesh& mesh, const ConformalOptions& options)
{
    const Topology type = topology(mesh);
    if (type.boundaries > 0) return formsOfBounded(mesh, type, options);
    Result<ConformalStructure> structure = conformalStructure(mesh, options);
    if (!structure) return structure.error();
    SurfaceForms forms;
    forms.basis = structure->holomorphic;
    forms.structure = std::move(*structure);
    return forms;
}

ComplexOneForm combination(std::span<const ComplexOneForm> basis, const Eigen::VectorXcd& c)
{
    ComplexOneForm form = ComplexOneForm::Zero(basis.empty() ? 0 : basis[0].size());
    for (size_t i = 0; i < basis.size(); ++i) form += c[static_cast<Eigen::Index>(i)] * basis[i];
    return form;
}

} // namespace gimg

#pragma once

#include "gimg/global_parameterization.h"

#include <nlohmann/json_fwd.hpp>

#include <complex>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace gimg::gimparam {

/// Which combination of a surface's holomorphic forms is meant.
struct FormChoice
{
    std::vector<std::complex<double>> coefficients; ///< none: the most even combination
};

/// --form c1,c2,...  @param ifNone  what is taken without it
void addFormChoice(CLI::App& command, FormChoice& choice,
                   const std::string& ifNone = "those that spread it most evenly");

/// Reads a complex number: 2, -0.5, i, 1+2i, 1e-3-0.5i. Nothing if it is anything else.
std::optional<std::complex<double>> parseComplex(const std::string& text);

/// surfaceForms, with a line on the terminal that says how far it is, unless told to be quiet.
Result<SurfaceForms> formsOf(const Mesh& mesh, bool quiet);

/// The same for findPunctures.
Result<std::vector<int>> puncturesOf(const Mesh& mesh, int count, bool quiet);

/// A combination of a surface's forms, on the surface and, if it has a boundary, on its covering.
struct ChosenForm
{
    Eigen::VectorXcd coefficients;
    ComplexOneForm form, onCover;
    bool even = false; ///< the most even combination
};

/// Errors: BadArgument where the numbers do not fit the surface's forms.
Result<ChosenForm> chosenForm(const Mesh& mesh, const SurfaceForms& forms, const FormChoice& choice);

nlohmann::ordered_json toJson(const std::complex<double>& z);  ///< [re, im]
nlohmann::ordered_json toJson(const Eigen::VectorXcd& vector); ///< [[re, im], ...]
nlohmann::ordered_json toJson(const Eigen::MatrixXcd& matrix); ///< rows
nlohmann::ordered_json toJson(const Vec3& point);

} // namespace gimg::gimparam

#include "form_choice.h"

#include "../gimenc/status_line.h"

#include <CLI/App.hpp>
#include <nlohmann/json.hpp>

#include <charconv>
#include <cmath>

namespace gimg::gimparam {
namespace {

// Reads a number, or only its sign where `unit` follows; moves `at` past it.
std::optional<double> readNumber(const char*& at, const char* end)
{
    const char* begin = at;
    double sign = 1;
    if (begin != end && (*begin == '+' || *begin == '-')) sign = *begin++ == '-' ? -1 : 1;
    if (begin != end && *begin == 'i') {
        at = begin;
        return sign;
    }
    if (begin == end || *begin == '+' || *begin == '-') return std::nullopt;
    double value = 0;
    const auto [rest, failure] = std::from_chars(begin, end, value);
    if (failure != std::errc()) return std::nullopt;
    at = rest;
    return sign * value;
}

ConformalOptions withProgress(const gimenc::StatusLine& line, const std::string& stage)
{
    ConformalOptions options;
    options.progress = [&line, stage](double fraction) {
        line.show(stage + " " + std::to_string(std::lround(100 * fraction)) + " %");
    };
    return options;
}

} // namespace

std::optional<std::complex<double>> parseComplex(const std::string& text)
{
    const char* at = text.data();
    const char* const end = at + text.size();
    const std::optional<double> first = readNumber(at, end);
    if (!first || !std::isfinite(*first)) return std::nullopt;
    if (at == end) return *first;
    if (*at == 'i') return ++at == end ? std::optional(std::complex<double>(0, *first)) : std::nullopt;
    if (*at != '+' && *at != '-') return std::nullopt;
    const std::optional<double> second = readNumber(at, end);
    if (!second || !std::isfinite(*second) || at == end || *at != 'i' || ++at != end) return std::nullopt;
    return std::complex<double>(*first, *second);
}

void addFormChoice(CLI::App& command, FormChoice& choice, const std::string& ifNone)
{
    command
        .add_option_function<std::vector<std::string>>(
            "--form",
            [&choice](const std::vector<std::string>& words) {
                choice.coefficients.clear();
                for (const std::string& word : words) {
                    const std::optional<std::complex<double>> c = parseComplex(word);
                    if (!c) throw CLI::ValidationError("--form", word + " is no complex number like 1+2i");
                    choice.coefficients.push_back(*c);
                }
            },
            "coefficients of the surface's forms, as 1,0.5-2i,i (default: " + ifNone + ")")
        ->delimiter(',')
        ->allow_extra_args(false);
}

Result<SurfaceForms> formsOf(const Mesh& mesh, bool quiet)
{
    const gimenc::StatusLine progress(!quiet);
    return surfaceForms(mesh, withProgress(progress, "forms"));
}

Result<std::vector<int>> puncturesOf(const Mesh& mesh, int count, bool quiet)
{
    const gimenc::StatusLine progress(!quiet);
    return findPunctures(mesh, count, withProgress(progress, "looking for punctures: forms"));
}

Result<ChosenForm> chosenForm(const Mesh& mesh, const SurfaceForms& forms, const FormChoice& choice)
{
    const size_t count = forms.basis.size();
    ChosenForm chosen;
    if (choice.coefficients.empty()) {
        const Result<UniformForm> even = mostUniformForm(mesh, forms.basis, forms.hasBoundary());
        if (!even) return even.error();
        chosen.coefficients = even->coefficients;
        chosen.even = true;
    } else {
        if (choice.coefficients.size() != count)
            return Error{ErrorKind::BadArgument, "the surface has " + std::to_string(count) +
                                                     " forms, --form gives " +
                                                     std::to_string(choice.coefficients.size())};
        chosen.coefficients = Eigen::VectorXcd(static_cast<Eigen::Index>(count));
        for (size_t i = 0; i < count; ++i)
            chosen.coefficients[static_cast<Eigen::Index>(i)] = choice.coefficients[i];
        if (chosen.coefficients.norm() == 0)
            return Error{ErrorKind::BadArgument, "--form: one coefficient at least must not be 0"};
        if (forms.hasBoundary() && chosen.coefficients.imag().norm() > 0)
            return Error{ErrorKind::BadArgument, "--form: of a surface with boundary, coefficients are real"};
    }
    chosen.form = combination(forms.basis, chosen.coefficients);
    if (forms.hasBoundary()) chosen.onCover = combination(forms.coverBasis, chosen.coefficients);
    return chosen;
}

nlohmann::ordered_json toJson(const std::complex<double>& z) { return {z.real(), z.imag()}; }

nlohmann::ordered_json toJson(const Vec3& point) { return {point[0], point[1], point[2]}; }

nlohmann::ordered_json toJson(const Eigen::VectorXcd& vector)
{
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const std::complex<double>& z : vector) list.push_back(toJson(z));
    return list;
}

nlohmann::ordered_json toJson(const Eigen::MatrixXcd& matrix)
{
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (Eigen::Index row = 0; row < matrix.rows(); ++row)
        rows.push_back(toJson(Eigen::VectorXcd(matrix.row(row).transpose())));
    return rows;
}

} // namespace gimg::gimparam

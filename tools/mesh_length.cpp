#include "mesh_length.h"

#include <CLI/App.hpp>

#include <charconv>
#include <cmath>

namespace gimg::cli {

std::string MeshLength::text() const
{
    char digits[64];
    return std::string(digits, std::to_chars(digits, digits + sizeof digits, number).ptr) +
           (percent ? "%" : "");
}

std::optional<MeshLength> MeshLength::parse(const std::string& text)
{
    MeshLength length;
    length.percent = text.ends_with('%');
    const char* const last = text.data() + text.size() - (length.percent ? 1 : 0);
    const auto [end, error] = std::from_chars(text.data(), last, length.number);
    if (error != std::errc() || end != last || !(length.number > 0) || !std::isfinite(length.number))
        return std::nullopt;
    return length;
}

void addMeshLength(CLI::App& app, const char* name, std::optional<MeshLength>& length, const char* text)
{
    app.add_option_function<std::string>(
           name,
           [&length, name](const std::string& value) {
               length = MeshLength::parse(value);
               if (!length) throw CLI::ValidationError(name, value + " is not a positive length or N%");
           },
           text)
        ->type_name("LENGTH|N%");
}

} // namespace gimg::cli

#pragma once

#include <functional>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace gimg::cli {

/// A length on the command line: in the mesh's unit, or in percent of the diagonal of its bounding box.
struct MeshLength
{
    double number = 0;
    bool percent = false;

    double of(double diagonal) const { return percent ? number / 100 * diagonal : number; }
    std::string text() const; ///< the shortest that reads back the same
    /// "0.5", "2%"; positive and finite.
    static std::optional<MeshLength> parse(const std::string& text);
};

/// An option that takes one.
void addMeshLength(CLI::App& app, const char* name, std::optional<MeshLength>& length, const char* text);

} // namespace gimg::cli

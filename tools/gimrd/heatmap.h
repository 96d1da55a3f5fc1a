#pragma once

#include "gimg/mesh.h"
#include "gimg/result.h"

#include <optional>
#include <string>

namespace gimg::gimrd {

enum class HeatmapFormat
{
    Ply, ///< the test mesh, each vertex coloured by its distance to the reference
    Png, ///< both surfaces seen from the front, each point coloured by its distance to the other surface
};

/// By the extension; nothing for others.
std::optional<HeatmapFormat> heatmapFormat(const std::string& path);

struct Heatmap
{
    std::string path;
    double top = 0;      ///< the distance that has the brightest colour; those above it have the same
    double diagonal = 1; ///< of which the colour bar gives percents
    int threads = 0;     ///< 0: one a core
};

Status writeHeatmap(const Mesh& reference, const Mesh& test, const Heatmap& heatmap);

} // namespace gimg::gimrd

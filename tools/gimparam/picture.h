#pragma once

#include "gimg/corner_map.h"
#include "gimg/render.h"
#include "gimg/result.h"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace gimg::gimparam {

/// A picture of a surface under a checkerboard.
struct PictureOptions
{
    std::string path;   ///< none if empty
    int size = 512;     ///< pixels a side
    double fields = 40; ///< a side of the square that is as large as the whole map
    std::vector<double> toward = {-0.45, -0.3, -1}, up = {0, 1, 0};

    bool wanted() const { return !path.empty(); }
};

/// --picture and how it looks.
void addPicture(CLI::App& command, PictureOptions& picture);

/// Draws the fields of `map` on the mesh and writes it as PNG.
/// @param part    per face, which pair of colours it has; empty: the first
/// @param marks   points of space that get a dot
/// Errors: those of render and writePng.
Status writePicture(const Mesh& mesh, const CornerMap& map, const std::vector<int>& part,
                    const std::vector<Vec3>& marks, const PictureOptions& picture);

} // namespace gimg::gimparam

#pragma once

#include "gimg/corner_map.h"
#include "gimg/handle_separation.h"
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

/// Coordinates for a checkerboard of about square fields that has no seam inside handles: `modular` (see
/// modularCoordinates) in a basis of each handle's lattice with short sides, these divided into even numbers
/// of fields. Fields have side 1.
/// @param side  of a field in the plane that the periods are in
CornerMap seamlessFields(const HandleSeparation& separation, const CornerMap& modular, double side);

/// Side of a field where `fields` times as many would make up the area of a map.
double fieldSide(const CornerMap& map, double fields);

/// Draws the fields of `map` on the mesh and writes it as PNG.
/// @param side    of a field
/// @param part    per face, which pair of colours it has; empty: the first
/// @param marks   points of space that get a dot
/// Errors: those of render and writePng.
Status writePicture(const Mesh& mesh, const CornerMap& map, double side, const std::vector<int>& part,
                    const std::vector<Vec3>& marks, const PictureOptions& picture);

} // namespace gimg::gimparam

#pragma once

#include "gimg/cut.h"
#include "gimg/disk.h"
#include "gimg/mesh.h"
#include "gimg/result.h"

#include <gim.h>

#include <cstdint>
#include <vector>

namespace gimg {

/// How the cut lies on the border of the square.
enum class SquareLayout
{
    Auto,      ///< the better of the two for closed surfaces of genus 0 (see unfold), else Cut
    Cut,       ///< any cut; its paths' lengths follow the surface
    Octahedral ///< a star of four paths (see starCut): its centre at the corners, its tips at the middles of
               ///< the sides, so that each side folds onto itself (Praun & Hoppe 2003)
};

struct BorderOptions
{
    static constexpr int kDefaultGrid = 257;
    static constexpr int kLargestGrid = 4097;

    int grid = 0; ///< samples a side, 2^j + 1; 0: 257, or the next larger grid that can hold the cut
    int lowest =
        0; ///< lowest level of detail, 2^l + 1 <= grid; 0: 33 (less for small grids), or the next that fits
    SquareLayout layout = SquareLayout::Auto; ///< layOutBorder takes Auto for Cut
};

/// How much of the square's border every path of a cut gets, and where the first side begins.
struct BorderLayout
{
    int lowest = 0; ///< samples a side of the lowest level, 2^l + 1; the unit is a step of its grid
    int start = 0;  ///< border position of the first side, in [0, 4 (lowest - 1))
    std::vector<int> pathLength; ///< per cut-path

    bool operator==(const BorderLayout&) const = default;
};

/// A disk with its boundary laid out on the unit square.
struct SquareDisk
{
    Mesh surface;  ///< the input with some edges split; same surface
    CutGraph cut;  ///< the cut on `surface`
    DiskMesh disk; ///< `surface` opened along `cut`

    int grid = 0;
    int lowest = 0;
    int start = 0;                                  ///< where the first side begins, in lowest-grid units
    std::vector<int> pathLength;                    ///< per cut-path, in lowest-grid units
    std::vector<std::vector<double>> pathParameter; ///< per path vertex, rising from 0 to pathLength

    std::vector<Vec2> borderPosition; ///< per disk vertex: (s,t); meaningful on the border only
    std::vector<uint8_t>
        squareSides; ///< per disk vertex: bit mask of the square's sides it lies on, 0 inside

    std::vector<gim_side> seam() const; ///< the word that the decoder fuses by
};

/// Lays the opened cut out along the unit square, counter-clockwise from (0,0): every cut-path gets a whole
/// number of lowest-grid units in proportion to its length, mates the same number; the square's corners fall
/// on vertices (edges across them are split, and their mates); no cut-node of valence 1 falls on a corner;
/// interior edges between two border vertices are split at their midpoints, the faces beside them with them,
/// so that no triangle lies on one side of the square and the interior is connected. The seam stays a
/// simplicial complex at every level of detail. Errors: TargetUnreachable if the cut does not fit the asked
/// grid or lowest level (names what would), BadArgument for sizes that are not 2^j + 1. Source: thesis
/// §3.1.1, boundary parameterization.
Result<SquareDisk> layOutBorder(const Mesh& mesh, const CutGraph& cut, const BorderOptions& options);

/// The same for a layout that is given: nothing about it is chosen, and whether the seam stays simplicial is
/// not looked at. Errors: BadArgument where the sizes are not 2^j + 1 or the lengths do not fill the border.
Result<SquareDisk> layOutBorder(const Mesh& mesh, const CutGraph& cut, const BorderLayout& layout, int grid);

} // namespace gimg

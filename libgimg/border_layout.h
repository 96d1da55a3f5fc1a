#pragma once

#include "gimg/border.h"

#include <optional>

namespace gimg {

struct PathNeeds
{
    double target = 0;    ///< length to come near to, in steps of the lowest grid
    int minimum = 1;      ///< shortest length that keeps the seam a simplicial complex
    int multiplicity = 2; ///< sides of the opened border that carry the path: 2 for mates, 1 for boundaries
};

/// Without the targets. A loop needs three edges, and of several paths between the same two nodes only one
/// may be a single edge.
std::vector<PathNeeds> pathNeeds(const CutGraph& cut);

/// Rounds the targets to integers whose sum over both mates is the perimeter; the residual goes to the paths
/// that rounding treated worst, one unit (on both mates) at a time. Nothing where that cannot be.
std::optional<std::vector<int>> roundLengths(const std::vector<PathNeeds>& needs, int perimeter);

/// The word of sides around the border.
std::vector<gim_side> seamWord(const DiskMesh& disk, const CutGraph& cut, const std::vector<int>& pathLength);

/// Whether the glued grid is a simplicial surface from the lowest level on, and no node of valence 1 falls on
/// a corner of the square. Lengths must add up to the perimeter and be no less than the minimal ones.
bool isSound(const BorderLayout& layout, const DiskMesh& disk, const CutGraph& cut);

/// Lengths in proportion to the surface. The lowest level is the one asked for, or the smallest from the
/// default on; preferably one whose border is at least twice as long as the cut needs, so that lengths can
/// follow the surface.
Result<BorderLayout> proportionalLayout(const CutGraph& cut, const DiskMesh& disk, const Mesh& mesh, int grid,
                                        int asked, SquareLayout kind);

} // namespace gimg

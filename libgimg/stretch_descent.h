#pragma once

#include "gimg/mesh.h"
#include "gimg/stretch.h"

#include <array>
#include <vector>

namespace gimg {

/// How a vertex follows the unknowns: coordinate c changes by sign[c] times unknown row[c], or not at all
/// where row[c] is -1. Vertices that move together share rows.
struct Freedom
{
    std::array<int, 2> row = {-1, -1};
    std::array<double, 2> sign = {1, 1};
};

/// Mean over the corners of a triangle; 1 where no importance is given.
inline double meanImportance(const std::vector<double>& importance, const Triangle& t)
{
    return importance.empty() ? 1 : (importance[t[0]] + importance[t[1]] + importance[t[2]]) / 3;
}

/// minimizeStretch for vertices that are free, fixed or tied to each other.
/// @param importance  per vertex: how much the stretch of the triangles around it counts; empty for 1
/// everywhere
/// @param freedom   one a vertex
/// @param unknowns  number of rows
double minimizeStretch(const Mesh& mesh, const std::vector<double>& importance,
                       const std::vector<Freedom>& freedom, int unknowns, std::vector<Vec2>& st,
                       const DescentOptions& options);

} // namespace gimg

#pragma once

#include "polygon_soup.h"

#include <cstdint>
#include <unordered_set>

namespace gimg {

/// Cuts polygons into triangles that use each polygon edge once and no other boundary: warped polygons get
/// the triangulation of least area, flat ones the shortest diagonals, so none leaves a non-convex polygon
/// where that can be helped; and no diagonal doubles an edge of the mesh where that can be helped.
/// Source: dynamic programming as in Barequet and Sharir 1995; ear clipping for polygons above 32 corners.
class PolygonTriangulator
{
public:
    explicit PolygonTriangulator(const PolygonSoup& soup);

    /// Appends the triangles of one face. Corners equal to their predecessor count once; fewer than three
    /// corners give the one triangle that repeats a vertex, so that the caller can count it.
    void append(std::span<const int> polygon, std::vector<Triangle>& triangles);

private:
    void leastArea(std::vector<Triangle>& triangles);
    void clipEars(std::vector<Triangle>& triangles);
    bool isEdge(int a, int b) const;

    const PolygonSoup& soup_;
    std::vector<int> ring_;
    std::vector<uint64_t> edges_; ///< of the soup's polygons, sorted; empty where all are triangles
    std::unordered_set<uint64_t> diagonals_;
    int64_t tests_ = 0; ///< of points against ears, so far
};

} // namespace gimg

#pragma once

#include "gimg/mesh_io.h"
#include "polygon_soup.h"

namespace gimg {

/// All faces of the soup as triangles, in order.
std::vector<Triangle> triangulate(const PolygonSoup& soup);

/// Turns polygons into a mesh as readMesh promises, or says why not (without the path).
Result<MeshFile> repaired(const PolygonSoup& soup, const ReadOptions& options);

} // namespace gimg

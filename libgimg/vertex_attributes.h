#pragma once

#include "gimg/vertex_attribute.h"
#include "polygon_soup.h"

namespace gimg {

/// The attributes that a file's vertex properties make: red, green, blue and perhaps alpha are "color"; s, t
/// or u, v or texture_u, texture_v are "uv"; others stand for themselves. Normals are left out, and so are
/// properties whose name cannot be an attribute's.
/// @param vertices  those to take, in this order
std::vector<VertexAttribute> attributesOf(const PolygonSoup& soup, const std::vector<int>& vertices);

} // namespace gimg

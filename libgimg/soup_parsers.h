#pragma once

#include "polygon_soup.h"

#include <string_view>

namespace gimg {

// One parser a format, from the bytes of a whole file. Indices are not yet checked against the vertex count,
// but each fits an int; messages do not name the file. May throw std::bad_alloc.
Result<PolygonSoup> parseObj(std::string_view text);
Result<PolygonSoup> parsePly(std::string_view bytes);
Result<PolygonSoup> parseOff(std::string_view text);
Result<PolygonSoup> parseStl(std::string_view bytes);

} // namespace gimg

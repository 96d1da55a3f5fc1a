#include "vertex_attributes.h"

#include "codec/attribute_header.h"

#include <algorithm>
#include <initializer_list>

namespace gimg {
namespace {

using Columns = std::vector<const VertexColumn*>;

const VertexColumn* columnOf(const PolygonSoup& soup, const std::string& name)
{
    const auto found = std::find_if(soup.columns.begin(), soup.columns.end(),
                                    [&](const VertexColumn& column) { return column.name == name; });
    return found == soup.columns.end() ? nullptr : &*found;
}

// All of the columns, if the file has them and they are of one type.
Columns together(const PolygonSoup& soup, std::initializer_list<const char*> names)
{
    Columns columns;
    for (const char* name : names) {
        const VertexColumn* column = columnOf(soup, name);
        if (column == nullptr || (!columns.empty() && column->type != columns.front()->type)) return {};
        columns.push_back(column);
    }
    return columns;
}

Columns firstOf(std::initializer_list<Columns> choices)
{
    for (const Columns& columns : choices)
        if (!columns.empty()) return columns;
    return {};
}

bool isNormal(const std::string& name) { return name == "nx" || name == "ny" || name == "nz"; }

bool isAttributeName(const std::string& name)
{
    return codec::isAttributeName({reinterpret_cast<const uint8_t*>(name.data()), name.size()});
}

VertexAttribute joined(std::string name, const Columns& columns, const std::vector<int>& vertices)
{
    VertexAttribute attribute;
    attribute.name = std::move(name);
    attribute.channels = static_cast<int>(columns.size());
    attribute.type = columns.front()->type;
    attribute.values.reserve(columns.size() * vertices.size());
    for (const int v : vertices)
        for (const VertexColumn* column : columns) attribute.values.push_back(column->values[v]);
    return attribute;
}

} // namespace

const VertexAttribute* findAttribute(const std::vector<VertexAttribute>& attributes, const std::string& name)
{
    const auto found = std::find_if(attributes.begin(), attributes.end(),
                                    [&](const VertexAttribute& a) { return a.name == name; });
    return found == attributes.end() ? nullptr : &*found;
}

std::vector<VertexAttribute> attributesOf(const PolygonSoup& soup, const std::vector<int>& vertices)
{
    std::vector<VertexAttribute> attributes;
    Columns used;
    const auto take = [&](const char* name, const Columns& columns) {
        if (columns.empty()) return;
        attributes.push_back(joined(name, columns, vertices));
        attributes.back().normalized = attributes.back().type != GIM_F32;
        used.insert(used.end(), columns.begin(), columns.end());
    };
    take("color", firstOf({together(soup, {"red", "green", "blue", "alpha"}),
                           together(soup, {"red", "green", "blue"})}));
    take("uv", firstOf({together(soup, {"s", "t"}), together(soup, {"u", "v"}),
                        together(soup, {"texture_u", "texture_v"})}));
    for (const VertexColumn& column : soup.columns) {
        if (std::find(used.begin(), used.end(), &column) != used.end() || isNormal(column.name)) continue;
        if (!isAttributeName(column.name) || findAttribute(attributes, column.name) != nullptr) continue;
        attributes.push_back(joined(column.name, {&column}, vertices));
    }
    return attributes;
}

} // namespace gimg

#pragma once

#include "gimg/mesh.h"

#include <gim.h>

#include <string>
#include <vector>

namespace gimg {

/// Numbers that belong to the vertices of a mesh: colours, texture coordinates, weights.
struct VertexAttribute
{
    std::string name;
    int channels = 1; ///< 1 to 16
    gim_sample_type type = GIM_F32;
    bool normalized = false;   ///< integers stand for fractions of the largest of their type
    std::vector<float> values; ///< `channels` numbers for each vertex
};

/// A surface whose vertices have attributes. Where an attribute jumps, several vertices share a place.
struct AttributedSurface
{
    Mesh mesh;
    std::vector<VertexAttribute> attributes;
};

/// An attribute by its name; null if there is none.
const VertexAttribute* findAttribute(const std::vector<VertexAttribute>& attributes, const std::string& name);

} // namespace gimg

#pragma once

#include "gimg/mesh.h"
#include "gimg/result.h"

#include <gim.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace gimg {

enum class MeshFormat
{
    Obj,
    Ply,
    Off,
    Stl,
};

/// By the extension of the path, in either case.
Result<MeshFormat> meshFormat(const std::string& path);

/// A number that every vertex has besides its position.
struct VertexColumn
{
    std::string name;
    gim_sample_type type = GIM_F32;
    std::vector<float> values; ///< one for each position
};

/// Polygons as a file lists them: every index is in range, nothing else is promised.
struct PolygonSoup
{
    std::vector<Vec3> positions;
    std::vector<VertexColumn> columns;
    std::vector<int> corners;                 ///< vertex indices of all faces, one face after the other
    std::vector<size_t> faceStart{size_t{0}}; ///< faceCount() + 1 offsets into corners
    int firstNumber = 0;                      ///< what the file format calls its first vertex and face
    bool indexed = true;                      ///< false for STL: every corner is a vertex of its own
    size_t trailingBytes = 0;                 ///< after the end of the data
    bool lastLineOpen = false;                ///< an indexed text file that does not end with a line end

    size_t faceCount() const { return faceStart.size() - 1; }
    std::span<const int> face(size_t f) const
    {
        return {corners.data() + faceStart[f], corners.data() + faceStart[f + 1]};
    }
    void endFace() { faceStart.push_back(corners.size()); }
};

/// Parses a whole file strictly: whatever contradicts its format or its own counts is an error, and nothing
/// is allocated from a count before the bytes behind it are known to exist.
Result<PolygonSoup> readPolygonSoup(const std::string& path);

} // namespace gimg

#pragma once

#include "gimg/color.h"
#include "gimg/mesh.h"
#include "gimg/result.h"
#include "gimg/vertex_attribute.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace gimg {

/// Whether vertices at equal positions become one vertex.
enum class Weld
{
    Auto,   ///< STL always; indexed formats only where it adds no defect (see RepairReport::weldRefusal)
    Always, ///< whatever comes of it
    Never,  ///< vertices stay as indexed; an STL file is then one component a facet
};

struct ReadOptions
{
    Weld weld = Weld::Auto;
    /// Of several components take the one with the most triangles (the first of equals); defects of the
    /// others then do not matter. A component is connected across edges: parts that touch in a vertex only
    /// are two. False: several components are refused.
    bool largestComponent = false;
};

/// What reading found and changed. Counts are numbers of elements; zero means there was nothing to do.
struct RepairReport
{
    int64_t verticesRead = 0; ///< as in the file; an STL file has three a facet
    int64_t facesRead = 0;    ///< as in the file, polygons counted once

    int64_t polygonsSplit = 0;       ///< faces with more than three corners, cut into triangles
    int64_t repeatedVertexFaces = 0; ///< triangles removed because two corners are the same vertex
    int64_t duplicateFaces = 0;      ///< triangles removed because another one has the same three vertices
    int64_t zeroAreaFaces = 0;       ///< kept: a triangle without area still closes the surface
    int64_t repeatedPositions = 0; ///< referenced vertices at the position of an earlier one, before welding
    int64_t weldedVertices = 0;    ///< of those, merged into the earlier one
    std::string weldRefusal;       ///< why Weld::Auto left repeatedPositions alone; empty if it did not
    int64_t unreferencedVertices = 0; ///< dropped: in no face
    int64_t flippedFaces = 0;         ///< reversed to make the orientation consistent
    int64_t components = 0;           ///< connected across edges, before any was dropped
    int64_t droppedFaces = 0;         ///< triangles of the components that were not chosen
    int64_t trailingBytes = 0;        ///< bytes after the end of the data, ignored
    bool lastLineOpen = false; ///< a text file without a final line end: its last number may be cut short
};

/// One line for every entry of the report that a user should know about; empty for a clean mesh.
std::vector<std::string> warnings(const RepairReport& report);

/// A mesh fit for cutting and flattening, and what was done to get there.
struct MeshFile
{
    Mesh mesh; ///< connected, manifold, consistently oriented, finite, every vertex in a face
    RepairReport report;
    /// The same surface as the file has it, with what it tells of its vertices: PLY's vertex properties, and
    /// the colours that OBJ files may have. Its vertices are not welded. Empty if the file tells nothing.
    AttributedSurface attributed;
};

/// Reads OBJ, PLY (ascii, binary of either byte order), OFF or STL (ascii, binary), told apart by the
/// extension of `path`. Coordinates keep the file's precision. Polygons are triangulated, repeated vertices
/// welded (see Weld), faces with a repeated vertex and duplicate faces removed, unreferenced vertices
/// dropped, and the orientation made consistent: where faces had to be flipped a closed surface ends up with
/// its normals outward, another one with the orientation most of its faces had. Vertices and faces keep the
/// order of the file.
///
/// What cannot be repaired this way is refused with one line that starts with the path and names the element
/// as the file counts it: OBJ from 1, the others from 0; STL vertices in file order, three a facet.
/// Errors: FormatUnknown, FileNotReadable, FileTruncated, FileCorrupt, EmptyMesh; then, in this order,
/// NotFinite (of any component unless the largest is asked for), SeveralComponents, NonManifoldEdge,
/// NonManifoldVertex, NotOrientable.
/// Safe on hostile files and thread-safe. Memory is a small multiple of the file's size.
Result<MeshFile> readMesh(const std::string& path, const ReadOptions& options = {});

/// Reads the triangles of a mesh for measuring: as readMesh, but with no repair and no demand on topology.
/// Polygons are triangulated; coordinates of referenced vertices must be finite.
/// Errors: FormatUnknown, FileNotReadable, FileTruncated, FileCorrupt, EmptyMesh, NotFinite.
Result<Mesh> readTriangles(const std::string& path);

/// How numbers are stored; OBJ and OFF are always Ascii.
enum class Encoding
{
    Binary, ///< little-endian
    BinaryBigEndian,
    Ascii,
};

/// Writes OBJ, PLY, OFF or STL, told apart by the extension of `path`. Coordinates survive a round trip
/// exactly (PLY uses float32 where that is exact, else float64), except in STL, which holds float32 and no
/// shared vertices.
/// @param normals   none, or one for each vertex; STL has facet normals only and ignores them
/// @param attributes  of the vertices. PLY takes all: "color" of three or four channels as red, green, blue
///                  and alpha (uchar, or ushort), "uv" of two as s and t, others under their names; integers
///                  of "color" and others as such. OBJ takes "color", after the positions, from 0 to 1; OFF
///                  and STL take none.
/// @param encoding  of PLY and STL; STL knows no BinaryBigEndian
/// Errors: FormatUnknown, BadArgument (an index out of range, a wrong number of normals), NotFinite,
/// FileNotWritable.
Status writeMesh(const Mesh& mesh, const std::string& path, std::span<const Vec3> normals = {},
                 Encoding encoding = Encoding::Binary, std::span<const VertexAttribute> attributes = {});

/// Whether writeMesh writes this attribute into a file of that name.
bool takesAttribute(const std::string& path, const VertexAttribute& attribute);

/// Writes a PLY file whose vertices have a colour (uchar red, green, blue) and a number of their own (float
/// quality), under the names that MeshLab and Blender read. Positions as in writeMesh.
/// @param colors, quality  none, or one for each vertex
/// Errors: as writeMesh; FormatUnknown for any extension but .ply.
Status writeColoredPly(const Mesh& mesh, const std::string& path, std::span<const Color> colors,
                       std::span<const double> quality = {}, Encoding encoding = Encoding::Binary);

} // namespace gimg

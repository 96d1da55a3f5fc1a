#include "gimg/mesh_io.h"
#include "mesh_output.h"
#include "polygon_soup.h"

#include <algorithm>
#include <cmath>
#include <exception>

namespace gimg {

namespace {

bool isColor(const VertexAttribute& attribute)
{
    return attribute.name == "color" && (attribute.channels == 3 || attribute.channels == 4);
}

double largestOf(gim_sample_type type) { return type == GIM_U8 ? 255 : type == GIM_U16 ? 65535 : 1; }

void writeObj(const Mesh& mesh, std::span<const Vec3> normals, std::span<const VertexAttribute> attributes,
              MeshOutput& out)
{
    const auto color = std::find_if(attributes.begin(), attributes.end(), isColor);
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
        out << "v " << mesh.positions[v];
        for (int c = 0; c < 3 && color != attributes.end(); ++c)
            out << " "
                << static_cast<float>(double{color->values[v * color->channels + c]} /
                                      largestOf(color->type));
        out << "\n";
    }
    for (const Vec3& n : normals) out << "vn " << n << "\n";
    for (const Triangle& t : mesh.faces) {
        out << "f";
        for (int v : t) {
            out << " " << v + 1;
            if (!normals.empty()) out << "//" << v + 1;
        }
        out << "\n";
    }
}

void writeOff(const Mesh& mesh, std::span<const Vec3> normals, MeshOutput& out)
{
    out << (normals.empty() ? "OFF\n" : "NOFF\n") << mesh.vertexCount() << " " << mesh.faceCount() << " 0\n";
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
        out << mesh.positions[v];
        if (!normals.empty()) out << " " << normals[v];
        out << "\n";
    }
    for (const Triangle& t : mesh.faces) out << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
}

bool exactInFloat(const Mesh& mesh)
{
    return std::all_of(mesh.positions.begin(), mesh.positions.end(),
                       [](const Vec3& p) { return p == p.cast<float>().cast<double>(); });
}

/// What a PLY file holds of each vertex besides its position; an empty list is left out.
struct VertexProperties
{
    std::span<const Vec3> normals;
    std::span<const Color> colors;
    std::span<const double> quality;
    std::span<const VertexAttribute> attributes;
};

// A colour of floats from 0 to 1 becomes bytes.
gim_sample_type plyType(const VertexAttribute& attribute)
{
    return isColor(attribute) && attribute.type == GIM_F32 ? GIM_U8 : attribute.type;
}

std::string plyName(const VertexAttribute& attribute, int channel)
{
    constexpr const char* kColor[] = {"red", "green", "blue", "alpha"};
    if (isColor(attribute)) return kColor[channel];
    if (attribute.name == "uv" && attribute.channels == 2) return channel == 0 ? "s" : "t";
    std::string name = attribute.name;
    std::replace(name.begin(), name.end(), ' ', '_'); // which ends a word of the header
    return attribute.channels == 1 ? name : name + "_" + std::to_string(channel);
}

void writePlyHeader(const Mesh& mesh, const VertexProperties& vertex, bool isFloat, Encoding encoding,
                    MeshOutput& out)
{
    out << "ply\nformat "
        << (encoding == Encoding::Ascii    ? "ascii"
            : encoding == Encoding::Binary ? "binary_little_endian"
                                           : "binary_big_endian")
        << " 1.0\nelement vertex " << mesh.vertexCount() << "\n";
    for (const char* axis : {"x", "y", "z"})
        out << "property " << (isFloat ? "float " : "double ") << axis << "\n";
    if (!vertex.normals.empty())
        for (const char* axis : {"nx", "ny", "nz"}) out << "property float " << axis << "\n";
    if (!vertex.colors.empty())
        for (const char* channel : {"red", "green", "blue"}) out << "property uchar " << channel << "\n";
    if (!vertex.quality.empty()) out << "property float quality\n";
    for (const VertexAttribute& attribute : vertex.attributes)
        for (int c = 0; c < attribute.channels; ++c)
            out << "property "
                << (plyType(attribute) == GIM_U8    ? "uchar "
                    : plyType(attribute) == GIM_U16 ? "ushort "
                                                    : "float ")
                << plyName(attribute, c) << "\n";
    out << "element face " << mesh.faceCount() << "\nproperty list uchar int vertex_indices\nend_header\n";
}

void writePly(const Mesh& mesh, const VertexProperties& vertex, Encoding encoding, MeshOutput& out)
{
    const bool isFloat = exactInFloat(mesh);
    writePlyHeader(mesh, vertex, isFloat, encoding, out);
    const bool ascii = encoding == Encoding::Ascii;
    const auto number = [&](auto value) {
        if (ascii)
            out << " " << value;
        else
            out.binary(value);
    };
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
        const Vec3& p = mesh.positions[v];
        if (ascii)
            out << p;
        else
            for (double x : p) isFloat ? out.binary(static_cast<float>(x)) : out.binary(x);
        if (!vertex.normals.empty())
            for (double x : vertex.normals[v]) number(static_cast<float>(x));
        if (!vertex.colors.empty())
            for (uint8_t x : vertex.colors[v]) ascii ? void(out << " " << int{x}) : out.binary(x, 1);
        if (!vertex.quality.empty()) number(static_cast<float>(vertex.quality[v]));
        for (const VertexAttribute& attribute : vertex.attributes)
            for (int c = 0; c < attribute.channels; ++c) {
                const gim_sample_type type = plyType(attribute);
                float value = attribute.values[v * attribute.channels + c];
                if (type != attribute.type) value = std::floor(std::clamp(value, 0.0f, 1.0f) * 255 + 0.5f);
                if (type == GIM_F32)
                    number(value);
                else if (ascii)
                    out << " " << static_cast<int>(value);
                else
                    out.binary(static_cast<uint64_t>(value), type == GIM_U8 ? 1 : 2);
            }
        if (ascii) out << "\n";
    }
    for (const Triangle& t : mesh.faces) {
        if (ascii) {
            out << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
            continue;
        }
        out.binary(3, 1);
        for (int v : t) out.binary(static_cast<uint64_t>(v), 4);
    }
}

void writeStl(const Mesh& mesh, Encoding encoding, MeshOutput& out)
{
    using Vec3f = Eigen::Vector3f;
    if (encoding == Encoding::Ascii)
        out << "solid mesh\n";
    else {
        std::string header = "binary STL"; // a text file is one that starts with "solid"
        header.resize(80, ' ');
        out << header;
        out.binary(static_cast<uint64_t>(mesh.faceCount()), 4);
    }
    for (const Triangle& t : mesh.faces) {
        const Vec3& p = mesh.positions[t[0]];
        const Vec3f normal = (mesh.positions[t[1]] - p)
                                 .stableNormalized()
                                 .cross((mesh.positions[t[2]] - p).stableNormalized())
                                 .stableNormalized()
                                 .cast<float>();
        if (encoding == Encoding::Ascii) {
            out << "facet normal " << normal[0] << " " << normal[1] << " " << normal[2] << "\nouter loop\n";
            for (int v : t) {
                const Vec3f q = mesh.positions[v].cast<float>();
                out << "vertex " << q[0] << " " << q[1] << " " << q[2] << "\n";
            }
            out << "endloop\nendfacet\n";
            continue;
        }
        for (float x : normal) out.binary(x);
        for (int v : t)
            for (double x : mesh.positions[v]) out.binary(static_cast<float>(x));
        out.binary(0, 2);
    }
    if (encoding == Encoding::Ascii) out << "endsolid mesh\n";
}

Status checked(const Mesh& mesh, MeshFormat format, std::span<const Vec3> normals,
               std::span<const VertexAttribute> attributes, Encoding encoding)
{
    for (const VertexAttribute& attribute : attributes)
        if (attribute.values.size() != static_cast<size_t>(attribute.channels) * mesh.positions.size())
            return Error{ErrorKind::BadArgument,
                         "attribute " + attribute.name + " does not fit the vertices"};
    for (size_t f = 0; f < mesh.faces.size(); ++f)
        for (int v : mesh.faces[f])
            if (v < 0 || v >= mesh.vertexCount())
                return Error{ErrorKind::BadArgument, "face " + std::to_string(f) + " names vertex " +
                                                         std::to_string(v) + " of " +
                                                         std::to_string(mesh.vertexCount())};
    if (!normals.empty() && normals.size() != mesh.positions.size())
        return Error{ErrorKind::BadArgument, std::to_string(normals.size()) + " normals for " +
                                                 std::to_string(mesh.vertexCount()) + " vertices"};
    if (format == MeshFormat::Stl && encoding == Encoding::BinaryBigEndian)
        return Error{ErrorKind::BadArgument, "binary STL is little-endian"};
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
        const Vec3& p = mesh.positions[v];
        const bool fits = format == MeshFormat::Stl ? p.cast<float>().allFinite() : p.allFinite();
        if (!fits || (!normals.empty() && !normals[v].allFinite()))
            return Error{ErrorKind::NotFinite, "vertex " + std::to_string(v) + " is not finite"};
    }
    return Done{};
}

} // namespace

bool takesAttribute(const std::string& path, const VertexAttribute& attribute)
{
    const Result<MeshFormat> format = meshFormat(path);
    if (!format) return false;
    return *format == MeshFormat::Ply || (*format == MeshFormat::Obj && isColor(attribute));
}

Status writeMesh(const Mesh& mesh, const std::string& path, std::span<const Vec3> normals, Encoding encoding,
                 std::span<const VertexAttribute> attributes)
try {
    const Result<MeshFormat> format = meshFormat(path);
    if (!format) return format.error();
    if (const Status status = checked(mesh, *format, normals, attributes, encoding); !status)
        return Error{status.error().kind, path + ": " + status.error().message};

    MeshOutput out(encoding == Encoding::BinaryBigEndian);
    switch (*format) {
    case MeshFormat::Obj:
        writeObj(mesh, normals, attributes, out);
        break;
    case MeshFormat::Ply:
        writePly(mesh, {normals, {}, {}, attributes}, encoding, out);
        break;
    case MeshFormat::Off:
        writeOff(mesh, normals, out);
        break;
    case MeshFormat::Stl:
        writeStl(mesh, encoding, out);
        break;
    }
    return out.save(path);
} catch (const std::exception& failure) {
    return Error{ErrorKind::FileNotWritable, path + ": " + failure.what()};
}

Status writeColoredPly(const Mesh& mesh, const std::string& path, std::span<const Color> colors,
                       std::span<const double> quality, Encoding encoding)
try {
    const Result<MeshFormat> format = meshFormat(path);
    if (!format || *format != MeshFormat::Ply)
        return Error{ErrorKind::FormatUnknown, path + ": colours are written to .ply only"};
    if (const Status status = checked(mesh, *format, {}, {}, encoding); !status)
        return Error{status.error().kind, path + ": " + status.error().message};
    for (const size_t count : {colors.size(), quality.size()})
        if (count != 0 && count != mesh.positions.size())
            return Error{ErrorKind::BadArgument, path + ": " + std::to_string(count) + " values for " +
                                                     std::to_string(mesh.vertexCount()) + " vertices"};
    MeshOutput out(encoding == Encoding::BinaryBigEndian);
    writePly(mesh, {{}, colors, quality, {}}, encoding, out);
    return out.save(path);
} catch (const std::exception& failure) {
    return Error{ErrorKind::FileNotWritable, path + ": " + failure.what()};
}

} // namespace gimg

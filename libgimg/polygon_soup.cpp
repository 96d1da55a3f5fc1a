#include "polygon_soup.h"

#include "soup_parsers.h"
#include "text_scan.h"

#include <algorithm>
#include <climits>
#include <exception>
#include <filesystem>
#include <fstream>

namespace gimg {

namespace {

Result<std::string> fileBytes(const std::string& path)
{
    namespace fs = std::filesystem;
    std::error_code failure;
    const fs::file_status status = fs::status(path, failure);
    if (!fs::exists(status)) return Error{ErrorKind::FileNotReadable, "no such file"};
    if (fs::is_directory(status)) return Error{ErrorKind::FileNotReadable, "is a directory"};
    // Reading a pipe or a device need not end.
    if (!fs::is_regular_file(status)) return Error{ErrorKind::FileNotReadable, "is not a regular file"};
    const uintmax_t size = fs::file_size(path, failure);
    std::ifstream in(path, std::ios::binary);
    if (failure || !in) return Error{ErrorKind::FileNotReadable, "cannot be opened"};
    std::string bytes(size, '\0');
    if (!in.read(bytes.data(), static_cast<std::streamsize>(size)))
        return Error{ErrorKind::FileNotReadable, "cannot be read"};
    return bytes;
}

Result<PolygonSoup> parse(MeshFormat format, std::string_view bytes)
{
    switch (format) {
    case MeshFormat::Obj:
        return parseObj(bytes);
    case MeshFormat::Ply:
        return parsePly(bytes);
    case MeshFormat::Off:
        return parseOff(bytes);
    case MeshFormat::Stl:
        return parseStl(bytes);
    }
    return Error{ErrorKind::FormatUnknown, "unknown mesh format"};
}

Result<PolygonSoup> checkedSoup(MeshFormat format, std::string_view bytes)
{
    if (bytes.empty()) return Error{ErrorKind::EmptyMesh, "the file is empty"};
    Result<PolygonSoup> soup = parse(format, bytes);
    if (!soup) return soup;
    if (soup->faceCount() == 0)
        return Error{ErrorKind::EmptyMesh,
                     "no faces (" + std::to_string(soup->positions.size()) + " vertices)"};
    // A mesh has int indices, three a face, and a polygon of n corners gives n - 2 triangles.
    if (soup->positions.size() > INT_MAX || soup->corners.size() > INT_MAX / 3)
        return Error{ErrorKind::BadArgument, "too large: more than 700 million corners"};
    const int count = static_cast<int>(soup->positions.size());
    const auto bad = std::find_if(soup->corners.begin(), soup->corners.end(),
                                  [count](int v) { return v < 0 || v >= count; });
    if (bad == soup->corners.end()) return soup;
    const size_t corner = static_cast<size_t>(bad - soup->corners.begin());
    const auto after = std::upper_bound(soup->faceStart.begin(), soup->faceStart.end(), corner);
    const auto face = after - soup->faceStart.begin() - 1;
    return Error{ErrorKind::FileCorrupt, "face " + std::to_string(face + soup->firstNumber) + ": vertex " +
                                             std::to_string(int64_t{*bad} + soup->firstNumber) +
                                             " does not exist, the file has " + std::to_string(count) +
                                             " vertices"};
}

} // namespace

Result<MeshFormat> meshFormat(const std::string& path)
{
    const std::string extension = std::filesystem::path(path).extension().string();
    if (equalsIgnoringCase(extension, ".obj")) return MeshFormat::Obj;
    if (equalsIgnoringCase(extension, ".ply")) return MeshFormat::Ply;
    if (equalsIgnoringCase(extension, ".off")) return MeshFormat::Off;
    if (equalsIgnoringCase(extension, ".stl")) return MeshFormat::Stl;
    return Error{ErrorKind::FormatUnknown,
                 path + ": unknown mesh format '" + extension + "', known are .obj, .ply, .off and .stl"};
}

Result<PolygonSoup> readPolygonSoup(const std::string& path)
try {
    const Result<MeshFormat> format = meshFormat(path);
    if (!format) return format.error();
    const Result<std::string> bytes = fileBytes(path);
    if (!bytes) return Error{bytes.error().kind, path + ": " + bytes.error().message};
    Result<PolygonSoup> soup = checkedSoup(*format, *bytes);
    if (!soup) return Error{soup.error().kind, path + ": " + soup.error().message};
    return soup;
} catch (const std::exception& failure) {
    return Error{ErrorKind::FileNotReadable, path + ": " + failure.what()};
}

} // namespace gimg

#pragma once

#include "gimg/distance.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace gimg::gimrd {

/// What a sweep found for one mesh, coder, grid and size: all that tables, curves and the report are made of.
struct Point
{
    enum class State
    {
        Done,
        Unreachable, ///< the coder says that it has no file for this size
        Failed,
    };

    // What was asked.
    std::string mesh, coder;
    int grid = 0;
    size_t target = 0;
    int samples = 0;    ///< of the measure
    std::string sha256; ///< of the mesh's file; empty if it could not be read

    // The reference, 0 where it could not be read.
    int referenceFaces = 0;
    double diagonal = 0;
    std::string note; ///< what is to be said about the reference; empty if nothing

    State state = State::Failed;
    std::string message; ///< why there is no file

    // Of Done only.
    size_t bytes = 0;
    int faces = 0; ///< of the decoded mesh
    SurfaceDistance distance;
    std::optional<double> normalError; ///< in degrees, SurfaceDistance::normalRms()
    std::string file;                  ///< the encoded file below the folder `work`
    nlohmann::ordered_json settings = nlohmann::ordered_json::object();
    nlohmann::ordered_json versions = nlohmann::ordered_json::object(); ///< of what made it
};

/// The name of a point's files, without folder and extension: "raw-zlib-257-1536".
std::string pointStem(const std::string& series, size_t target);

nlohmann::ordered_json toJson(const Point& point);

/// Nothing if the object is not a whole point.
std::optional<Point> pointFromJson(const nlohmann::ordered_json& json);

/// Nothing if there is no such file or it is not a whole point.
std::optional<Point> readPoint(const std::filesystem::path& path);

/// A JSON file's text. Bytes that are no UTF-8, from a program's error message, are replaced.
std::string jsonText(const nlohmann::ordered_json& json);

/// "done", "unreachable", "failed"
const char* name(Point::State state);

} // namespace gimg::gimrd

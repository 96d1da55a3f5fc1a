#pragma once

#include "../cli.h"
#include "../mesh_length.h"

#include "gimg/encode.h"
#include "gimg/mesh_io.h"

#include <optional>
#include <string>
#include <vector>

namespace gimg::gimenc {

using cli::MeshLength;

/// One file to make: from what, and how.
struct Arguments
{
    std::string input, output;
    int grid = 0, lowest = 0, normals = 0, threads = 0;
    std::optional<size_t> bytes; ///< of bytes, psnr, maxError and raw exactly one is set
    std::optional<double> psnr, maxError;
    std::string raw, component, json;
    std::vector<std::string> attributes; ///< NAME[:GRID][:lossless]
    std::string layout = "auto";
    std::string coding = "surface";
    std::string density = "curvature";
    std::string weld = "auto";
    std::string param = "stretch";
    int effort = EncodeOptions().effort;
    int smoothLevels = 0;
    bool progressive = false;
    bool fromImage = false;
    std::optional<double> tolerance;
    bool noFit = false;
    bool features = false;
    std::optional<int> maxGenus;
    bool removeNoise = false; ///< --max-genus auto
    std::optional<MeshLength> closeHoles;
    bool resume = false;
    bool quiet = false;
};

/// The options that say how a file is made; INPUT and OUTPUT are not among them.
void addOptions(CLI::App& app, Arguments& a);

/// Adds INPUT and OUTPUT. They are not required by the parser.
void addFiles(CLI::App& app, Arguments& a);

/// What is wrong with a parsed job as a whole; nothing if it can be tried.
std::optional<std::string> missing(const Arguments& a);

bool hasTarget(const Arguments& a);

/// A list line's arguments are what it says itself and `defaults` where it says nothing; a target of its own
/// replaces another one. Errors: BadArgument.
Result<Arguments> parseLine(const std::vector<std::string>& words, const Arguments& defaults);

/// The options that decide what is in the file, defaults left out, always in the same order and spelling.
std::vector<std::string> fileOptions(const Arguments& a);

/// "color", "weights:129:lossless"
std::optional<AttributeRequest> parseAttribute(const std::string& text);

ReadOptions readOptions(const Arguments& a);
EncodeOptions encodeOptions(const Arguments& a);

} // namespace gimg::gimenc

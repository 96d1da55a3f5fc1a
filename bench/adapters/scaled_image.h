#pragma once

#include "adapter.h"

#include <filesystem>

namespace gimg::adapter {

/// A geometry image in whole numbers of `bits` bits over its bounding cube, as image coders take it.
struct ScaledImage
{
    int side = 0;
    int bits = 0;
    std::vector<std::uint16_t> planes; ///< all x, all y, all z
};

/// The corner of least x, y, z and the side of the cube, which a file has to hold besides the image.
struct Cube
{
    static constexpr std::size_t kBytes = 4 * sizeof(float);
    float low[3] = {0, 0, 0};
    float side = 0;
};

Cube cubeOf(const FloatImage& image);
ScaledImage scaled(const FloatImage& image, const Cube& cube, int bits);
FloatImage unscaled(const ScaledImage& image, const Cube& cube);

/// The cube's bytes, then the image coder's.
std::vector<std::uint8_t> withCube(const Cube& cube, const std::vector<std::uint8_t>& coded);
/// The cube that a file of withCube() begins with; what follows it begins at Cube::kBytes.
Cube readCube(const std::vector<std::uint8_t>& file);

/// A folder for the files that a program reads and writes, gone with this.
class Scratch
{
public:
    Scratch();
    ~Scratch();
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;

    std::string path(const std::string& name) const { return (folder_ / name).string(); }

private:
    std::filesystem::path folder_;
};

/// Runs a program of PATH to its end; gives what it printed, on either stream.
/// Errors: CodecFailure with the last line it printed.
Result<std::string> runTool(const std::vector<std::string>& command);

/// Of `programs` those that are not on PATH, each named by its Debian package, as Description::missing holds.
std::vector<std::string> missingPrograms(const std::vector<std::string>& programs,
                                         const std::string& package);

/// The whole file or a CodecFailure.
Result<std::vector<std::uint8_t>> readOutput(const std::string& path);

} // namespace gimg::adapter

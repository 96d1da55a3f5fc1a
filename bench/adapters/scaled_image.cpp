#include "scaled_image.h"

#include "tools/cli.h"
#include "tools/gimrd/process.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace gimg::adapter {

Cube cubeOf(const FloatImage& image)
{
    const BoundingCube bounds = boundingCube(image);
    Cube cube;
    for (int c = 0; c < 3; ++c) cube.low[c] = static_cast<float>(bounds.low[c]);
    cube.side = static_cast<float>(bounds.side);
    return cube;
}

ScaledImage scaled(const FloatImage& image, const Cube& cube, int bits)
{
    const size_t pixels = image.samples.size() / 3;
    const double top = std::ldexp(1.0, bits) - 1;
    const double scale = cube.side > 0 ? top / cube.side : 0;
    ScaledImage result{image.width, bits, std::vector<uint16_t>(3 * pixels)};
    for (size_t i = 0; i < pixels; ++i)
        for (size_t c = 0; c < 3; ++c) {
            const double level = (double{image.samples[3 * i + c]} - cube.low[c]) * scale;
            result.planes[c * pixels + i] = static_cast<uint16_t>(std::clamp(std::round(level), 0.0, top));
        }
    return result;
}

FloatImage unscaled(const ScaledImage& image, const Cube& cube)
{
    const size_t pixels = image.planes.size() / 3;
    const double step = cube.side / (std::ldexp(1.0, image.bits) - 1);
    FloatImage result{image.side, image.side, std::vector<float>(3 * pixels)};
    for (size_t i = 0; i < pixels; ++i)
        for (size_t c = 0; c < 3; ++c)
            result.samples[3 * i + c] = static_cast<float>(cube.low[c] + image.planes[c * pixels + i] * step);
    return result;
}

std::vector<uint8_t> withCube(const Cube& cube, const std::vector<uint8_t>& coded)
{
    std::vector<uint8_t> file(Cube::kBytes + coded.size());
    std::memcpy(file.data(), cube.low, sizeof cube.low);
    std::memcpy(file.data() + sizeof cube.low, &cube.side, sizeof cube.side);
    std::copy(coded.begin(), coded.end(), file.begin() + Cube::kBytes);
    return file;
}

Cube readCube(const std::vector<uint8_t>& file)
{
    Cube cube;
    std::memcpy(cube.low, file.data(), sizeof cube.low);
    std::memcpy(&cube.side, file.data() + sizeof cube.low, sizeof cube.side);
    return cube;
}

Scratch::Scratch()
{
    std::error_code failed;
    std::string pattern = (std::filesystem::temp_directory_path(failed) / "gimg-adapter-XXXXXX").string();
    // Where no folder can be made, the first file that is to be written there says so.
    if (::mkdtemp(pattern.data()) != nullptr) folder_ = pattern;
}

Scratch::~Scratch()
{
    std::error_code failed;
    if (!folder_.empty()) std::filesystem::remove_all(folder_, failed);
}

Result<std::string> runTool(const std::vector<std::string>& command)
{
    std::string printed;
    const Result<gimrd::Ended> ended =
        gimrd::runProgram(command, [&](const std::string& line) { printed += line + '\n'; });
    if (!ended) return ended.error();
    printed += ended->errors;
    if (ended->code == 0) return printed;
    while (!printed.empty() && printed.back() == '\n') printed.pop_back();
    return Error{ErrorKind::CodecFailure, command[0] + " ended with status " + std::to_string(ended->code) +
                                              ": " + printed.substr(printed.find_last_of('\n') + 1)};
}

std::vector<std::string> missingPrograms(const std::vector<std::string>& programs, const std::string& package)
{
    for (const std::string& program : programs)
        if (!onPath(program)) return {package};
    return {};
}

Result<std::vector<uint8_t>> readOutput(const std::string& path)
{
    std::optional<std::vector<uint8_t>> bytes = cli::readFile(path);
    if (!bytes) return Error{ErrorKind::CodecFailure, path + ": was not written"};
    return std::move(*bytes);
}

} // namespace gimg::adapter

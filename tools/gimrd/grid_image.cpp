#include "grid_image.h"

#include "../cli.h"

#include <bit>
#include <cmath>
#include <cstring>

namespace gimg::gimrd {
namespace {

static_assert(std::endian::native == std::endian::little, "floats are copied as they are");

// n for 3 n^2 floats; 0 for any other size.
int sideOf(std::uintmax_t bytes)
{
    const auto n = static_cast<int>(std::lround(std::sqrt(static_cast<double>(bytes / (3 * sizeof(float))))));
    return n >= 2 && n <= 32768 && bytes == std::uintmax_t{3} * n * n * sizeof(float) ? n : 0;
}

} // namespace

bool isGridImage(const std::filesystem::path& path) { return path.extension() == ".f32"; }

int gridImageSide(const std::filesystem::path& path)
{
    std::error_code failed;
    const std::uintmax_t size = std::filesystem::file_size(path, failed);
    return failed ? 0 : sideOf(size);
}

Result<FloatImage> readGridImage(const std::filesystem::path& path)
{
    const std::optional<std::vector<uint8_t>> bytes = cli::readFile(path.string());
    if (!bytes) return Error{ErrorKind::FileNotReadable, path.string() + ": cannot be read"};
    const int n = sideOf(bytes->size());
    if (n == 0) return Error{ErrorKind::FileCorrupt, path.string() + ": is not 3 n^2 floats"};
    const size_t pixels = size_t{1} * n * n;
    std::vector<float> planar(3 * pixels);
    std::memcpy(planar.data(), bytes->data(), bytes->size());
    FloatImage image{n, n, std::vector<float>(3 * pixels)};
    for (size_t i = 0; i < pixels; ++i)
        for (size_t c = 0; c < 3; ++c) {
            const float value = planar[c * pixels + i];
            if (!std::isfinite(value))
                return Error{ErrorKind::NotFinite,
                             path.string() + ": sample " + std::to_string(i) + " is not finite"};
            image.samples[3 * i + c] = value;
        }
    return image;
}

Status writeGridImage(const FloatImage& image, const std::filesystem::path& path)
{
    const size_t pixels = image.samples.size() / 3;
    std::vector<float> planar(image.samples.size());
    for (size_t i = 0; i < pixels; ++i)
        for (size_t c = 0; c < 3; ++c) planar[c * pixels + i] = image.samples[3 * i + c];
    if (!cli::writeFile(path.string(), planar.data(), planar.size() * sizeof(float)))
        return Error{ErrorKind::FileNotWritable, path.string() + ": cannot be written"};
    return Done{};
}

Mesh openGridMesh(const FloatImage& image)
{
    Mesh mesh;
    for (int j = 0; j < image.height; ++j)
        for (int i = 0; i < image.width; ++i)
            mesh.positions.emplace_back(image.at(i, j, 0), image.at(i, j, 1), image.at(i, j, 2));
    for (int j = 0; j + 1 < image.height; ++j)
        for (int i = 0; i + 1 < image.width; ++i) {
            const int a = j * image.width + i, b = a + 1, c = a + image.width, d = c + 1;
            mesh.faces.push_back({a, b, d});
            mesh.faces.push_back({a, d, c});
        }
    return mesh;
}

} // namespace gimg::gimrd

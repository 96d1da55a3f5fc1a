#include "triangulate.h"

#include <cstddef>

namespace gimg::codec {

namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;

double squaredDistance(const float* a, const float* b)
{
    const double x = static_cast<double>(a[0]) - static_cast<double>(b[0]);
    const double y = static_cast<double>(a[1]) - static_cast<double>(b[1]);
    const double z = static_cast<double>(a[2]) - static_cast<double>(b[2]);
    return x * x + y * y + z * z;
}

enum class Diagonal
{
    Rising,  ///< from (i, j) to (i + 1, j + 1)
    Falling, ///< from (i + 1, j) to (i, j + 1)
    Shorter,
};

// Corner cells use the square's corner. Along the sides the diagonals lean forward, counter-clockwise.
Diagonal diagonalOfCell(std::uint32_t cells, std::uint32_t i, std::uint32_t j)
{
    const std::uint32_t last = cells - 1;
    const bool left = i == 0, right = i == last, bottom = j == 0, top = j == last;
    if ((left && bottom) || (right && top)) return Diagonal::Rising;
    if ((right && bottom) || (left && top)) return Diagonal::Falling;
    if (bottom || top) return Diagonal::Rising;
    if (left || right) return Diagonal::Falling;
    return Diagonal::Shorter;
}

} // namespace

std::uint32_t countClasses(const std::uint32_t* classes, std::uint32_t size)
{
    std::uint32_t count = 0;
    for (std::uint32_t k = 0; k < size; ++k)
        if (classes[k] == k) ++count;
    return count;
}

std::uint32_t numberVertices(std::uint32_t grid, std::uint32_t stride, std::uint32_t fineGrid,
                             const std::uint32_t* classes, std::uint32_t* scratch,
                             std::uint32_t* vertexOfSample, std::uint32_t* sampleOfVertex)
{
    std::uint32_t* vertexOfClass = scratch;
    for (std::uint32_t k = 0; k < borderSize(grid); ++k) vertexOfClass[k] = kNone;
    std::uint32_t vertices = 0;
    for (std::uint32_t j = 0; j < grid; ++j)
        for (std::uint32_t i = 0; i < grid; ++i) {
            std::uint32_t vertex = vertices;
            if (classes != nullptr && onBorder(grid, i, j)) {
                std::uint32_t& known = vertexOfClass[classes[borderPosition(grid, i, j)]];
                if (known == kNone) known = vertices;
                vertex = known;
            }
            vertexOfSample[j * grid + i] = vertex;
            if (vertex != vertices) continue;
            if (sampleOfVertex != nullptr) sampleOfVertex[vertices] = j * stride * fineGrid + i * stride;
            ++vertices;
        }
    return vertices;
}

void triangulate(std::uint32_t grid, std::uint32_t stride, std::uint32_t fineGrid, const float* xyz,
                 const std::uint32_t* vertexOfSample, std::uint32_t* triangles)
{
    const std::uint32_t cells = grid - 1;
    const auto position = [&](std::uint32_t i, std::uint32_t j) {
        return xyz + 3 * (std::size_t{j} * stride * fineGrid + std::size_t{i} * stride);
    };
    for (std::uint32_t j = 0; j < cells; ++j)
        for (std::uint32_t i = 0; i < cells; ++i) {
            Diagonal diagonal = diagonalOfCell(cells, i, j);
            if (diagonal == Diagonal::Shorter) {
                const double rising = squaredDistance(position(i, j), position(i + 1, j + 1));
                const double falling = squaredDistance(position(i + 1, j), position(i, j + 1));
                diagonal = rising <= falling ? Diagonal::Rising : Diagonal::Falling;
            }
            const std::uint32_t* row = vertexOfSample + j * grid + i;
            const std::uint32_t a = row[0], b = row[1], c = row[grid + 1], d = row[grid];
            const bool rising = diagonal == Diagonal::Rising;
            *triangles++ = a;
            *triangles++ = b;
            *triangles++ = rising ? c : d;
            *triangles++ = rising ? a : b;
            *triangles++ = c;
            *triangles++ = d;
        }
}

} // namespace gimg::codec

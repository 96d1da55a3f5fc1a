#include "surface_normals.h"

#include <cmath>
#include <cstring>

namespace gimg::codec {

namespace {

constexpr std::size_t kAxes = 3;

/// Twice the area vectors of a row of cells. Whatever the floats are, doubles hold them and their squares.
/// @param a, b  its samples below and above, `step` floats apart
void crossDiagonals(const float* a, const float* b, std::size_t step, std::uint32_t cells, double* vectors)
{
    for (std::uint32_t i = 0; i < cells; ++i, a += step, b += step, vectors += kAxes) {
        double d[kAxes], e[kAxes];
        for (std::size_t c = 0; c < kAxes; ++c) {
            d[c] = static_cast<double>(b[step + c]) - static_cast<double>(a[c]);
            e[c] = static_cast<double>(b[c]) - static_cast<double>(a[step + c]);
        }
        vectors[0] = d[1] * e[2] - d[2] * e[1];
        vectors[1] = d[2] * e[0] - d[0] * e[2];
        vectors[2] = d[0] * e[1] - d[1] * e[0];
    }
}

void putUnit(const double* vector, float* out)
{
    const double squared = vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2];
    if (!(squared > 0)) {
        out[0] = out[1] = 0;
        out[2] = 1;
        return;
    }
    const double inverse = 1.0 / std::sqrt(squared);
    for (std::size_t c = 0; c < kAxes; ++c) out[c] = static_cast<float>(vector[c] * inverse);
}

} // namespace

void estimateNormals(std::uint32_t grid, std::uint32_t stride, std::uint32_t fineGrid, const float* xyz,
                     const std::uint32_t* classes, double* scratch, float* normals)
{
    const std::uint32_t last = grid - 1;
    const std::size_t step = kAxes * stride, row = step * fineGrid, width = kAxes * (std::size_t{grid} + 1);
    // Two rows of cells, each between two without area; and the sums on the border.
    double *below = scratch, *above = scratch + width, *const border = scratch + 2 * width;
    std::memset(scratch, 0, 2 * width * sizeof *scratch);
    for (std::uint32_t j = 0; j < grid; ++j) {
        if (j < last)
            crossDiagonals(xyz + j * row, xyz + (j + 1) * row, step, last, above + kAxes);
        else
            std::memset(above, 0, width * sizeof *above);
        float* out = normals + j * row;
        for (std::uint32_t i = 0; i < grid; ++i, out += step) {
            double sum[kAxes];
            for (std::size_t c = 0; c < kAxes; ++c) {
                const std::size_t west = kAxes * i + c, east = west + kAxes;
                sum[c] = (below[west] + below[east]) + (above[west] + above[east]);
            }
            if (onBorder(grid, i, j))
                std::memcpy(border + kAxes * borderPosition(grid, i, j), sum, sizeof sum);
            else
                putUnit(sum, out);
        }
        double* const done = below;
        below = above;
        above = done;
    }

    // A class's smallest position comes first, so its sum is whole before it is asked for.
    const std::uint32_t positions = borderSize(grid);
    const auto classOf = [classes](std::uint32_t p) { return classes == nullptr ? p : classes[p]; };
    for (std::uint32_t p = 0; p < positions; ++p)
        if (classOf(p) != p)
            for (std::size_t c = 0; c < kAxes; ++c) border[kAxes * classOf(p) + c] += border[kAxes * p + c];
    for (std::uint32_t p = 0; p < positions; ++p) {
        const GridPoint at = borderPoint(grid, p);
        putUnit(border + kAxes * classOf(p), normals + at.j * row + at.i * step);
    }
}

} // namespace gimg::codec

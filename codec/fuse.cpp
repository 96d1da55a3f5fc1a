#include "fuse.h"

#include <cstddef>

namespace gimg::codec {

namespace {

// Displacements one ring further in: each the mean of its neighbours along the border, weighted 1 2 1.
void smoothAlongBorder(const double* from, double* to, std::uint32_t size)
{
    for (std::uint32_t k = 0; k < size; ++k) {
        const double before = from[k == 0 ? size - 1 : k - 1];
        const double after = from[k + 1 == size ? 0 : k + 1];
        to[k] = (before + after) * 0.25 + from[k] * 0.5;
    }
}

// Adds weight * displacement to the ring of samples `r` steps inside the border. A ring's corner has two
// feet on the border, and takes the mean.
void displaceRing(double* samples, std::uint32_t grid, std::uint32_t r, double weight,
                  const double* displacement)
{
    const std::uint32_t last = grid - 1;
    const std::size_t pitch = grid;
    const double* bottom = displacement;
    const double* right = displacement + last;
    const double* top = displacement + 2 * std::size_t{last};  // indexed by last - i
    const double* left = displacement + 3 * std::size_t{last}; // indexed by last - j
    const std::uint32_t far = last - r;
    for (std::uint32_t k = r + 1; k < far; ++k) {
        samples[r * pitch + k] += weight * bottom[k];
        samples[k * pitch + far] += weight * right[k];
        samples[far * pitch + k] += weight * top[last - k];
        samples[k * pitch + r] += weight * left[last - k];
    }
    samples[r * pitch + r] += weight * ((bottom[r] + left[far]) * 0.5);
    samples[r * pitch + far] += weight * ((bottom[far] + right[r]) * 0.5);
    samples[far * pitch + far] += weight * ((right[far] + top[r]) * 0.5);
    samples[far * pitch + r] += weight * ((top[far] + left[r]) * 0.5);
}

} // namespace

void fuseBorder(double* samples, std::uint32_t grid, const std::uint32_t* classes, bool diffuse,
                double* scratch)
{
    const std::uint32_t size = borderSize(grid);
    double* sum = scratch;
    double* members = scratch + size;
    for (std::uint32_t k = 0; k < size; ++k) sum[k] = members[k] = 0;
    for (std::uint32_t k = 0; k < size; ++k) {
        sum[classes[k]] += samples[borderSample(grid, k)];
        members[classes[k]] += 1;
    }
    for (std::uint32_t k = 0; k < size; ++k)
        if (classes[k] == k) sum[k] = sum[k] / members[k];

    double* displacement = members;
    for (std::uint32_t k = 0; k < size; ++k) {
        double& sample = samples[borderSample(grid, k)];
        const double fused = sum[classes[k]];
        displacement[k] = fused - sample;
        sample = fused;
    }
    if (!diffuse) return;

    const std::uint32_t rings = (grid - 1) / 2 < kDiffusionRings ? (grid - 1) / 2 : kDiffusionRings;
    double* smoothed = sum;
    for (std::uint32_t r = 1; r < rings; ++r) {
        smoothAlongBorder(displacement, smoothed, size);
        const double rest = 1.0 - static_cast<double>(r) / static_cast<double>(rings);
        displaceRing(samples, grid, r, rest * rest, smoothed);
        double* swap = displacement;
        displacement = smoothed;
        smoothed = swap;
    }
}

} // namespace gimg::codec

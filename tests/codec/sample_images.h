#pragma once

#include "codec/encode.h"
#include "gim.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <vector>

/// Images and seams that the codec's tests share.
namespace gimg::codec::samples {

/// The word a b a' b' c d c' d' .. of a closed surface; a a' for genus 0. Path 0 takes the remainder.
inline Seam closedSeam(unsigned genus, std::uint32_t lowest, std::uint32_t start = 0)
{
    Seam seam{lowest, start, {}};
    const std::uint32_t half = 2 * (lowest - 1), paths = genus == 0 ? 1 : 2 * genus;
    const std::uint32_t each = half / paths, first = half - each * (paths - 1);
    const auto side = [&](std::uint32_t path, gim_side_kind kind) {
        seam.sides.push_back({path, path == 0 ? first : each, static_cast<std::uint32_t>(kind)});
    };
    for (std::uint32_t path = 0; path < paths; path += 2) {
        side(path, GIM_SIDE_FIRST);
        if (genus > 0) side(path + 1, GIM_SIDE_FIRST);
        side(path, GIM_SIDE_MATE);
        if (genus > 0) side(path + 1, GIM_SIDE_MATE);
    }
    return seam;
}

/// The torus a b a' b' with one side of the square each.
inline Seam torusSeam(std::uint32_t lowest)
{
    const std::uint32_t side = lowest - 1;
    return {lowest,
            0,
            {{0, side, GIM_SIDE_FIRST},
             {1, side, GIM_SIDE_FIRST},
             {0, side, GIM_SIDE_MATE},
             {1, side, GIM_SIDE_MATE}}};
}

/// An open disk: the whole border is boundary.
inline Seam diskSeam(std::uint32_t lowest) { return {lowest, 0, {{0, 4 * (lowest - 1), GIM_SIDE_BOUNDARY}}}; }

/// A torus of radii 3 and 1 about `centre`; its glued samples are equal to the bit.
inline std::vector<float> torusImage(std::uint32_t grid, double centre = 0)
{
    std::vector<float> xyz;
    const auto angle = [&](std::uint32_t k) { return 2 * std::numbers::pi * (k % (grid - 1)) / (grid - 1); };
    for (std::uint32_t j = 0; j < grid; ++j)
        for (std::uint32_t i = 0; i < grid; ++i) {
            const double u = angle(i), v = angle(j);
            for (const double value :
                 {(3 + std::cos(v)) * std::cos(u), (3 + std::cos(v)) * std::sin(u), std::sin(v)})
                xyz.push_back(static_cast<float>(centre + value));
        }
    return xyz;
}

inline std::vector<float> torusNormals(std::uint32_t grid)
{
    std::vector<float> normals;
    const auto angle = [&](std::uint32_t k) { return 2 * std::numbers::pi * (k % (grid - 1)) / (grid - 1); };
    for (std::uint32_t j = 0; j < grid; ++j)
        for (std::uint32_t i = 0; i < grid; ++i) {
            const double u = angle(i), v = angle(j);
            for (const double value : {std::cos(v) * std::cos(u), std::cos(v) * std::sin(u), std::sin(v)})
                normals.push_back(static_cast<float>(value));
        }
    return normals;
}

/// Integers from a fixed recurrence, the same on every platform.
class Dice
{
public:
    explicit Dice(std::uint64_t seed) : state_(seed) {}
    std::uint32_t next()
    {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return static_cast<std::uint32_t>(state_ >> 33);
    }
    std::uint32_t below(std::uint32_t limit) { return next() % limit; }
    double unit() { return next() / 2147483648.0; }

private:
    std::uint64_t state_;
};

/// Smooth but for a little noise; made with + - * / only.
inline std::vector<float> bumpyImage(std::uint32_t grid, std::uint64_t seed)
{
    Dice dice(seed);
    double a[9];
    for (double& value : a) value = dice.unit() * 4 - 2;
    std::vector<float> xyz;
    for (std::uint32_t j = 0; j < grid; ++j)
        for (std::uint32_t i = 0; i < grid; ++i) {
            const double s = i / (grid - 1.0), t = j / (grid - 1.0);
            for (int c = 0; c < 3; ++c) {
                const double* p = a + 3 * c;
                const double smooth = p[0] * s + p[1] * t * (1 - t) +
                                      p[2] / (1 + 8 * (s - 0.4) * (s - 0.4) + 6 * (t - 0.6) * (t - 0.6));
                xyz.push_back(static_cast<float>(smooth + 0.002 * dice.unit()));
            }
        }
    return xyz;
}

/// Finite floats of any bits, with zeros of both signs now and then.
inline std::vector<float> wildImage(std::uint32_t grid, std::uint64_t seed)
{
    Dice dice(seed);
    std::vector<float> xyz;
    while (xyz.size() < 3 * std::size_t{grid} * grid) {
        std::uint32_t bits = dice.next() << 16 ^ dice.next();
        if (dice.below(8) == 0) bits &= 0x80000000u;
        if (dice.below(8) == 0) bits &= 0x807FFFFFu;
        const float value = std::bit_cast<float>(bits);
        if (std::isfinite(value)) xyz.push_back(value);
    }
    return xyz;
}

inline std::vector<std::uint8_t> encoded(const Source& source, const Settings& settings)
{
    auto prepared = Encoder::prepare(source);
    if (const auto* error = std::get_if<EncodeError>(&prepared)) throw std::runtime_error(error->message);
    auto file = std::get<Encoder>(prepared).encode(settings);
    if (const auto* error = std::get_if<EncodeError>(&file)) throw std::runtime_error(error->message);
    return std::get<EncodedFile>(file).bytes;
}

inline gim_info probed(const std::vector<std::uint8_t>& bytes)
{
    gim_info info{};
    info.size = sizeof info;
    const gim_status status = gim_probe(bytes.data(), bytes.size(), nullptr, &info);
    if (status != GIM_OK) throw std::runtime_error(gim_status_text(status));
    return info;
}

inline std::vector<float> decoded(const std::vector<std::uint8_t>& bytes, std::uint32_t flags = 0,
                                  bool normals = false)
{
    const gim_info info = probed(bytes);
    const std::uint32_t grid = normals ? info.normal_grid : info.grid;
    std::vector<unsigned char> workspace(gim_workspace_size(&info));
    std::vector<float> out(3 * std::size_t{grid} * grid);
    const gim_status status = (normals ? gim_decode_normals : gim_decode_geometry)(
        bytes.data(), bytes.size(), nullptr, flags, workspace.data(), workspace.size(), out.data());
    if (status != GIM_OK) throw std::runtime_error(gim_status_text(status));
    return out;
}

/// Root mean square of the 3D distance between corresponding samples.
inline double rmsDistance(const std::vector<float>& a, const std::vector<float>& b)
{
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += (double{a[k]} - b[k]) * (double{a[k]} - b[k]);
    return std::sqrt(sum / (static_cast<double>(a.size()) / 3));
}

} // namespace gimg::codec::samples

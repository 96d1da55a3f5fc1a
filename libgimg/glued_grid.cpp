#include "glued_grid.h"

#include "codec/border.h"
#include "codec/seam.h"
#include "codec/triangulate.h"
#include "gimg/border.h"

#include <cmath>
#include <string>

namespace gimg {
namespace {

constexpr std::array<int, 4> kNothingAround = {GluedGrid::kNone, GluedGrid::kNone, GluedGrid::kNone,
                                               GluedGrid::kNone};

} // namespace

std::optional<Error> objectionToImage(const FloatImage& image)
{
    if (image.width != image.height || image.width < 0 ||
        image.samples.size() != size_t{3} * image.width * image.height)
        return Error{ErrorKind::BadArgument, "the image is not square, or its samples do not fit"};
    for (size_t k = 0; k < image.samples.size(); ++k)
        if (!std::isfinite(image.samples[k]))
            return Error{ErrorKind::NotFinite, "sample " + std::to_string(k / 3) + " is not finite"};
    return std::nullopt;
}

Result<GluedGrid> GluedGrid::of(const GridSeam& seam, int n)
{
    if (seam.lowest < 0 || seam.start < 0)
        return Error{ErrorKind::BadArgument, "the seam's numbers are negative"};
    const codec::Seam word{static_cast<uint32_t>(seam.lowest), static_cast<uint32_t>(seam.start), seam.sides};
    if (const std::string fault = codec::seamFault(word); !fault.empty())
        return Error{ErrorKind::BadArgument, "seam: " + fault};
    if (n < seam.lowest || n > BorderOptions::kLargestGrid || ((n - 1) & (n - 2)) != 0)
        return Error{ErrorKind::BadArgument, "a grid of " + std::to_string(n) +
                                                 " samples a side is no refinement of the lowest level, " +
                                                 std::to_string(seam.lowest)};
    GluedGrid grid;
    grid.n_ = n;
    const auto size = static_cast<uint32_t>(n);
    const std::vector<uint32_t> classes = codec::borderClasses(word, size);
    std::vector<uint32_t> scratch(classes.size());
    grid.vertexOf_.resize(size_t{size} * size);
    grid.sampleOf_.resize(size_t{size} * size);
    grid.sampleOf_.resize(codec::numberVertices(size, 1, size, classes.data(), scratch.data(),
                                                grid.vertexOf_.data(), grid.sampleOf_.data()));
    grid.findBoundary(seam);
    grid.findNeighbours(classes);
    return grid;
}

void GluedGrid::findBoundary(const GridSeam& seam)
{
    onBoundary_.assign(sampleOf_.size(), 0);
    const auto size = static_cast<uint32_t>(n_);
    const uint32_t total = codec::borderSize(size),
                   unit = (size - 1) / (static_cast<uint32_t>(seam.lowest) - 1);
    uint32_t at = static_cast<uint32_t>(seam.start) * unit % total;
    for (const gim_side& side : seam.sides) {
        const uint32_t length = side.length * unit;
        for (uint32_t k = 0; k <= length && side.kind == GIM_SIDE_BOUNDARY; ++k)
            onBoundary_[vertexOf_[codec::borderSample(size, (at + k) % total)]] = 1;
        at = (at + length) % total;
    }
}

void GluedGrid::findNeighbours(const std::vector<uint32_t>& classes)
{
    around_.assign(sampleOf_.size(), kNothingAround);
    const int n = n_, last = n - 1;
    const auto vertex = [&](int i, int j) { return static_cast<int>(vertexOf_[j * n + i]); };
    for (int j = 1; j < last; ++j)
        for (int i = 1; i < last; ++i)
            around_[vertex(i, j)] = {vertex(i - 1, j), vertex(i + 1, j), vertex(i, j - 1), vertex(i, j + 1)};

    const auto size = static_cast<uint32_t>(n), total = codec::borderSize(size);
    std::vector<uint32_t> count(total, 0);
    for (const uint32_t c : classes) ++count[c];
    const auto border = [&](uint32_t position) {
        return static_cast<int>(vertexOf_[codec::borderSample(size, position % total)]);
    };
    const auto inner = [&](uint32_t position) {
        const auto [i, j] = codec::borderPoint(size, position);
        const auto inwards = [&](uint32_t k) {
            return static_cast<int>(k == 0 ? 1 : k == size - 1 ? k - 1 : k);
        };
        return vertex(inwards(i), inwards(j));
    };
    for (uint32_t position = 0; position < total; ++position) {
        const uint32_t mate = classes[position];
        if (mate == position || count[mate] != 2) continue;
        if (position % (size - 1) == 0 || mate % (size - 1) == 0) continue;
        const int before = border(position + total - 1), after = border(position + 1);
        // Mates run against each other; at a cut-node they part.
        if (before != border(mate + 1) || after != border(mate + total - 1)) continue;
        around_[border(position)] = {before, after, inner(position), inner(mate)};
    }
    for (size_t v = 0; v < around_.size(); ++v)
        if (onBoundary_[v] != 0) around_[v] = kNothingAround;
}

std::vector<Vec3> GluedGrid::positions(std::span<const float> samples) const
{
    std::vector<Vec3> out;
    out.reserve(sampleOf_.size());
    for (const uint32_t sample : sampleOf_) {
        const size_t at = size_t{3} * sample;
        out.emplace_back(samples[at], samples[at + 1], samples[at + 2]);
    }
    return out;
}

std::vector<Triangle> GluedGrid::faces(const FloatImage& image) const
{
    const auto size = static_cast<uint32_t>(n_);
    std::vector<uint32_t> corners(size_t{6} * (size - 1) * (size - 1));
    codec::triangulate(size, 1, size, image.samples.data(), vertexOf_.data(), corners.data());
    std::vector<Triangle> faces;
    faces.reserve(corners.size() / 3);
    for (size_t k = 0; k < corners.size(); k += 3)
        faces.push_back({static_cast<int>(corners[k]), static_cast<int>(corners[k + 1]),
                         static_cast<int>(corners[k + 2])});
    return faces;
}

} // namespace gimg

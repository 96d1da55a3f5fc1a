#include "seam.h"

#include "border.h"
#include "image_header.h"
#include "range_encoder.h"
#include "seam_code.h"

#include <algorithm>

namespace gimg::codec {

namespace {

SeamView viewOf(const Seam& seam)
{
    return {seam.sides.data(), static_cast<std::uint32_t>(seam.sides.size()), seam.start, seam.lowest};
}

bool isGridSize(std::uint32_t n)
{
    return n >= 3 && n <= (1u << kLargestExponent) + 1 && ((n - 1) & (n - 2)) == 0;
}

bool hasRepetition(std::vector<std::uint64_t>& keys)
{
    std::sort(keys.begin(), keys.end());
    return std::adjacent_find(keys.begin(), keys.end()) != keys.end();
}

std::uint64_t pairKey(std::uint64_t a, std::uint64_t b) { return a << 32 | b; }

} // namespace

std::string seamFault(const Seam& seam)
{
    if (!isGridSize(seam.lowest)) return "the lowest grid is not 2^l + 1 samples a side with l in 1..12";
    const std::uint32_t total = borderSize(seam.lowest);
    if (seam.start >= total) return "the seam's start is not on the border";
    std::uint64_t used = 0;
    std::vector<std::uint32_t> lengthOfOpen; // by path; 0: not open
    for (std::size_t s = 0; s < seam.sides.size(); ++s) {
        const gim_side& side = seam.sides[s];
        const std::string name = "side " + std::to_string(s);
        if (side.length == 0) return name + " has no length";
        if (side.kind > GIM_SIDE_MATE) return name + " is of no known kind";
        if (side.kind == GIM_SIDE_MATE) {
            if (side.path >= lengthOfOpen.size() || lengthOfOpen[side.path] == 0)
                return name + " is the mate of a path that is not open";
            if (lengthOfOpen[side.path] != side.length) return name + " differs in length from its mate";
            lengthOfOpen[side.path] = 0;
        } else {
            if (side.path != lengthOfOpen.size()) return name + " breaks the numbering by first occurrence";
            lengthOfOpen.push_back(side.kind == GIM_SIDE_FIRST ? side.length : 0);
        }
        used += side.length;
    }
    if (used != total)
        return "the sides are " + std::to_string(used) + " long, the border " + std::to_string(total);
    if (std::any_of(lengthOfOpen.begin(), lengthOfOpen.end(),
                    [](std::uint32_t length) { return length != 0; }))
        return "a path has no mate";
    return {};
}

std::vector<std::uint32_t> borderClasses(const Seam& seam, std::uint32_t grid)
{
    std::vector<std::uint32_t> first(seam.sides.size()), classes(borderSize(grid));
    borderClasses(viewOf(seam), grid, first.data(), classes.data());
    return classes;
}

SeamTopology topologyOf(const Seam& seam)
{
    std::vector<std::uint32_t> scratch(2 * seam.sides.size());
    const Topology topology = seamTopology(viewOf(seam), scratch.data());
    return {topology.genus, topology.loops, topology.cutNodes, topology.paths};
}

// Samples inside the grid are glued to nothing, so only edges with an end on the border can coincide:
// the border's own, and those that lead to the ring inside it.
bool seamIsSimplicial(const gim_side* sides, std::uint32_t count, std::uint32_t start, std::uint32_t lowest,
                      std::uint32_t grid)
{
    const std::uint32_t size = borderSize(grid), last = grid - 1, unit = last / (lowest - 1);
    std::vector<std::uint32_t> first(count), classes(size);
    borderClasses({sides, count, start, lowest}, grid, first.data(), classes.data());

    std::vector<std::uint64_t> keys;
    keys.reserve(3 * std::size_t{size});
    std::uint32_t at = start * unit % size;
    for (std::uint32_t s = 0; s < count; ++s) {
        const std::uint32_t length = sides[s].length * unit;
        for (std::uint32_t k = 0; k < length && sides[s].kind != GIM_SIDE_MATE; ++k) {
            const std::uint32_t a = classes[(at + k) % size], b = classes[(at + k + 1) % size];
            if (a == b) return false;
            keys.push_back(pairKey(std::min(a, b), std::max(a, b)));
        }
        at = (at + length) % size;
    }
    if (hasRepetition(keys)) return false;

    // From each border position inwards, and forward along the fixed diagonal; a corner of the square has
    // its diagonal only. Those of the cells beside a corner meet in the same sample of the inner ring.
    keys.clear();
    const auto toInside = [&](std::uint32_t position, std::uint32_t i, std::uint32_t j) {
        keys.push_back(pairKey(std::uint64_t{j} * grid + i, classes[position]));
    };
    for (std::uint32_t side = 0; side < 4; ++side) {
        // (u, v): along the side and away from it.
        const auto inner = [&](std::uint32_t position, std::uint32_t u) {
            switch (side) {
            case 0:
                return toInside(position, u, 1);
            case 1:
                return toInside(position, last - 1, u);
            case 2:
                return toInside(position, last - u, last - 1);
            default:
                return toInside(position, 1, last - u);
            }
        };
        inner(side * last, 1);
        for (std::uint32_t u = 1; u < last; ++u) {
            inner(side * last + u, u);
            if (u + 1 < last) inner(side * last + u, u + 1);
        }
    }
    return !hasRepetition(keys);
}

std::vector<std::uint8_t> encodeSeam(const Seam& seam)
{
    RangeEncoder encoder;
    SeamView view = viewOf(seam);
    std::vector<gim_side> sides = seam.sides;
    std::vector<std::uint32_t> open(sides.size());
    codeSeam(encoder, view, sides.data(), view.count, open.data());
    return encoder.finish();
}

} // namespace gimg::codec

#include "border.h"

namespace gimg::codec {

namespace {

// Union-find whose root is always the smallest member, with path halving.
std::uint32_t findRoot(std::uint32_t* parent, std::uint32_t k)
{
    while (parent[k] != k) {
        parent[k] = parent[parent[k]];
        k = parent[k];
    }
    return k;
}

void unite(std::uint32_t* parent, std::uint32_t a, std::uint32_t b)
{
    const std::uint32_t rootA = findRoot(parent, a), rootB = findRoot(parent, b);
    if (rootA < rootB)
        parent[rootB] = rootA;
    else
        parent[rootA] = rootB;
}

} // namespace

void borderClasses(const SeamView& seam, std::uint32_t grid, std::uint32_t* first, std::uint32_t* out)
{
    const std::uint32_t size = borderSize(grid);
    const std::uint32_t unit = (grid - 1) / (seam.lowest - 1);
    for (std::uint32_t k = 0; k < size; ++k) out[k] = k;
    std::uint32_t at = seam.start * unit;
    for (std::uint32_t s = 0; s < seam.count; ++s) {
        const gim_side& side = seam.sides[s];
        const std::uint32_t length = side.length * unit;
        if (side.kind == GIM_SIDE_FIRST) first[side.path] = at;
        if (side.kind == GIM_SIDE_MATE) {
            const std::uint32_t begin = first[side.path];
            for (std::uint32_t k = 0; k <= length; ++k)
                unite(out, (begin + k) % size, (at + length - k) % size);
        }
        at = (at + length) % size;
    }
    for (std::uint32_t k = 0; k < size; ++k) out[k] = findRoot(out, k);
}

// Side s has the corner s at its beginning. Gluing side s to its mate m (reversed) glues the beginning
// of s to the end of m, so turning about a cut-node leads from corner s to corner m + 1.
Topology seamTopology(const SeamView& seam, std::uint32_t* scratch)
{
    const std::uint32_t count = seam.count;
    std::uint32_t* mate = scratch;
    std::uint32_t* firstOf = scratch + count;
    Topology topology;
    for (std::uint32_t s = 0; s < count; ++s) {
        const gim_side& side = seam.sides[s];
        mate[s] = s;
        if (side.kind != GIM_SIDE_MATE) ++topology.paths;
        if (side.kind == GIM_SIDE_FIRST) firstOf[side.path] = s;
        if (side.kind == GIM_SIDE_MATE) {
            mate[s] = firstOf[side.path];
            mate[mate[s]] = s;
        }
    }

    const auto isBoundary = [&](std::uint32_t s) { return seam.sides[s].kind == GIM_SIDE_BOUNDARY; };
    const auto after = [&](std::uint32_t s) { return s + 1 < count ? s + 1 : 0; };
    std::uint32_t* visited = firstOf; // its entries are used up
    for (std::uint32_t s = 0; s < count; ++s) visited[s] = 0;

    // Boundary loops: at the end of a boundary side, turn until the next boundary side begins. Each
    // turn passes all the corners of one boundary cut-node.
    for (std::uint32_t s = 0; s < count; ++s) {
        if (!isBoundary(s) || visited[s] != 0) continue;
        ++topology.loops;
        std::uint32_t side = s;
        do {
            ++topology.cutNodes;
            std::uint32_t corner = after(side);
            while (!isBoundary(corner)) {
                visited[corner] = 1;
                corner = after(mate[corner]);
            }
            visited[corner] = 1;
            side = corner;
        } while (side != s);
    }
    // The corners left over turn full circles about interior cut-nodes.
    for (std::uint32_t s = 0; s < count; ++s) {
        if (visited[s] != 0) continue;
        ++topology.cutNodes;
        for (std::uint32_t corner = s; visited[corner] == 0; corner = after(mate[corner]))
            visited[corner] = 1;
    }

    // chi = V - E + F = 2 - 2 genus - loops, where inner vertices and edges of the paths cancel.
    const std::int64_t chi = std::int64_t{topology.cutNodes} - topology.paths + 1;
    topology.genus = static_cast<std::uint32_t>((2 - chi - topology.loops) / 2);
    return topology;
}

} // namespace gimg::codec

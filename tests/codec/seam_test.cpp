#include "codec/border.h"
#include "codec/range_decoder.h"
#include "codec/seam.h"
#include "codec/seam_code.h"
#include "sample_images.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <set>

namespace gimg::codec {
namespace {

using samples::closedSeam;
using samples::Dice;

Seam decodedWord(const std::vector<std::uint8_t>& word, std::uint32_t lowest)
{
    std::vector<gim_side> sides(borderSize(lowest));
    std::vector<std::uint32_t> open(sides.size());
    RangeDecoder decoder({word.data(), word.size()});
    SeamView view;
    view.lowest = lowest;
    EXPECT_TRUE(codeSeam(decoder, view, sides.data(), static_cast<std::uint32_t>(sides.size()), open.data()));
    EXPECT_TRUE(decoder.finished());
    sides.resize(view.count);
    return {lowest, view.start, sides};
}

void expectRoundTrip(const Seam& seam, std::size_t most)
{
    ASSERT_EQ(seamFault(seam), "");
    const std::vector<std::uint8_t> word = encodeSeam(seam);
    EXPECT_LE(word.size(), most);
    const Seam again = decodedWord(word, seam.lowest);
    EXPECT_EQ(again.start, seam.start);
    ASSERT_EQ(again.sides.size(), seam.sides.size());
    for (std::size_t s = 0; s < seam.sides.size(); ++s) {
        EXPECT_EQ(again.sides[s].path, seam.sides[s].path) << s;
        EXPECT_EQ(again.sides[s].length, seam.sides[s].length) << s;
        EXPECT_EQ(again.sides[s].kind, seam.sides[s].kind) << s;
    }
}

/// Nested and crossing paths and boundary pieces at random, filling the border.
Seam randomSeam(std::uint32_t lowest, std::uint64_t seed, std::uint32_t longest)
{
    Dice dice(seed);
    Seam seam{lowest, dice.below(borderSize(lowest)), {}};
    std::vector<gim_side> open;
    std::uint32_t used = 0, reserved = 0, paths = 0;
    const std::uint32_t total = borderSize(lowest);
    while (used < total) {
        const std::uint32_t left = total - used - reserved;
        if (left == 0 || (!open.empty() && dice.below(2) == 0)) {
            const std::uint32_t k = dice.below(static_cast<std::uint32_t>(open.size()));
            gim_side mate = open[k];
            mate.kind = GIM_SIDE_MATE;
            open.erase(open.begin() + k);
            reserved -= mate.length;
            used += mate.length;
            seam.sides.push_back(mate);
            continue;
        }
        const bool boundary = left == 1 || dice.below(5) == 0;
        const std::uint32_t length = 1 + dice.below(std::min(longest, boundary ? left : left / 2));
        seam.sides.push_back({paths++, length, boundary ? 0u : 1u});
        used += length;
        if (!boundary) open.push_back(seam.sides.back()), reserved += length;
    }
    return seam;
}

TEST(SeamWord, RoundTripsOfEveryGenusTakeFewBytes)
{
    const std::size_t most[8] = {2, 5, 6, 7, 8, 9, 10, 9};
    for (unsigned genus = 0; genus < 8; ++genus)
        expectRoundTrip(closedSeam(genus, 65, 17 * genus), most[genus]);
}

TEST(SeamWord, ADozenUnequalPathsTakeTensOfBytes)
{
    std::size_t largest = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        const Seam seam = randomSeam(65, seed, 40);
        expectRoundTrip(seam, 2 * seam.sides.size() + 6);
        if (seam.sides.size() < 28) largest = std::max(largest, encodeSeam(seam).size());
    }
    EXPECT_LE(largest, 36u);
}

TEST(SeamWord, ThousandsOfSides)
{
    const Seam seam = randomSeam(1025, 5, 3);
    ASSERT_GT(seam.sides.size(), 2000u);
    expectRoundTrip(seam, 2 * seam.sides.size());
}

TEST(SeamWord, SmallestGrid)
{
    expectRoundTrip({3, 7, {{0, 4, GIM_SIDE_FIRST}, {0, 4, GIM_SIDE_MATE}}}, 2);
    expectRoundTrip({3, 0, {{0, 8, GIM_SIDE_BOUNDARY}}}, 2);
}

TEST(SeamFault, NamesTheSide)
{
    EXPECT_EQ(seamFault({5, 0, {{0, 8, 1}, {0, 7, 2}, {1, 1, 0}}}), "side 1 differs in length from its mate");
    EXPECT_EQ(seamFault({5, 0, {{0, 8, 1}, {1, 8, 1}}}), "a path has no mate");
    EXPECT_EQ(seamFault({5, 0, {{0, 17, 0}}}), "the sides are 17 long, the border 16");
    EXPECT_EQ(seamFault({5, 0, {{0, 8, 2}, {0, 8, 1}}}), "side 0 is the mate of a path that is not open");
    EXPECT_EQ(seamFault({5, 0, {{1, 8, 1}, {1, 8, 2}}}), "side 0 breaks the numbering by first occurrence");
    EXPECT_EQ(seamFault({5, 0, {{0, 0, 0}, {1, 16, 0}}}), "side 0 has no length");
    EXPECT_EQ(seamFault({5, 16, {{0, 16, 0}}}), "the seam's start is not on the border");
    EXPECT_NE(seamFault({6, 0, {{0, 20, 0}}}), "");
}

TEST(SeamTopology, ClosedWordsHaveTheirGenus)
{
    for (unsigned genus = 0; genus < 8; ++genus) {
        const SeamTopology topology = topologyOf(closedSeam(genus, 65));
        EXPECT_EQ(topology.genus, genus);
        EXPECT_EQ(topology.boundaryLoops, 0u);
        EXPECT_EQ(topology.cutNodes, genus == 0 ? 2u : 1u);
        EXPECT_EQ(topology.paths, genus == 0 ? 1 : 2 * genus);
    }
}

TEST(SeamTopology, BoundaryLoops)
{
    EXPECT_EQ(topologyOf(samples::diskSeam(5)).boundaryLoops, 1u);
    // An annulus: one cut joins its two boundaries.
    const SeamTopology annulus = topologyOf({5, 3, {{0, 4, 1}, {1, 4, 0}, {0, 4, 2}, {2, 4, 0}}});
    EXPECT_EQ(annulus.boundaryLoops, 2u);
    EXPECT_EQ(annulus.genus, 0u);
    // One boundary in two pieces with a slit between them.
    const SeamTopology slit = topologyOf({5, 0, {{0, 4, 0}, {1, 2, 1}, {1, 2, 2}, {2, 8, 0}}});
    EXPECT_EQ(slit.boundaryLoops, 1u);
    EXPECT_EQ(slit.genus, 0u);
    // A torus with a hole.
    const SeamTopology holed = topologyOf({5, 0, {{0, 3, 1}, {1, 3, 1}, {0, 3, 2}, {1, 3, 2}, {2, 4, 0}}});
    EXPECT_EQ(holed.boundaryLoops, 1u);
    EXPECT_EQ(holed.genus, 1u);
}

TEST(BorderClasses, MatesRunBackwards)
{
    // First over [2, 6], mate over [6, 10]: 2+k ~ 10-k.
    const Seam seam{5, 2, {{0, 4, 1}, {0, 4, 2}, {1, 8, 0}}};
    const std::vector<std::uint32_t> classes = borderClasses(seam, 5);
    for (std::uint32_t k = 0; k <= 4; ++k) EXPECT_EQ(classes[10 - k], 2 + k);
    EXPECT_EQ(classes[11], 11u);
    // Twice as fine, twice as many.
    EXPECT_EQ(borderClasses(seam, 9)[19], 5u);
}

TEST(BorderClasses, EulerNumberOfTheClassesIsThatOfTheWord)
{
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        const Seam seam = randomSeam(17, seed, 12);
        const SeamTopology topology = topologyOf(seam);
        const std::vector<std::uint32_t> classes = borderClasses(seam, 33);
        const std::set<std::uint32_t> vertices(classes.begin(), classes.end());
        int edges = 0;
        for (const gim_side& side : seam.sides)
            edges += side.kind == GIM_SIDE_MATE ? 0 : 2 * static_cast<int>(side.length);
        const int chi = static_cast<int>(vertices.size()) - edges + 1;
        EXPECT_EQ(chi, 2 - 2 * static_cast<int>(topology.genus) - static_cast<int>(topology.boundaryLoops))
            << seed;
    }
}

/// Counts edges of the decoder's own mesh, with interior diagonals as in a flat square.
bool meshIsSimplicial(const Seam& seam, std::uint32_t grid)
{
    Source source;
    source.grid = grid;
    source.seam = seam;
    std::vector<float> xyz;
    for (std::uint32_t j = 0; j < grid; ++j)
        for (std::uint32_t i = 0; i < grid; ++i)
            for (const std::uint32_t value : {i, j, 0u}) xyz.push_back(static_cast<float>(value));
    source.xyz = xyz;
    const auto bytes = samples::encoded(source, {GIM_CODING_RAW12, 0, 0});
    const gim_info info = samples::probed(bytes);
    std::vector<unsigned char> work(info.workspace);
    gim_mesh_counts counts{sizeof(gim_mesh_counts), 0, 0, 0};
    EXPECT_EQ(gim_mesh_size(bytes.data(), bytes.size(), nullptr, 0, 0, work.data(), work.size(), &counts),
              GIM_OK);
    std::vector<std::uint32_t> triangles(3 * std::size_t{counts.triangles});
    EXPECT_EQ(gim_build_mesh(bytes.data(), bytes.size(), nullptr, 0, 0, work.data(), work.size(), xyz.data(),
                             nullptr, nullptr, triangles.data()),
              GIM_OK);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (std::size_t k = 0; k < triangles.size(); ++k) {
        const std::uint32_t a = triangles[k], b = triangles[k % 3 == 2 ? k - 2 : k + 1];
        if (a == b) return false;
        ++edges[{std::min(a, b), std::max(a, b)}];
    }
    const SeamTopology topology = topologyOf(seam);
    const auto chi = static_cast<int>(counts.vertices) - static_cast<int>(edges.size()) +
                     static_cast<int>(counts.triangles);
    return chi == 2 - 2 * static_cast<int>(topology.genus) - static_cast<int>(topology.boundaryLoops);
}

bool simplicial(const Seam& seam, std::uint32_t grid)
{
    return seamIsSimplicial(seam.sides.data(), static_cast<std::uint32_t>(seam.sides.size()), seam.start,
                            seam.lowest, grid);
}

TEST(SeamIsSimplicial, AgreesWithCountingTheMeshsEdges)
{
    int yes = 0, no = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        const std::uint32_t lowest = seed % 4 == 0 ? 3 : seed % 4 == 1 ? 5 : 9;
        const Seam seam = randomSeam(lowest, seed, lowest);
        for (const std::uint32_t grid : {lowest, 2 * lowest - 1}) {
            const bool expected = meshIsSimplicial(seam, grid);
            EXPECT_EQ(simplicial(seam, grid), expected) << "seed " << seed << " grid " << grid;
            ++(expected ? yes : no);
        }
    }
    EXPECT_GT(yes, 100);
    EXPECT_GT(no, 100);
}

TEST(SeamIsSimplicial, KnownCases)
{
    EXPECT_TRUE(simplicial(samples::torusSeam(5), 5));
    EXPECT_FALSE(simplicial(samples::torusSeam(3), 3)); // the centre meets each glued midpoint twice
    EXPECT_TRUE(simplicial(samples::torusSeam(3), 5));
    EXPECT_TRUE(simplicial(samples::diskSeam(3), 3));
    // A path of length 1 whose ends are one cut-node is a loop.
    const Seam loop{9, 0, {{0, 1, 1}, {1, 15, 1}, {0, 1, 2}, {1, 15, 2}}};
    EXPECT_FALSE(simplicial(loop, 9));
    // Folding the border at the corner (0, 0) glues both outer edges of the corner cell.
    EXPECT_FALSE(simplicial({9, 16, {{0, 16, 1}, {0, 16, 2}}}, 9));
}

} // namespace
} // namespace gimg::codec

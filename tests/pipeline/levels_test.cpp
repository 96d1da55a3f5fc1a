#include "gimg/decode.h"
#include "gimg/encode.h"

#include "corpus/shapes.h"
#include "manifold_check.h"

#include <gtest/gtest.h>

namespace gimg {
namespace {

// The promise of no cracks: the mesh of every level, with one vertex a class of grid points, is a manifold of
// the input's genus and boundary loops.
class EveryLevel : public testing::TestWithParam<std::pair<int, int>>
{
};

TEST_P(EveryLevel, HasTheTopologyOfTheInput)
{
    const auto [genus, loops] = GetParam();
    const Mesh mesh = shapes::surfaceOfGenus(genus, loops, 5);
    EncodeOptions options;
    options.bytes = 4000;
    options.grid = genus < 7 ? 129 : 257;
    options.effort = 3; // refits move samples as slides do, and take longer
    const Result<EncodedMesh> encoded = encodeMesh(mesh, options);
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    EXPECT_EQ(encoded->topology.genus, genus);
    EXPECT_EQ(encoded->topology.boundaries, loops);
    const Result<DecodedImages> images = decodeImages(encoded->file);
    ASSERT_TRUE(images.ok());
    EXPECT_EQ(static_cast<int>(images->info.grid), encoded->grid);
    EXPECT_GE(images->info.levels, 2u);
    for (unsigned level = 0; level < images->info.levels; ++level) {
        const Result<Mesh> decoded = levelMesh(encoded->file, *images, level);
        ASSERT_TRUE(decoded.ok());
        const test::ManifoldCheck check = test::checkManifold(decoded->faces);
        EXPECT_EQ(check.fault, "") << "level " << level;
        EXPECT_EQ(check.genus, genus) << "level " << level;
        EXPECT_EQ(check.boundaries, loops) << "level " << level;
        for (const Vec3& p : decoded->positions) ASSERT_TRUE(p.allFinite());
        const int n = (encoded->grid - 1) >> level;
        EXPECT_EQ(decoded->faceCount(), 2 * n * n);
    }
    // Without fusing every sample is its own vertex: a disk.
    const Result<Mesh> apart = levelMesh(encoded->file, *images, 1, GIM_NO_FUSE);
    ASSERT_TRUE(apart.ok());
    const test::ManifoldCheck open = test::checkManifold(apart->faces);
    EXPECT_EQ(open.genus, 0);
    EXPECT_EQ(open.boundaries, 1);
}

std::vector<std::pair<int, int>> generaAndLoops()
{
    std::vector<std::pair<int, int>> all;
    for (int genus : {0, 1, 2, 3, 7})
        for (int loops = 0; loops <= 4; ++loops) all.emplace_back(genus, loops);
    return all;
}
INSTANTIATE_TEST_SUITE_P(AllTopologies, EveryLevel, testing::ValuesIn(generaAndLoops()));

} // namespace
} // namespace gimg

#include "gimg/sample.h"

#include "codec/seam.h"
#include "shapes.h"

#include <gtest/gtest.h>

namespace gimg {
namespace {

struct Flattened
{
    SquareDisk square;
    Parameterization map;
};

Flattened flatten(const Mesh& mesh, const BorderOptions& options = {})
{
    Result<SquareDisk> square = layOutBorder(mesh, cutToDisk(mesh), options);
    EXPECT_TRUE(square.ok());
    Result<Parameterization> map = flattenToSquare(*square);
    EXPECT_TRUE(map.ok());
    return {std::move(*square), std::move(*map)};
}

Vec3 sampleAt(const FloatImage& image, int i, int j)
{
    return {image.at(i, j, 0), image.at(i, j, 1), image.at(i, j, 2)};
}

std::pair<int, int> borderPoint(int k, int n)
{
    const int side = n - 1;
    if (k < side) return {k, 0};
    if (k < 2 * side) return {side, k - side};
    if (k < 3 * side) return {3 * side - k, side};
    return {0, 4 * side - k};
}

class SampledShape : public testing::TestWithParam<std::pair<int, int>>
{
};

TEST_P(SampledShape, MatesAgreeToTheLastBitAndCutNodesAreHit)
{
    const Mesh mesh = shapes::surfaceOfGenus(GetParam().first, GetParam().second, 6);
    const Flattened flat = flatten(mesh);
    const int n = flat.square.grid;
    const Result<FloatImage> image = sampleGeometry(flat.square, flat.map, n);
    const Result<FloatImage> normals = sampleNormals(flat.square, flat.map, n);
    ASSERT_TRUE(image.ok() && normals.ok());
    const codec::Seam seam{static_cast<uint32_t>(flat.square.lowest),
                           static_cast<uint32_t>(flat.square.start), flat.square.seam()};
    const std::vector<uint32_t> classes = codec::borderClasses(seam, static_cast<uint32_t>(n));
    ASSERT_EQ(classes.size(), static_cast<size_t>(4 * (n - 1)));
    for (size_t k = 0; k < classes.size(); ++k) {
        const auto [i, j] = borderPoint(static_cast<int>(k), n);
        const auto [ci, cj] = borderPoint(static_cast<int>(classes[k]), n);
        EXPECT_EQ(sampleAt(*image, i, j), sampleAt(*image, ci, cj));
        EXPECT_EQ(sampleAt(*normals, i, j), sampleAt(*normals, ci, cj));
    }
    int position = flat.square.start * ((n - 1) / (flat.square.lowest - 1));
    for (const DiskSide& side : flat.square.disk.sides) {
        const auto [i, j] = borderPoint(position % (4 * (n - 1)), n);
        const Vec3& node = flat.square.disk.mesh.positions[side.vertices.front()];
        EXPECT_EQ(sampleAt(*image, i, j), node.cast<float>().cast<double>());
        position += flat.square.pathLength[side.path] * ((n - 1) / (flat.square.lowest - 1));
    }
}

INSTANTIATE_TEST_SUITE_P(SomeTopologies, SampledShape,
                         testing::Values(std::pair(0, 0), std::pair(0, 3), std::pair(1, 1), std::pair(2, 0),
                                         std::pair(3, 4), std::pair(7, 0)));

TEST(Sample, PointsOfASphereLieOnItsFacesAndNormalsPointOut)
{
    const Flattened flat = flatten(shapes::sphere(2, 20), {65, 17});
    const Result<FloatImage> image = sampleGeometry(flat.square, flat.map, 65);
    const Result<FloatImage> normals = sampleNormals(flat.square, flat.map, 129);
    ASSERT_TRUE(image.ok() && normals.ok());
    EXPECT_EQ(normals->width, 129);
    for (int j = 0; j < 65; ++j)
        for (int i = 0; i < 65; ++i) {
            const Vec3 p = sampleAt(*image, i, j), n = sampleAt(*normals, 2 * i, 2 * j);
            EXPECT_NEAR(p.norm(), 2, 0.01); // faces lie up to 2 (1 - cos) inside
            EXPECT_NEAR(n.norm(), 1, 1e-6);
            EXPECT_GT(n.dot(p) / p.norm(), 0.999);
        }
}

TEST(Sample, RefusesSizesTheBorderWasNotLaidOutFor)
{
    const Flattened flat = flatten(shapes::sphere(1, 4), {33, 9});
    for (int n : {5, 8, 34, 0, -1}) {
        const Result<FloatImage> image = sampleGeometry(flat.square, flat.map, n);
        ASSERT_FALSE(image.ok()) << n;
        EXPECT_EQ(image.error().kind, ErrorKind::BadArgument);
    }
}

} // namespace
} // namespace gimg

#include "gimg/render.h"
#include "shapes.h"
#include "temporary_files.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <cmath>

using namespace gimg;
using ::testing::HasSubstr;

namespace {

const View kFront{{0, 0, -1}, {0, 1, 0}};

RgbImage drawn(const Mesh& mesh, const RenderOptions& options)
{
    const Result<RgbImage> image = render(mesh, options);
    EXPECT_TRUE(image.ok()) << image.error().message;
    return image.ok() ? *image : RgbImage{};
}

Color at(const RgbImage& image, int column, int row)
{
    const uint8_t* p = &image.samples[3 * static_cast<size_t>(row * image.width + column)];
    return {p[0], p[1], p[2]};
}

int count(const RgbImage& image, const Color& color)
{
    int n = 0;
    for (int row = 0; row < image.height; ++row)
        for (int column = 0; column < image.width; ++column) n += at(image, column, row) == color;
    return n;
}

Mesh inverted(Mesh mesh)
{
    for (Triangle& t : mesh.faces) std::swap(t[1], t[2]);
    return mesh;
}

} // namespace

TEST(Render, FillsTheImageButForAMargin)
{
    const RgbImage image = drawn(test::square(5), {.width = 200, .height = 100, .view = kFront, .shade = 0});
    EXPECT_EQ(count(image, kClay), 94 * 94);
    EXPECT_EQ(count(image, kPaper), 200 * 100 - 94 * 94);
    EXPECT_EQ(at(image, 53, 3), kClay);
    EXPECT_EQ(at(image, 52, 3), kPaper);
}

TEST(Render, AntialiasingWeighsByCoverage)
{
    // The edge x = 0.5 of the square runs through the middle of column 50: a camera twice as wide.
    Camera camera{.center = {0.5 + 0.0025, 0.5, 0}, .width = 1.01, .height = 1.01};
    const RgbImage image = drawn(test::square(1), {.width = 101,
                                                   .height = 101,
                                                   .camera = camera,
                                                   .shade = 0,
                                                   .supersampling = 4,
                                                   .surface = {200, 100, 0},
                                                   .background = {0, 0, 0}});
    EXPECT_EQ(at(image, 50, 50), (Color{200, 100, 0}));
    EXPECT_EQ(at(image, 0, 50), (Color{150, 75, 0})); // the square starts a quarter into the first column
    EXPECT_EQ(at(image, 100, 50), (Color{50, 25, 0}));
}

TEST(Render, BackFacesHaveTheirOwnColour)
{
    RenderOptions options{.width = 64, .height = 64, .view = kFront, .shade = 0};
    EXPECT_EQ(count(drawn(inverted(test::square(3)), options), kInside), 60 * 60);
    EXPECT_EQ(count(drawn(test::sphere(1, 4), options), kInside), 0);
    EXPECT_GT(count(drawn(inverted(test::sphere(1, 4)), options), kInside), 2500);
    options.inside.reset();
    EXPECT_EQ(count(drawn(inverted(test::square(3)), options), kClay), 60 * 60);
}

TEST(Render, ThePictureIsUprightAndTheNearerSurfaceIsSeen)
{
    // Right of the middle a second, nearer square that reaches to the upper half only.
    Mesh mesh{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 2}, {1, 0, 2}, {1, 1, 2}, {0, 1, 2}},
              {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}};
    RenderOptions options{.width = 40, .height = 40, .view = kFront, .shade = 0};
    options.color = [](int face, const Vec3&, const Vec3& point) {
        return Color{static_cast<uint8_t>(face), static_cast<uint8_t>(100 + 50 * point[2]), 0};
    };
    const RgbImage image = drawn(mesh, options);
    EXPECT_EQ(at(image, 36, 15), (Color{2, 200, 0})); // upper right, below the diagonal
    EXPECT_EQ(at(image, 22, 5), (Color{3, 200, 0}));
    EXPECT_EQ(at(image, 30, 30), (Color{0, 100, 0}));
    EXPECT_EQ(at(image, 5, 30), (Color{1, 100, 0}));
}

TEST(Render, OfTwoTrianglesInOnePlaceTheFirstIsSeen)
{
    Mesh mesh = test::square(7);
    const size_t n = mesh.faces.size();
    for (size_t f = 0; f < n; ++f) mesh.faces.push_back(mesh.faces[n - 1 - f]);
    RenderOptions options{.width = 64, .height = 64, .view = kFront};
    options.color = [n](int face, const Vec3&, const Vec3&) {
        EXPECT_LT(face, static_cast<int>(n));
        return kClay;
    };
    drawn(mesh, options);
}

TEST(Render, BarycentricCoordinatesAndPointAgree)
{
    const Mesh mesh = test::sphere(2, 3);
    std::atomic<int> hits{0};
    RenderOptions options{.width = 50, .height = 50};
    options.color = [&](int face, const Vec3& barycentric, const Vec3& point) {
        ++hits;
        Vec3 p = Vec3::Zero();
        for (int k = 0; k < 3; ++k) p += barycentric[k] * mesh.positions[mesh.faces[face][k]];
        EXPECT_NEAR((p - point).norm(), 0, 1e-14);
        EXPECT_NEAR(barycentric.sum(), 1, 1e-14);
        EXPECT_GT(barycentric.minCoeff(), -1e-5);
        EXPECT_NEAR(point.norm(), 2, 0.035);
        EXPECT_LT(point.dot(View{}.toward), 0.3); // on the near side
        return kClay;
    };
    drawn(mesh, options);
    EXPECT_NEAR(hits, std::acos(-1) * 23.5 * 23.5 * 9, 200);
}

TEST(Render, MeshesShareACamera)
{
    const Result<Camera> camera = cameraFor(test::sphere(2, 3), kFront);
    ASSERT_TRUE(camera.ok());
    EXPECT_NEAR(camera->width, 4 / 0.94, 1e-12);
    const RgbImage small = drawn(
        test::sphere(1, 5), {.width = 200, .height = 200, .camera = *camera, .shade = 0, .supersampling = 1});
    EXPECT_NEAR(count(small, kClay), std::acos(-1) * 47 * 47, 40);
}

TEST(Render, LightComesFromTheUpperLeft)
{
    for (bool smooth : {false, true}) {
        const RgbImage image =
            drawn(test::sphere(1, 5), {.width = 101, .height = 101, .view = kFront, .smooth = smooth});
        EXPECT_GT(at(image, 35, 30)[0], at(image, 50, 50)[0]);
        EXPECT_GT(at(image, 50, 50)[0], at(image, 70, 75)[0]);
        EXPECT_LT(at(image, 70, 75)[0], 150);
    }
}

TEST(Render, SmoothIsTheSameOnBothSidesOfAnEdge)
{
    // Within one side of the octahedron: the sides share no vertices. Two faces of a coarse sphere are told
    // apart by their shade when flat, and not when smooth.
    const auto colors = [](bool smooth) {
        const RgbImage image =
            drawn(test::sphere(1, 2), {.width = 300, .height = 300, .view = kFront, .smooth = smooth});
        int steps = 0;
        for (int column = 60; column < 145; ++column)
            steps += std::abs(at(image, column, 120)[0] - at(image, column + 1, 120)[0]) > 5;
        return steps;
    };
    EXPECT_GE(colors(false), 3);
    EXPECT_EQ(colors(true), 0);
}

TEST(Render, DoesNotDependOnThreads)
{
    const Mesh mesh = test::torus(2, 0.7, 60, 30);
    const RgbImage one = drawn(mesh, {.width = 150, .height = 90, .threads = 1});
    for (int threads : {0, 2, 5})
        EXPECT_EQ(drawn(mesh, {.width = 150, .height = 90, .threads = threads}).samples, one.samples);
}

TEST(Render, RefusesWhatCannotBeDrawn)
{
    const auto refusal = [](const Mesh& mesh, const RenderOptions& options = {}) {
        const Result<RgbImage> image = render(mesh, options);
        EXPECT_FALSE(image.ok());
        return image.ok() ? Error{} : image.error();
    };
    const Mesh good = test::square(1);
    EXPECT_EQ(refusal({}).kind, ErrorKind::EmptyMesh);
    Mesh bad = good;
    bad.faces[0][0] = 9;
    EXPECT_EQ(refusal(bad).message, "the mesh: face 0 names vertex 9 of 4");
    bad = good;
    bad.positions[3][1] = std::nan("");
    EXPECT_EQ(refusal(bad).kind, ErrorKind::NotFinite);
    EXPECT_THAT(refusal(good, {.width = 0}).message, HasSubstr("0 x 512"));
    EXPECT_EQ(refusal(good, {.supersampling = 9}).message, "supersampling 9");
    EXPECT_THAT(refusal(good, {.view = {{0, 1, 0}, {0, 2, 0}}}).message, HasSubstr("up lies along it"));
    EXPECT_THAT(refusal(good, {.camera = Camera{.center = {1e12, 0, 0}}}).message, HasSubstr("too far off"));
}

class PngFiles : public test::TemporaryFiles
{
};

TEST_F(PngFiles, HoldTheBytesThatAreGivenOut)
{
    const RgbImage image{2, 1, {0, 127, 255, 1, 2, 3}};
    ASSERT_TRUE(writePng(image, path("a.png")).ok());
    const Result<std::vector<uint8_t>> bytes = pngBytes(image);
    ASSERT_TRUE(bytes.ok());
    EXPECT_EQ(read(path("a.png")), std::string(bytes->begin(), bytes->end()));
    EXPECT_EQ(pngBytes({2, 2, {1, 2, 3}}).error().kind, ErrorKind::BadArgument);
    EXPECT_EQ(writePng(image, path("none/a.png")).error().kind, ErrorKind::FileNotWritable);
}

TEST(HeatColor, LightnessRisesEvenly)
{
    const auto linear = [](int x) {
        const double v = x / 255.0;
        return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    };
    for (int i = 0; i <= 100; ++i) {
        const Color c = heatColor(i / 100.0);
        const double y = 0.2126 * linear(c[0]) + 0.7152 * linear(c[1]) + 0.0722 * linear(c[2]);
        EXPECT_NEAR(116 * std::cbrt(y) - 16, 15 + 0.77 * i, 0.8) << i;
    }
    EXPECT_EQ(heatColor(-1), heatColor(0));
    EXPECT_EQ(heatColor(7), heatColor(1));
    EXPECT_EQ(heatColor(std::nan("")), heatColor(0));
}

// The command line of gimrd, run as a user does.
#include "gimg/mesh_io.h"
#include "gimg/render.h"
#include "shapes.h"
#include "temporary_files.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <cstring>
#include <png.h>
#include <sys/wait.h>

using namespace gimg;
using ::testing::HasSubstr;

namespace {

class Gimrd : public test::TemporaryFiles
{
protected:
    struct Ended
    {
        int code;
        std::string out, err;
    };
    Ended run(const std::string& arguments)
    {
        const std::string command =
            std::string(GIMRD_PATH) + " " + arguments + " > '" + path("out") + "' 2> '" + path("err") + "'";
        const int status = std::system(command.c_str());
        return {WEXITSTATUS(status), read(path("out")), read(path("err"))};
    }
    std::string mesh(const std::string& name, const Mesh& mesh)
    {
        EXPECT_TRUE(writeMesh(mesh, path(name)).ok());
        return " '" + path(name) + "'";
    }
};

} // namespace

TEST_F(Gimrd, CompareWritesJson)
{
    Mesh shifted = test::square(2);
    for (Vec3& p : shifted.positions) p[2] += 0.5;
    const Ended ended = run("compare --json --samples 1000 --threads 1" + mesh("a.ply", test::square(2)) +
                            mesh("b.obj", shifted));
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto json = nlohmann::json::parse(ended.out);
    EXPECT_DOUBLE_EQ(json.at("diagonal"), std::sqrt(2));
    EXPECT_DOUBLE_EQ(json.at("rms_ref_to_test"), 0.5);
    EXPECT_DOUBLE_EQ(json.at("rms_test_to_ref"), 0.5);
    EXPECT_DOUBLE_EQ(json.at("hausdorff"), 0.5);
    EXPECT_NEAR(json.at("psnr"), 20 * std::log10(std::sqrt(8)), 1e-12);
    EXPECT_EQ(json.at("max_ref_to_test_at").size(), 3U);
}

TEST_F(Gimrd, AgreementIsNullInJsonAndInfInText)
{
    const std::string a = mesh("a.ply", test::torus(2, 1, 12, 9));
    const Ended json = run("compare --json --samples 100" + a + a);
    ASSERT_EQ(json.code, 0) << json.err;
    EXPECT_TRUE(nlohmann::json::parse(json.out).at("psnr").is_null());
    const Ended text = run("compare --samples 100" + a + a);
    ASSERT_EQ(text.code, 0) << text.err;
    EXPECT_THAT(text.out, HasSubstr("psnr              inf\n"));
}

TEST_F(Gimrd, CompareHasNormalErrors)
{
    Mesh tilted = test::square(2);
    for (Vec3& p : tilted.positions) p[2] = p[0];
    const std::string meshes = mesh("a.ply", test::square(2)) + mesh("b.ply", tilted);
    const auto json = nlohmann::json::parse(run("compare --json --samples 1000" + meshes).out);
    for (const char* key : {"normal_rms_ref_to_test", "normal_rms_test_to_ref", "normal_mean_ref_to_test",
                            "normal_mean_test_to_ref", "normal_error_degrees"})
        EXPECT_NEAR(json.at(key), 45, 1e-12) << key;
    EXPECT_FALSE(json.contains("heatmap_max"));
    EXPECT_THAT(run("compare --samples 1000" + meshes).out,
                HasSubstr("normals ref to test  45 degrees rms, mean 45\n"));

    const std::string needle =
        mesh("needle.ply", Mesh{{{0, 0, 0}, {1, 0, 0}, {0.5, 0x1p-36, 0}}, {{0, 1, 2}}});
    const Ended none = run("compare --json --samples 1000" + needle + mesh("a.ply", test::square(2)));
    ASSERT_EQ(none.code, 0) << none.err;
    EXPECT_TRUE(nlohmann::json::parse(none.out).at("normal_error_degrees").is_null());
}

TEST_F(Gimrd, TopologyOfTheTestMeshDoesNotMatter)
{
    const std::string fan =
        write("fan.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 5 5 5\nv 6 5 5\nv 5 6 5\n"
                         "f 1 2 3\nf 1 2 4\nf 1 2 5\nf 6 7 8\n");
    EXPECT_EQ(run("compare --samples 100" + mesh("a.ply", test::square(2)) + " '" + fan + "'").code, 0);
}

TEST_F(Gimrd, ExitCodesTellInputFromUsage)
{
    const std::string a = mesh("a.ply", test::square(2));
    const Ended missing = run("compare" + a + " none.ply");
    EXPECT_EQ(missing.code, 1);
    EXPECT_EQ(missing.err, "gimrd: none.ply: no such file\n");
    EXPECT_EQ(missing.out, "");
    EXPECT_EQ(run("compare" + a).code, 2);
    EXPECT_EQ(run("").code, 2);
    EXPECT_EQ(run("compare --samples 0" + a + a).code, 2);
    EXPECT_EQ(run("compare --colour" + a + a).code, 2);
    EXPECT_EQ(run("--help").code, 0);
    EXPECT_EQ(run("--version").code, 0);
}

namespace {

/// Vertex properties of a binary PLY file with positions, colours and quality, after its header.
struct PlyVertex
{
    float x, y, z;
    Color color;
    float quality;
};

std::vector<PlyVertex> readColoredPly(const std::string& bytes)
{
    const size_t start = bytes.find("end_header\n");
    const size_t counts = bytes.find("element vertex ");
    EXPECT_THAT(bytes.substr(0, start),
                HasSubstr("property float x\nproperty float y\nproperty float z\nproperty uchar red\n"
                          "property uchar green\nproperty uchar blue\nproperty float quality\n"));
    constexpr size_t kSize = 19;
    std::vector<PlyVertex> vertices(std::stoul(bytes.substr(counts + 15)));
    for (size_t v = 0; v < vertices.size(); ++v) {
        const char* p = bytes.data() + start + 11 + v * kSize;
        std::memcpy(&vertices[v].x, p, 12);
        std::memcpy(vertices[v].color.data(), p + 12, 3);
        std::memcpy(&vertices[v].quality, p + 15, 4);
    }
    return vertices;
}

struct Picture
{
    int width = 0, height = 0;
    std::vector<uint8_t> samples;
    Color at(int x, int y) const
    {
        const uint8_t* p = &samples[3 * static_cast<size_t>(y * width + x)];
        return {p[0], p[1], p[2]};
    }
};

Picture readPng(const std::string& bytes)
{
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    EXPECT_TRUE(png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()));
    EXPECT_EQ(png.format, unsigned{PNG_FORMAT_RGB});
    Picture picture{static_cast<int>(png.width), static_cast<int>(png.height), {}};
    picture.samples.resize(PNG_IMAGE_SIZE(png));
    EXPECT_TRUE(png_image_finish_read(&png, nullptr, picture.samples.data(), 0, nullptr));
    return picture;
}

/// A square over the unit square at height x / 8; floats hold it.
Mesh ramp()
{
    Mesh mesh = test::square(4);
    for (Vec3& p : mesh.positions) p[2] = p[0] / 8;
    return mesh;
}

} // namespace

TEST_F(Gimrd, HeatmapOfVerticesHasTheirDistance)
{
    const Ended ended = run("compare --json --samples 1000 --heatmap-max 5 --heatmap '" + path("heat.ply") +
                            "'" + mesh("a.ply", test::square(2)) + mesh("b.obj", ramp()));
    ASSERT_EQ(ended.code, 0) << ended.err;
    const double top = 0.05 * std::sqrt(2);
    EXPECT_DOUBLE_EQ(nlohmann::json::parse(ended.out).at("heatmap_max"), top);
    const std::vector<PlyVertex> vertices = readColoredPly(read(path("heat.ply")));
    const Mesh test = ramp();
    ASSERT_EQ(vertices.size(), test.positions.size());
    for (size_t v = 0; v < vertices.size(); ++v) {
        EXPECT_FLOAT_EQ(vertices[v].x, static_cast<float>(test.positions[v][0]));
        EXPECT_NEAR(vertices[v].quality, test.positions[v][2], 1e-8);
        EXPECT_EQ(vertices[v].color, heatColor(test.positions[v][2] / top));
    }
    EXPECT_EQ(vertices.front().color, heatColor(0));
    EXPECT_EQ(vertices.back().color, heatColor(1)); // 1/8 is above the top
    const Result<Mesh> back = readTriangles(path("heat.ply"));
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_EQ(back->faces, test.faces);
}

TEST_F(Gimrd, HeatmapPictureShowsBothSurfacesAndTheScale)
{
    Mesh half = test::square(4); // the other half of the reference is up to 0.5 away from it
    for (Vec3& p : half.positions) p[0] /= 2;
    const std::string meshes = mesh("a.ply", test::square(4)) + mesh("b.ply", half);
    std::string first;
    for (const char* threads : {"1", "2"}) {
        const Ended ended = run("compare --samples 2000 --threads " + std::string(threads) + " --heatmap '" +
                                path("heat.PNG") + "'" + meshes);
        ASSERT_EQ(ended.code, 0) << ended.err;
        EXPECT_THAT(ended.out, HasSubstr("heatmap           0 to 0.565685, 40 % of the diagonal\n"));
        if (first.empty()) first = read(path("heat.PNG"));
        EXPECT_EQ(read(path("heat.PNG")), first);
    }
    const Picture picture = readPng(first);
    ASSERT_EQ(picture.width, 900);
    // The reference from left to right: none, then growing; the test surface is its left half, of one colour.
    const auto brightness = [](const Color& c) { return c[0] + 2 * c[1]; };
    const Color near = picture.at(120, 220), middle = picture.at(280, 220), far = picture.at(360, 220);
    EXPECT_LT(brightness(near) + 60, brightness(middle));
    EXPECT_LT(brightness(middle) + 60, brightness(far));
    EXPECT_EQ(picture.at(460 + 120, 220), near);
    EXPECT_EQ(picture.at(460 + 360, 220), kPaper);
    // The colour bar.
    EXPECT_EQ(picture.at(230, 484), heatColor(0.5 / 440));
    EXPECT_EQ(picture.at(669, 484), heatColor(439.5 / 440));
}

TEST_F(Gimrd, HeatmapOfEqualSurfacesIsOfOneColour)
{
    const std::string a = mesh("a.ply", test::tetrahedron());
    const Ended ended = run("compare --samples 500 --heatmap '" + path("heat.ply") + "'" + a + a);
    ASSERT_EQ(ended.code, 0) << ended.err;
    for (const PlyVertex& v : readColoredPly(read(path("heat.ply")))) EXPECT_EQ(v.color, heatColor(0));
    EXPECT_EQ(run("compare --samples 500 --heatmap '" + path("heat.png") + "'" + a + a).code, 0);
}

TEST_F(Gimrd, HeatmapsThatCannotBeWritten)
{
    const Ended unknown = run("compare --heatmap heat.jpg none.ply none.ply");
    EXPECT_EQ(unknown.code, 2);
    EXPECT_THAT(unknown.err, HasSubstr("heat.jpg: a heatmap is written to .ply or .png"));
    const std::string a = mesh("a.ply", test::square(2));
    for (const char* name : {"none/heat.ply", "none/heat.png"}) {
        const Ended unwritable = run("compare --samples 10 --heatmap '" + path(name) + "'" + a + a);
        EXPECT_EQ(unwritable.code, 1);
        EXPECT_EQ(unwritable.err, "gimrd: " + path(name) + ": cannot be written\n");
    }
    EXPECT_EQ(run("compare --heatmap " + a + a + a).code, 2); // onto the reference
    EXPECT_EQ(run("compare --heatmap-max 1" + a + a).code, 2);
    EXPECT_EQ(run("compare --heatmap x.png --heatmap-max 0" + a + a).code, 2);
}

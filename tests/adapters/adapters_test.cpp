// The adapters as gimrd runs them: programs that speak the protocol of bench/adapters/README.md. Those whose
// packages are not installed are tested for saying so.
#include "gimg/decode.h"
#include "gimg/distance.h"
#include "gimg/image_io.h"
#include "gimg/mesh_io.h"
#include "shapes.h"
#include "temporary_files.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <numbers>
#include <sys/wait.h>

using namespace gimg;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsSubsetOf;
using ::testing::MatchesRegex;
using Json = nlohmann::json;

namespace {

// A bumpy square whose three axes have the range 0 to 1; its samples stand irregularly, so that rounding them
// is as good as chance.
FloatImage bumps(int side)
{
    FloatImage image{side, side, {}};
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
            const double s = static_cast<double>(i) / (side - 1), t = static_cast<double>(j) / (side - 1);
            const double turn = 2 * std::numbers::pi, wave = 0.03 * std::sin(turn * s) * std::sin(turn * t);
            const double x = s + wave, y = t + wave;
            for (const double value : {x, y, 0.5 + 0.5 * std::cos(turn * x) * std::cos(turn * y)})
                image.samples.push_back(static_cast<float>(value));
        }
    return image;
}

// A torus that no axis is special to.
Mesh torus(int around, int across)
{
    Mesh mesh = test::torus(3, 1, around, across);
    const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
    for (Vec3& p : mesh.positions) p = turn * p;
    return mesh;
}

std::string planar(const FloatImage& image)
{
    std::string bytes;
    for (size_t c = 0; c < 3; ++c)
        for (size_t i = c; i < image.samples.size(); i += 3) {
            char sample[sizeof(float)];
            std::memcpy(sample, &image.samples[i], sizeof sample);
            bytes.append(sample, sizeof sample);
        }
    return bytes;
}

FloatImage fromPlanar(const std::string& bytes)
{
    const size_t pixels = bytes.size() / (3 * sizeof(float));
    const int side = static_cast<int>(std::lround(std::sqrt(static_cast<double>(pixels))));
    FloatImage image{side, side, std::vector<float>(3 * pixels)};
    for (size_t c = 0; c < 3; ++c)
        for (size_t i = 0; i < pixels; ++i)
            std::memcpy(&image.samples[3 * i + c], &bytes[(c * pixels + i) * sizeof(float)], sizeof(float));
    return image;
}

// PSNR of a surface of which every coordinate of every vertex is rounded by itself: its distance from the
// surface has the variance step^2 / 12 at a vertex, and half of that between three of them.
double psnrOfRounding(double diagonal, double step)
{
    return 20 * std::log10(diagonal / (step / std::sqrt(24.0)));
}

class Adapters : public test::TemporaryFiles
{
protected:
    struct Ended
    {
        int code;
        std::vector<Json> lines;
        std::string out, err;
    };

    static Ended finished(int status, std::string out, std::string err)
    {
        Ended ended{WEXITSTATUS(status), {}, std::move(out), std::move(err)};
        std::istringstream in(ended.out);
        for (std::string line; std::getline(in, line);) ended.lines.push_back(Json::parse(line));
        return ended;
    }

    Ended run(const std::string& adapter, const std::string& arguments)
    {
        const std::string command = std::string(GIMG_ADAPTERS "/") + adapter + " " + arguments + " > '" +
                                    path("stdout") + "' 2> '" + path("stderr") + "'";
        const int status = std::system(command.c_str());
        return finished(status, read(path("stdout")), read(path("stderr")));
    }

    // Encodes and checks what holds for every coder: a line for each size, in order; files that are there and
    // not larger than it. Gives the lines.
    std::map<size_t, Json> encode(const std::string& adapter, const std::string& input,
                                  const std::vector<size_t>& sizes)
    {
        std::string list;
        for (const size_t size : sizes) {
            if (!list.empty()) list += ',';
            list += std::to_string(size);
        }
        const Ended ended =
            run(adapter, "encode '" + input + "' '" + path("out") + "' --threads 2 --bytes " + list);
        EXPECT_EQ(ended.code, 0) << ended.err;
        EXPECT_EQ(ended.lines.size(), sizes.size());
        std::map<size_t, Json> result;
        for (size_t i = 0; i < ended.lines.size(); ++i) {
            const Json& line = ended.lines[i];
            EXPECT_EQ(line.at("target"), sizes[i]);
            result[sizes[i]] = line;
            if (line.contains("unreachable")) continue;
            EXPECT_LE(line.at("bytes"), sizes[i]);
            EXPECT_EQ(line.at("bytes"), read(path("out/" + line.at("file").get<std::string>())).size());
        }
        return result;
    }

    bool missing(const std::string& adapter)
    {
        return !run(adapter, "describe").lines.at(0).at("missing").empty();
    }

    // What gimrd says of a decoded mesh.
    double comparePsnr(const std::string& reference, const Json& line)
    {
        const std::string command = std::string(GIMRD_PATH) + " compare --json '" + reference + "' '" +
                                    path("out/" + line.at("decoded").get<std::string>()) + "' > '" +
                                    path("compared") + "'";
        EXPECT_EQ(std::system(command.c_str()), 0);
        return Json::parse(read(path("compared"))).at("psnr");
    }

    FloatImage decodedImage(const Json& line)
    {
        return fromPlanar(read(path("out/" + line.at("decoded").get<std::string>())));
    }

    double imagePsnr(const FloatImage& reference, const Json& line)
    {
        return compareSurfaces(gridMesh(reference), gridMesh(decodedImage(line)))->psnr();
    }

    std::string meshFile(const Mesh& mesh)
    {
        EXPECT_TRUE(writeMesh(mesh, path("mesh.ply")).ok());
        return path("mesh.ply");
    }
    std::string imageFile(const FloatImage& image) { return write("image.f32", planar(image)); }
};

} // namespace

TEST_F(Adapters, DescribeThemselvesAndTheirPackages)
{
    std::map<std::string, Json> found;
    for (const auto& entry : std::filesystem::directory_iterator(GIMG_ADAPTERS)) {
        const Ended ended = run(entry.path().filename().string(), "describe");
        ASSERT_EQ(ended.code, 0) << entry.path();
        ASSERT_EQ(ended.lines.size(), 1U) << entry.path();
        found[ended.lines[0].at("name")] = ended.lines[0];
    }
    for (const auto& [name, json] : found) {
        EXPECT_THAT(name, MatchesRegex("[a-z][a-z0-9-]*"));
        EXPECT_THAT(json.at("input"), testing::AnyOf("mesh", "image"));
        const bool ours = json.at("side") == "ours";
        EXPECT_EQ(json.at("packages").empty(), ours) << name;
        EXPECT_THAT(json.at("missing"), IsSubsetOf(json.at("packages"))) << name;
    }
    for (const char* name :
         {"draco-lt", "draco-meshopt", "meshopt", "openjpeg", "jxl", "raw-zlib", "gim", "gim-image"})
        EXPECT_EQ(found.count(name), 1U) << name;
    EXPECT_THAT(found.at("draco-lt").at("packages"), testing::ElementsAre("libcgal-dev", "libdraco-dev"));
}

TEST_F(Adapters, ThatLackAPackageRefuseToEncodeAndNameIt)
{
    // No program of a peer is on this PATH.
    const std::string command = "PATH=/nonexistent '" GIMG_ADAPTERS "/openjpeg' ";
    const std::string streams = " > '" + path("stdout") + "' 2> '" + path("stderr") + "'";
    ASSERT_EQ(std::system((command + "describe" + streams).c_str()), 0);
    EXPECT_THAT(Json::parse(read(path("stdout"))).at("missing"), testing::ElementsAre("libopenjp2-tools"));
    const std::string input = imageFile(bumps(9));
    const int status =
        std::system((command + "encode '" + input + "' '" + path("out") + "' --bytes 900" + streams).c_str());
    EXPECT_EQ(WEXITSTATUS(status), 1);
    EXPECT_EQ(read(path("stderr")), "openjpeg: not installed: libopenjp2-tools\n");
}

TEST_F(Adapters, RawZlibRoundsSamplesAndNothingElse)
{
    const FloatImage image = bumps(33);
    auto lines = encode("raw_zlib", imageFile(image), {20, 400, 5000});
    EXPECT_TRUE(lines[20].contains("unreachable")); // the header alone has 27 bytes
    ASSERT_EQ(lines[5000].at("settings").at("grid"), 33);
    const int bits = lines[5000].at("settings").at("bits");
    EXPECT_NEAR(imagePsnr(image, lines[5000]), psnrOfRounding(std::sqrt(3), 1 / (std::ldexp(1, bits) - 1)),
                0.8); // the border is free to err more
    EXPECT_LT(lines[400].at("settings").at("grid"), 33);
}

TEST_F(Adapters, RawZlibDecodesWhatItWrote)
{
    const FloatImage image = bumps(9);
    auto lines = encode("raw_zlib", imageFile(image), {100000});
    EXPECT_EQ(lines[100000].at("settings").at("bits"), 16);
    const FloatImage decoded = decodedImage(lines[100000]);
    ASSERT_EQ(decoded.samples.size(), image.samples.size());
    for (size_t i = 0; i < image.samples.size(); ++i)
        ASSERT_NEAR(decoded.samples[i], image.samples[i], 0.5001 / 65535);
}

TEST_F(Adapters, GimDecodesItsOwnFile)
{
    const std::string input = meshFile(torus(24, 12));
    auto lines = encode("gim_wavelet", input, {30, 700});
    EXPECT_THAT(lines[30].at("unreachable"), HasSubstr("bytes"));
    const std::string file = read(path("out/700.gim"));
    const std::vector<uint8_t> bytes(file.begin(), file.end());
    const Result<DecodedImages> images = decodeImages(bytes);
    ASSERT_TRUE(images.ok());
    const Result<Mesh> mesh = levelMesh(bytes, *images, 0);
    const Result<Mesh> written = readTriangles(path("out/700.ply"));
    ASSERT_TRUE(mesh.ok() && written.ok());
    EXPECT_EQ(written->positions, mesh->positions);
    EXPECT_EQ(written->faces, mesh->faces);
    EXPECT_GT(comparePsnr(input, lines[700]), 45);
}

TEST_F(Adapters, GimImageNeedsAGridOfPowersOfTwo)
{
    const FloatImage image = bumps(65);
    auto lines = encode("gim_image", imageFile(image), {30, 600, 1200});
    EXPECT_TRUE(lines[30].contains("unreachable"));
    EXPECT_GT(imagePsnr(image, lines[600]), 50);
    EXPECT_GT(imagePsnr(image, lines[1200]), imagePsnr(image, lines[600]) + 4);
    const Ended refused =
        run("gim_image", "encode '" + imageFile(bumps(64)) + "' '" + path("out") + "' --bytes 900");
    EXPECT_EQ(refused.code, 1);
    EXPECT_THAT(refused.err, HasSubstr("2^j + 1"));
}

TEST_F(Adapters, BrokenInputIsOneLineAndAStatus)
{
    const std::string ply = meshFile(test::torus(2, 1, 12, 9));
    const std::string cut = write("cut.ply", read(ply).substr(0, 700));
    const std::string odd = write("odd.f32", std::string(100, 'x'));
    const std::string rest = " '" + path("out") + "' --bytes 900";
    for (const Ended& ended :
         {run("gim_wavelet", "encode '" + cut + "'" + rest), run("raw_zlib", "encode '" + odd + "'" + rest),
          run("raw_zlib", "encode '" + path("none.f32") + "'" + rest)}) {
        EXPECT_EQ(ended.code, 1);
        EXPECT_TRUE(ended.lines.empty());
        EXPECT_THAT(ended.err, MatchesRegex("[a-z-]+: [^\n]+\n"));
    }
    EXPECT_EQ(run("raw_zlib", "encode '" + odd + "' '" + path("out") + "'").code, 2); // no --bytes
    EXPECT_EQ(run("raw_zlib", "encode '" + odd + "' '" + path("out") + "' --bytes 0").code, 2);
}

TEST_F(Adapters, TimesAreAsManyAsRuns)
{
    const Ended ended = run("raw_zlib", "time '" + imageFile(bumps(33)) + "' --runs 3");
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(ended.lines.at(0).at("encode_ms").size(), 3U);
    EXPECT_EQ(ended.lines.at(0).at("decode_ms").size(), 3U);
    EXPECT_THAT(ended.lines.at(0).at("decode_ms"), Each(testing::Gt(0.0)));
}

TEST_F(Adapters, DracoCodesTheWholeMeshWhereThereIsRoom)
{
    if (missing("draco_lt")) GTEST_SKIP() << "needs libcgal-dev and libdraco-dev";
    const Mesh mesh = torus(64, 32);
    const std::string input = meshFile(mesh);
    auto lines = encode("draco_lt", input, {200000});
    EXPECT_EQ(lines[200000].at("settings").at("triangles"), mesh.faceCount());
    EXPECT_EQ(lines[200000].at("settings").at("bits"), 20);
    // Draco's unit is the largest extent over 2^bits - 1.
    Eigen::AlignedBox3d box;
    for (const Vec3& p : mesh.positions) box.extend(p);
    const double unit = box.sizes().maxCoeff() / (std::ldexp(1, 20) - 1);
    EXPECT_NEAR(comparePsnr(input, lines[200000]), psnrOfRounding(box.diagonal().norm(), unit), 0.4);
}

TEST_F(Adapters, SimplifiersFillTheSize)
{
    const std::string input = meshFile(torus(64, 32));
    // The least that each reaches at 800 bytes, in dB.
    const std::map<std::string, double> psnr = {{"draco_lt", 57}, {"draco_meshopt", 50}, {"meshopt", 54}};
    for (const auto& [adapter, least] : psnr) {
        if (missing(adapter)) continue;
        auto lines = encode(adapter, input, {20, 800, 1600});
        EXPECT_TRUE(lines[20].contains("unreachable")) << adapter;
        EXPECT_GT(lines[800].at("bytes"), 800 * 0.96) << adapter;
        EXPECT_GT(comparePsnr(input, lines[800]), least) << adapter;
        EXPECT_GT(comparePsnr(input, lines[1600]), comparePsnr(input, lines[800]) + 4) << adapter;
    }
}

TEST_F(Adapters, DracoGivesTheSameFilesAgain)
{
    if (missing("draco_lt")) GTEST_SKIP() << "needs libcgal-dev and libdraco-dev";
    const std::string input = meshFile(torus(48, 24));
    encode("draco_lt", input, {800});
    const std::string first = read(path("out/800.drc"));
    encode("draco_lt", input, {800});
    EXPECT_EQ(read(path("out/800.drc")), first);
}

TEST_F(Adapters, ImageCodersFillTheSize)
{
    const FloatImage image = bumps(33);
    const std::string input = imageFile(image);
    const std::map<std::string, double> psnr = {{"openjpeg", 45}, {"jxl", 40}};
    for (const auto& [adapter, least] : psnr) {
        if (missing(adapter)) continue;
        auto lines = encode(adapter, input, {40, 600});
        EXPECT_TRUE(lines[40].contains("unreachable")) << adapter;
        EXPECT_GT(lines[600].at("bytes"), 600 * 0.94) << adapter;
        EXPECT_GT(imagePsnr(image, lines[600]), least) << adapter;
    }
}

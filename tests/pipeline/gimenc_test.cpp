// The command line of gimenc, run as a user does.
#include "corpus/shapes.h"
#include "gimg/image_io.h"
#include "gimg/mesh_io.h"
#include "temporary_files.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <sys/wait.h>

namespace gimg {
namespace {

using testing::HasSubstr;

class Gimenc : public test::TemporaryFiles
{
protected:
    struct Ended
    {
        int code;
        std::string out, err;
    };
    Ended run(const std::string& program, const std::string& arguments)
    {
        const std::string command =
            program + " " + arguments + " > '" + path("out") + "' 2> '" + path("err") + "'";
        const int status = std::system(command.c_str());
        return {WEXITSTATUS(status), read(path("out")), read(path("err"))};
    }
    /// Quick, unless told otherwise.
    Ended gimenc(const std::string& arguments)
    {
        const bool isTold = arguments.find("--effort") != std::string::npos;
        return run(GIMENC_PATH, (isTold ? "" : "--effort 4 ") + arguments);
    }
    std::string mesh(const std::string& name, const Mesh& mesh)
    {
        EXPECT_TRUE(writeMesh(mesh, path(name)).ok());
        return " '" + path(name) + "'";
    }
    std::string file(const std::string& name) { return " '" + path(name) + "'"; }
};

TEST_F(Gimenc, ReportHasTheDocumentedKeys)
{
    const Ended ended = gimenc("--bytes 2000 --grid 65 --normals 33 --json -" +
                               mesh("torus.ply", shapes::torus(2, 1, 40, 20)) + file("torus.gim"));
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto json = nlohmann::json::parse(ended.out);
    EXPECT_EQ(json.at("vertices"), 800);
    EXPECT_EQ(json.at("faces"), 1600);
    EXPECT_EQ(json.at("genus"), 1);
    EXPECT_EQ(json.at("boundaries"), 0);
    EXPECT_EQ(json.at("grid"), 65);
    const auto& bytes = json.at("bytes");
    const int total = bytes.at("total");
    EXPECT_EQ(total, static_cast<int>(read(path("torus.gim")).size()));
    EXPECT_EQ(total, bytes.at("container").get<int>() + bytes.at("sideband").get<int>() +
                         bytes.at("geometry").get<int>() + bytes.at("normals").get<int>());
    EXPECT_LE(total, 2000);
    EXPECT_GT(json.at("psnr").get<double>(), 35);
    EXPECT_GT(json.at("stretch_efficiency").get<double>(), 0.3);
    EXPECT_EQ(json.at("cut").at("paths"), 3);
    EXPECT_EQ(json.at("cut").at("nodes"), 2);
    EXPECT_GT(json.at("cut").at("length").get<double>(), 2 * 3.14);
    double sum = 0;
    for (const char* key : {"read", "cut", "parameterize", "sample", "fit", "code"})
        sum += json.at("seconds").at(key).get<double>();
    EXPECT_GE(json.at("seconds").at("total").get<double>(), 0.9 * sum);
    EXPECT_TRUE(json.at("warnings").is_array());
}

TEST_F(Gimenc, AttributesGoIntoTheFileAndBackIntoMeshes)
{
    const Mesh torus = shapes::torus(2, 1, 40, 20);
    VertexAttribute color{"color", 3, GIM_U8, true, {}}, height{"height", 1, GIM_F32, false, {}};
    for (const Vec3& p : torus.positions) {
        for (const double c : {p.x(), p.y(), p.z()})
            color.values.push_back(static_cast<float>(std::floor(127.5 + 40 * c)));
        height.values.push_back(static_cast<float>(p.z()));
    }
    const std::vector<VertexAttribute> attributes = {color, height};
    ASSERT_TRUE(writeMesh(torus, path("torus.ply"), {}, Encoding::Binary, attributes).ok());
    const Ended ended =
        gimenc("--bytes 5000 --grid 65 --attribute color --attribute height:33:lossless --json -" +
               file("torus.ply") + file("torus.gim"));
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto bytes = nlohmann::json::parse(ended.out).at("bytes");
    EXPECT_GT(bytes.at("attributes").get<int>(), 500);
    int sum = 0;
    for (const char* part : {"container", "sideband", "geometry", "normals", "attributes"})
        sum += bytes.at(part).get<int>();
    EXPECT_EQ(bytes.at("total").get<int>(), sum);

    for (const char* name : {"back.ply", "back.obj"}) {
        const Ended decoded = run(GIMDEC_PATH, file("torus.gim") + file(name));
        ASSERT_EQ(decoded.code, 0) << decoded.err;
        const bool isPly = std::string(name) == "back.ply";
        EXPECT_EQ(decoded.err.find("attribute height") == std::string::npos, isPly) << decoded.err;
        const Result<MeshFile> back = readMesh(path(name));
        ASSERT_TRUE(back.ok()) << back.error().message;
        const AttributedSurface& told = back->attributed;
        const VertexAttribute* found = findAttribute(told.attributes, "color");
        ASSERT_NE(found, nullptr);
        EXPECT_EQ(found->type, isPly ? GIM_U8 : GIM_F32);
        EXPECT_EQ(findAttribute(told.attributes, "height") != nullptr, isPly);
        const double scale = isPly ? 1 : 255;
        double sumOff = 0;
        for (int v = 0; v < told.mesh.vertexCount(); ++v)
            for (int c = 0; c < 3; ++c)
                sumOff += std::abs(scale * double{found->values[3 * v + c]} -
                                   (127.5 + 40 * told.mesh.positions[v][c]));
        EXPECT_LT(sumOff / (3 * told.mesh.vertexCount()), 2.5);
    }
    const Ended unknown = gimenc("--bytes 5000 --attribute colour" + file("torus.ply") + file("x.gim"));
    EXPECT_EQ(unknown.code, 2);
    EXPECT_THAT(unknown.err, HasSubstr("no attribute colour; the mesh has: color, height"));
    EXPECT_EQ(gimenc("--bytes 5000 --attribute color:x" + file("torus.ply") + file("x.gim")).code, 2);
    EXPECT_EQ(gimenc("--bytes 5000 --coding wavelet --grid 65 --normals 33 --attribute color" +
                     file("torus.ply") + file("x.gim"))
                  .code,
              0);
}

TEST_F(Gimenc, ParamChoosesTheMapAndTheReportNamesIt)
{
    const std::string torus = mesh("torus.ply", shapes::torus(2, 1, 24, 12));
    std::set<std::string> files;
    for (const std::string param : {"", "mvc", "tutte", "harmonic"}) {
        const Ended ended = gimenc("--bytes 1000 --grid 33 --json -" +
                                   (param.empty() ? "" : " --param " + param) + torus + file("torus.gim"));
        ASSERT_EQ(ended.code, 0) << ended.err;
        const auto json = nlohmann::json::parse(ended.out);
        EXPECT_EQ(json.at("param"), param.empty() ? "stretch" : param);
        EXPECT_GT(json.at("psnr").get<double>(), 25);
        const auto bytes = read(path("torus.gim"));
        files.insert({bytes.begin(), bytes.end()});
    }
    EXPECT_EQ(files.size(), 4u);
    EXPECT_EQ(gimenc("--bytes 1000 --param best" + torus + file("torus.gim")).code, 2);
}

TEST_F(Gimenc, ConformalGoesThroughTheSphere)
{
    const std::string ball = mesh("ball.ply", shapes::wavySphere(1, 0.3, 3, 12));
    const Ended ended = gimenc("--bytes 1500 --grid 65 --param conformal --json -" + ball + file("ball.gim"));
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto json = nlohmann::json::parse(ended.out);
    EXPECT_EQ(json.at("param"), "conformal");
    EXPECT_EQ(json.at("layout"), "octahedral");
    EXPECT_GT(json.at("psnr").get<double>(), 55);
    const Ended refused = gimenc("--bytes 1500 --param conformal" +
                                 mesh("two.ply", shapes::surfaceOfGenus(2, 0, 4)) + file("x.gim"));
    EXPECT_EQ(refused.code, 1);
    EXPECT_THAT(refused.err, HasSubstr("genus 2"));
}

TEST_F(Gimenc, SurfaceCodingIsDecibelsAheadOfComponentsOnTheirOwn)
{
    const std::string files = mesh("torus.ply", shapes::torus(2, 1, 80, 40)) + file("torus.gim");
    const auto psnr = [&](const std::string& options) {
        const Ended ended = gimenc("--bytes 800 --grid 65 --json - " + options + files);
        EXPECT_EQ(ended.code, 0) << ended.err;
        return nlohmann::json::parse(ended.out).at("psnr").get<double>();
    };
    EXPECT_GT(psnr(""), psnr("--coding wavelet") + 3);
    EXPECT_EQ(psnr(""), psnr("--coding surface"));
    EXPECT_EQ(gimenc("--bytes 800 --coding best" + files).code, 2);
    EXPECT_EQ(gimenc("--raw float --coding wavelet" + files).code, 2);
}

TEST_F(Gimenc, ReportsWhatTheFitIsWorthAndLeavesItOut)
{
    const std::string files = mesh("torus.ply", shapes::torus(2, 1, 40, 20)) + file("torus.gim");
    const auto report = [&](const std::string& options) {
        const Ended ended = gimenc("--raw float --grid 65 --json - " + options + files);
        EXPECT_EQ(ended.code, 0) << ended.err;
        return nlohmann::json::parse(ended.out);
    };
    const auto fitted = report(""), plain = report("--no-fit");
    EXPECT_TRUE(plain.at("fit").is_null());
    EXPECT_EQ(fitted.at("fit").at("db_before"), plain.at("psnr"));
    EXPECT_EQ(fitted.at("fit").at("db_after"), fitted.at("psnr"));
    EXPECT_GT(fitted.at("psnr").get<double>(), plain.at("psnr").get<double>() + 4);
}

TEST_F(Gimenc, FeaturesLowerTheMaximumOfABoxAndLeaveATorusAlone)
{
    const auto report = [&](const std::string& options) {
        const Ended ended = gimenc("--raw float --grid 33 --json - --features" + options);
        EXPECT_EQ(ended.code, 0) << ended.err;
        return nlohmann::json::parse(ended.out);
    };
    const auto box = report(mesh("box.ply", shapes::box(Vec3(1, 0.8, 0.6), 4)) + file("box.gim"));
    const auto& found = box.at("features");
    EXPECT_EQ(found.at("creases"), 12);
    EXPECT_EQ(found.at("on_corners"), 8);
    EXPECT_EQ(found.at("db_after"), box.at("psnr"));
    EXPECT_EQ(found.at("db_before"), box.at("fit").at("db_after"));
    EXPECT_LT(found.at("max_after").get<double>(), found.at("max_before").get<double>() / 2);
    EXPECT_EQ(box.at("warnings").size(), 0u);

    const std::string torus = mesh("torus.ply", shapes::torus(2, 1, 40, 20));
    const auto smooth = report(torus + file("with.gim"));
    EXPECT_EQ(smooth.at("features").at("length"), 0);
    EXPECT_EQ(smooth.at("warnings").size(), 1u);
    EXPECT_EQ(gimenc("--raw float --grid 33" + torus + file("without.gim")).code, 0);
    EXPECT_EQ(read(path("with.gim")), read(path("without.gim")));
    EXPECT_EQ(gimenc("--raw float --features --no-fit" + torus + file("with.gim")).code, 2);
}

TEST_F(Gimenc, ExitCodesTellRefusedUsageAndUnreachableApart)
{
    const std::string sphere = mesh("sphere.obj", shapes::sphere(1, 6));
    const std::string out = file("out.gim");
    EXPECT_EQ(gimenc("--bytes 2000 --grid 65" + sphere + out).code, 0);
    EXPECT_EQ(gimenc("--bytes 2000 /nonexistent.ply" + out).code, 1);
    EXPECT_EQ(gimenc(sphere + out).code, 2);                            // no target
    EXPECT_EQ(gimenc("--bytes 2000 --psnr 60" + sphere + out).code, 2); // two
    EXPECT_EQ(gimenc("--bytes -5" + sphere + out).code, 2);
    EXPECT_EQ(gimenc("--raw 13" + sphere + out).code, 2);
    EXPECT_EQ(gimenc("--bytes 2000 --grid 100" + sphere + out).code, 2);
    EXPECT_EQ(gimenc("--bytes 2000 --threads x" + sphere + out).code, 2);
    EXPECT_EQ(gimenc("--bytes 2000 --normals 65537" + sphere + out).code, 2);
    for (const char* option : {"--max-genus -1", "--max-genus none", "--close-holes 0", "--close-holes 5%%"})
        EXPECT_EQ(gimenc("--bytes 2000 " + std::string(option) + sphere + out).code, 2) << option;
    EXPECT_EQ(gimenc("--bytes 2000" + sphere + sphere).code, 2); // onto itself
    EXPECT_EQ(run(GIMDEC_PATH, "/tmp" + file("x.ply")).code, 1); // a folder
    EXPECT_EQ(gimenc("--bytes 10 --grid 65" + sphere + out).code, 3);
    EXPECT_EQ(gimenc("--psnr 150 --grid 33" + sphere + out).code, 3);
    for (const char* option : {"--effort 0", "--effort 10", "--effort x", "--tolerance 1e-3"})
        EXPECT_EQ(gimenc("--bytes 2000 " + std::string(option) + sphere + out).code, 2) << option;
    for (const char* error : {"0", "1", "-1e-3", "x"})
        EXPECT_EQ(gimenc("--max-error " + std::string(error) + sphere + out).code, 2) << error;
    EXPECT_EQ(gimenc("--max-error 1e-9 --grid 33" + sphere + out).code, 3);
    const Ended unwritable = gimenc("--bytes 2000 --grid 33" + sphere + " /nonexistent/out.gim");
    EXPECT_EQ(unwritable.code, 1);
    EXPECT_THAT(unwritable.err, HasSubstr("/nonexistent/out.gim"));
}

TEST_F(Gimenc, RefusalLeavesAnEarlierFileAlone)
{
    write("keep.gim", "earlier");
    EXPECT_EQ(
        gimenc("--bytes 2000" + std::string(" '") + write("empty.ply", "") + "'" + file("keep.gim")).code, 1);
    EXPECT_EQ(gimenc("--bytes 10 --grid 33" + mesh("s.ply", shapes::sphere(1, 4)) + file("keep.gim")).code,
              3);
    EXPECT_EQ(read(path("keep.gim")), "earlier");
}

TEST_F(Gimenc, SeveralComponentsAreRefusedUnlessTheLargestIsAskedFor)
{
    Mesh two = shapes::sphere(1, 4);
    const int offset = two.vertexCount();
    const Mesh torus = shapes::torus(5, 1, 24, 12);
    for (const Vec3& p : torus.positions) two.positions.push_back(p);
    for (const Triangle& f : torus.faces) two.faces.push_back({f[0] + offset, f[1] + offset, f[2] + offset});
    const std::string input = mesh("two.off", two);
    const Ended refused = gimenc("--bytes 2000 --grid 65" + input + file("two.gim"));
    EXPECT_EQ(refused.code, 1);
    EXPECT_THAT(refused.err, HasSubstr("2 connected components"));
    const Ended taken =
        gimenc("--bytes 2000 --grid 65 --component largest --json -" + input + file("two.gim"));
    ASSERT_EQ(taken.code, 0) << taken.err;
    EXPECT_EQ(nlohmann::json::parse(taken.out).at("genus"), 1);
    EXPECT_FALSE(nlohmann::json::parse(taken.out).at("warnings").empty());
}

TEST_F(Gimenc, HandlesAndHolesGoWhereAskedFor)
{
    const Mesh surface = shapes::surfaceOfGenus(1, 2, 4);
    const std::string input = mesh("surface.ply", surface), output = file("surface.gim");
    const Ended kept =
        gimenc("--bytes 1500 --grid 33 --max-genus auto --close-holes 0.1% --json -" + input + output);
    ASSERT_EQ(kept.code, 0) << kept.err;
    EXPECT_EQ(kept.err, "");
    const auto before = nlohmann::json::parse(kept.out);
    EXPECT_EQ(before.at("genus"), 1);
    EXPECT_EQ(before.at("boundaries"), 2);
    EXPECT_TRUE(before.at("removed_handles").empty());
    EXPECT_TRUE(before.at("closed_holes").empty());

    const Ended gone =
        gimenc("--bytes 1500 --grid 33 --max-genus 0 --close-holes 100% --json -" + input + output);
    ASSERT_EQ(gone.code, 0) << gone.err;
    EXPECT_THAT(gone.err, HasSubstr("2 holes closed, 0 of them cracks: loops "));
    EXPECT_THAT(gone.err, HasSubstr("1 handle removed, genus 1 became 0: loop "));
    const auto after = nlohmann::json::parse(gone.out);
    EXPECT_EQ(after.at("genus"), 0);
    EXPECT_EQ(after.at("boundaries"), 0);
    ASSERT_EQ(after.at("closed_holes").size(), 2u);
    for (const auto& hole : after.at("closed_holes")) {
        EXPECT_GE(hole.at("edges"), 3);
        EXPECT_EQ(hole.at("zipped"), 0);
    }
    ASSERT_EQ(after.at("removed_handles").size(), 1u);
    const auto& handle = after.at("removed_handles")[0];
    EXPECT_NEAR(handle.at("length").get<double>(),
                handle.at("fraction").get<double>() * boundingBoxDiagonal(surface), 1e-6);
    EXPECT_EQ(handle.at("at").size(), 3u);
    // PSNR is from the surface as it was read.
    ASSERT_EQ(run(GIMDEC_PATH, output + file("decoded.obj")).code, 0);
    const Ended compared = run(GIMRD_PATH, "compare --json" + input + file("decoded.obj"));
    EXPECT_NEAR(after.at("psnr").get<double>(), nlohmann::json::parse(compared.out).at("psnr").get<double>(),
                0.02);
}

TEST_F(Gimenc, PsnrAskedForIsFromTheSurfaceAsRead)
{
    Mesh surface = shapes::sphere(1, 10);
    std::erase_if(surface.faces, [&](const Triangle& f) { return surface.positions[f[0]][2] > 0.985; });
    const std::string input = mesh("open.ply", surface), output = file("open.gim");
    const Ended met = gimenc("--psnr 48 --grid 65 --close-holes 200% --json -" + input + output);
    ASSERT_EQ(met.code, 0) << met.err;
    EXPECT_GE(nlohmann::json::parse(met.out).at("psnr"), 48);
    EXPECT_LE(nlohmann::json::parse(met.out).at("psnr"), 48.2);
    const Ended unmet = gimenc("--psnr 60 --grid 65 --close-holes 200%" + input + output);
    EXPECT_EQ(unmet.code, 3);
    EXPECT_THAT(unmet.err,
                HasSubstr("60.00 dB cannot be reached: without its holes and handles the surface is 5"));
}

TEST_F(Gimenc, WhatItWritesDecodesToTheSurfaceItMeasured)
{
    const std::string input = mesh("shape.ply", shapes::surfaceOfGenus(1, 2, 8));
    const Ended encoded = gimenc("--psnr 50 --grid 129 --json -" + input + file("shape.gim"));
    ASSERT_EQ(encoded.code, 0) << encoded.err;
    ASSERT_EQ(run(GIMDEC_PATH, file("shape.gim") + file("decoded.obj")).code, 0);
    const Ended compared = run(GIMRD_PATH, "compare --json" + input + file("decoded.obj"));
    ASSERT_EQ(compared.code, 0) << compared.err;
    const double claimed = nlohmann::json::parse(encoded.out).at("psnr");
    const double measured = nlohmann::json::parse(compared.out).at("psnr");
    EXPECT_NEAR(claimed, measured, 0.02);
    EXPECT_GE(claimed, 50);
    EXPECT_LE(claimed, 50.2);
}

// A torus whose sides meet, 33 samples a side.
FloatImage torusImage()
{
    FloatImage image{33, 33, {}};
    for (int j = 0; j < 33; ++j)
        for (int i = 0; i < 33; ++i) {
            const double u = i % 32 * M_PI / 16, v = j % 32 * M_PI / 16;
            for (const double x :
                 {(3 + std::cos(v)) * std::cos(u), (3 + std::cos(v)) * std::sin(u), std::sin(v)})
                image.samples.push_back(static_cast<float>(x));
        }
    return image;
}

TEST_F(Gimenc, GeometryImagesAreCodedAlongTheirSeam)
{
    ASSERT_TRUE(writeF32(torusImage(), path("torus.f32")).ok());
    ASSERT_TRUE(writeExr(torusImage(), path("torus.exr")).ok());
    std::set<std::string> files;
    for (const std::string name : {"torus.f32", "torus.exr"}) {
        const Ended ended = gimenc("--from-image" + file(name) + " --bytes 600 --json -" + file("torus.gim"));
        ASSERT_EQ(ended.code, 0) << ended.err;
        const auto json = nlohmann::json::parse(ended.out);
        EXPECT_EQ(json.at("image").at("sides"), 4);
        EXPECT_EQ(json.at("image").at("border_steps"), 128);
        EXPECT_EQ(json.at("image").at("glued_steps"), 128);
        EXPECT_EQ(json.at("layout"), "image");
        EXPECT_EQ(json.at("genus"), 1);
        EXPECT_EQ(json.at("boundaries"), 0);
        EXPECT_EQ(json.at("grid"), 33);
        EXPECT_GT(json.at("psnr"), 55);
        files.insert(read(path("torus.gim")));
    }
    EXPECT_EQ(files.size(), 1U);
}

TEST_F(Gimenc, GeometryImagesThatAreNoneAreRefusedAndOpenBordersTold)
{
    FloatImage image = torusImage();
    const auto refusal = [&](const std::string& name, const std::string& options = "--bytes 600") {
        const Ended ended = gimenc("--from-image " + options + file(name) + file("out.gim"));
        return std::to_string(ended.code) + ' ' + ended.err;
    };
    write("size.f32", std::string(3 * 4 * 33 * 33 - 4, 'x'));
    EXPECT_THAT(refusal("size.f32"), testing::AllOf(testing::StartsWith("1 "), HasSubstr("3 n^2")));
    EXPECT_THAT(refusal("none.f32"), testing::AllOf(testing::StartsWith("1 "), HasSubstr("cannot be read")));
    EXPECT_THAT(refusal("none.exr"), testing::AllOf(testing::StartsWith("1 "), HasSubstr("no such file")));
    EXPECT_THAT(refusal("mesh.ply"), testing::AllOf(testing::StartsWith("1 "), HasSubstr(".exr or .f32")));
    ASSERT_TRUE(writeF32({32, 32, std::vector<float>(3 * 32 * 32)}, path("side.f32")).ok());
    EXPECT_THAT(refusal("side.f32"), testing::AllOf(testing::StartsWith("1 "), HasSubstr("2^j + 1")));
    ASSERT_TRUE(writeF32(image, path("torus.f32")).ok());
    EXPECT_THAT(refusal("torus.f32", "--bytes 600 --grid 65"),
                testing::AllOf(testing::StartsWith("2 "), HasSubstr("--grid is for meshes")));
    EXPECT_THAT(refusal("torus.f32", "--bytes 600 --tolerance 2"), testing::StartsWith("2 "));
    for (int k = 0; k < 33; ++k) image.samples[3 * k] += 0.1f, image.samples[3 * 33 * k] += 0.1f;
    ASSERT_TRUE(writeF32(image, path("torus.f32")).ok());
    EXPECT_THAT(refusal("torus.f32"), testing::AllOf(testing::StartsWith("0 "), HasSubstr("coded as open")));
    image.samples[100] = std::numeric_limits<float>::quiet_NaN();
    ASSERT_TRUE(writeExr(image, path("nan.exr")).ok());
    EXPECT_THAT(refusal("nan.exr"), testing::AllOf(testing::StartsWith("1 "), HasSubstr("not finite")));
}

} // namespace
} // namespace gimg

// gimrd bench, with peers of the test's own making.
#include "corpus/shapes.h"
#include "gimg/mesh_io.h"
#include "temporary_files.h"
#include "tools/gimrd/subdivide.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <sys/wait.h>

namespace gimg {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Bench : public test::TemporaryFiles
{
protected:
    struct Ended
    {
        int code;
        std::string err;
        json report;
    };
    Ended run(const std::string& arguments)
    {
        const std::string command = "GIMRD_ADAPTERS='" + path("adapters") + "' " + GIMRD_PATH +
                                    " bench --json '" + path("json") + "' " + arguments + " > '" +
                                    path("out") + "' 2> '" + path("err") + "'";
        const int status = std::system(command.c_str());
        return {WEXITSTATUS(status), read(path("err")), json::parse(read(path("json")), nullptr, false)};
    }
    std::string torus(int bytes = 2000)
    {
        EXPECT_TRUE(writeMesh(shapes::torus(2, 1, 40, 20), path("torus.ply")).ok());
        return "--mesh '" + path("torus.ply") + "' --grid 65 --bytes " + std::to_string(bytes) + ' ';
    }
    // An adapter in the shell. `time` is what it does when it is to time.
    void adapter(const std::string& name, const std::string& input, const std::string& missing,
                 const std::string& time)
    {
        std::filesystem::create_directories(path("adapters"));
        const std::string file =
            write("adapters/" + name, "#!/bin/sh\nif [ $1 = describe ]; then\necho '{\"name\":\"" + name +
                                          "\",\"title\":\"" + name + "\",\"input\":\"" + input +
                                          "\",\"side\":\"peer\",\"codec\":\"" + name +
                                          "\",\"packages\":[],\"missing\":[" + missing +
                                          "],\"uses_grid\":false}'\nexit\nfi\ninput=$2\nruns=$6\n" + time);
        std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    }
    // Takes 100 ms the first time and 7 (encoding) and 3 (decoding) from then on; says `bytes`.
    static std::string steady(const std::string& bytes)
    {
        return "e=100; d=100; i=1\nwhile [ $i -lt $runs ]; do e=$e,7; d=$d,3; i=$((i+1)); done\n"
               "echo '{\"bytes\":'" +
               bytes + "',\"encode_ms\":['$e'],\"decode_ms\":['$d'],\"note\":\"made up\"}'\n";
    }
};

TEST_F(Bench, ReportsTimesMemoryAndScaling)
{
    // Instead of a size, the peers tell what they were given.
    adapter("mesh", "mesh", "", steady("$(grep -a 'element face' \"$input\" | tr -dc 0-9)"));
    adapter("image", "image", "", steady("$(wc -c < \"$input\")"));
    adapter("absent", "mesh", "\"libabsent-dev\"", "exit 1\n");
    const Ended ended = run(torus() + "--runs 2 --scaling 1,4 --grids 33,65");
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("libabsent-dev"));
    EXPECT_THAT(read(path("out")), HasSubstr("libabsent-dev"));
    const json& r = ended.report;

    EXPECT_GE(r.at("machine").at("cores"), 1);
    EXPECT_GT(r.at("machine").at("memory"), 1 << 28);
    for (const char* key : {"cpu", "os", "compiler"})
        EXPECT_FALSE(r.at("machine").at(key).get<std::string>().empty());
    EXPECT_EQ(r.at("mesh").at("name"), "torus.ply");
    EXPECT_EQ(r.at("mesh").at("faces"), 1600);
    EXPECT_LE(r.at("gim").at("bytes"), 2000);
    EXPECT_GT(r.at("gim").at("psnr"), 35);
    EXPECT_EQ(r.at("gim").at("triangles"), 2 * 64 * 64);
    EXPECT_EQ(r.at("gim").at("vertices"), 64 * 64); // Euler's number of a torus is 0

    const json& decode = r.at("decode");
    EXPECT_GT(decode.at("gim_samples_ms"), 0);
    EXPECT_GT(decode.at("gim_positions_ms"), decode.at("gim_samples_ms"));
    EXPECT_GT(decode.at("gim_ms"), decode.at("gim_positions_ms"));
    EXPECT_EQ(decode.at("mesh_ms"), 3); // without the first run of each call
    EXPECT_EQ(decode.at("image_ms"), 3);
    EXPECT_EQ(r.at("decode_mesh").at("mesh_ms"), 3);
    EXPECT_EQ(r.at("encode").at("mesh_ms"), 7);
    EXPECT_EQ(r.at("encode").at("image_ms"), 7);
    double stages = 0;
    for (const char* key : {"cut", "parameterize", "sample", "code"})
        stages += r.at("gim_stages_ms").at(key).get<double>();
    EXPECT_NEAR(stages / r.at("encode").at("gim_ms").get<double>(), 1, 0.5); // medians of two runs

    const json& spread = r.at("spread").at("decode");
    EXPECT_EQ(spread.at("gim_ms").at("runs"), 2);
    EXPECT_EQ(spread.at("mesh_ms").at("runs"), 2);
    EXPECT_LE(spread.at("gim_ms").at("min"), spread.at("gim_ms").at("median"));
    EXPECT_LE(spread.at("gim_ms").at("median"), spread.at("gim_ms").at("max"));

    ASSERT_EQ(r.at("peers").size(), 2U);
    EXPECT_EQ(r.at("peers")[0].at("image_bytes"), 3 * 65 * 65 * 4);
    EXPECT_EQ(r.at("peers")[1].at("mesh_bytes"), 1600);
    EXPECT_EQ(r.at("peers")[1].at("equal_mesh_bytes"), 8192);
    ASSERT_EQ(r.at("skipped").size(), 1U);
    EXPECT_EQ(r.at("skipped")[0].at("missing")[0], "libabsent-dev");

    const json& memory = r.at("memory");
    EXPECT_EQ(memory.at("gim_decode_output_bytes"), 4 * (3 * 65 * 65 + 4096 + 3 * 8192));
    EXPECT_GT(memory.at("gim_workspace_bytes"), 3 * 65 * 65 * 4);
    EXPECT_GT(memory.at("gim_encode_bytes"), memory.at("gim_decode_bytes"));
    EXPECT_GT(memory.at("gim_decode_bytes"), 1 << 20);

    ASSERT_EQ(r.at("scaling").size(), 2U);
    EXPECT_EQ(r.at("scaling")[0].at("faces"), 1600);
    EXPECT_EQ(r.at("scaling")[1].at("faces"), 6400);
    for (const json& step : r.at("scaling")) {
        EXPECT_GT(step.at("encode_ms"), 0);
        EXPECT_GT(step.at("decode_ms"), 0);
        EXPECT_EQ(step.at("mesh_encode_ms"), 7);
        EXPECT_EQ(step.at("mesh_decode_ms"), 3);
    }
    ASSERT_EQ(r.at("decode_scaling").size(), 2U);
    EXPECT_EQ(r.at("decode_scaling")[0].at("triangles"), 2 * 32 * 32);
    EXPECT_LE(r.at("decode_scaling")[0].at("bytes"), 500);
    EXPECT_EQ(r.at("decode_scaling")[1].at("gim_ms"), decode.at("gim_ms"));
    EXPECT_EQ(r.at("decode_scaling")[0].at("mesh_ms"), 3);
    EXPECT_FALSE(r.at("decode_scaling")[1].contains("image_ms"));
    EXPECT_TRUE(r.at("failed").empty());
}

TEST_F(Bench, WhatFailsIsReportedAndTheRestMeasured)
{
    adapter("broken", "mesh", "", "echo 'broken: out of luck' >&2\nexit 3\n");
    const Ended ended = run(torus() + "--runs 1 --scaling none --grids 5");
    EXPECT_EQ(ended.code, 1);
    EXPECT_THAT(ended.err, HasSubstr("out of luck"));
    EXPECT_GT(ended.report.at("decode").at("gim_ms"), 0);
    EXPECT_FALSE(ended.report.at("decode").contains("broken_ms"));
    const json& failed = ended.report.at("failed");
    ASSERT_EQ(failed.size(), 3U); // encoding, decoding, and a grid that the cut does not fit
    EXPECT_EQ(failed[0].at("section"), "encode");
    EXPECT_EQ(failed[1].at("section"), "decode");
    EXPECT_EQ(failed[2].at("section"), "decode scaling 5");
    EXPECT_TRUE(ended.report.at("decode_scaling")[0].contains("failed"));
}

TEST_F(Bench, ANormalImageTakesThePlaceOfNormalsFromTheMesh)
{
    const Ended ended = run(torus() + "--peers none --runs 1 --scaling none --grids none --normals 33");
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(ended.report.at("gim").at("normal_grid"), 33);
    EXPECT_EQ(ended.report.at("memory").at("gim_decode_output_bytes"),
              4 * (3 * 65 * 65 + 3 * 33 * 33 + 4096 + 3 * 8192));
    EXPECT_TRUE(ended.report.at("peers").empty());
}

TEST_F(Bench, ExitCodesTellRefusedUsageAndUnreachableApart)
{
    adapter("some", "mesh", "", "exit 1\n");
    EXPECT_EQ(run(torus() + "--scaling 1,3").code, 2);
    EXPECT_EQ(run(torus() + "--grids 129,256").code, 2);
    EXPECT_EQ(run(torus() + "--grid 100").code, 2);
    EXPECT_EQ(run(torus() + "--runs 0").code, 2);
    EXPECT_EQ(run(torus() + "--peers other").code, 2);
    EXPECT_EQ(run("--peers none --mesh /nonexistent.ply").code, 1);
    EXPECT_EQ(run(torus(20) + "--peers none").code, 3);
    EXPECT_EQ(run("").code, 2);
}

TEST(Subdivide, KeepsTheSurface)
{
    const Mesh coarse = shapes::cylinder(1, 3, 12, 5);
    const Mesh fine = gimrd::subdivide(coarse);
    const Topology before = topology(coarse), after = topology(fine);
    EXPECT_EQ(after.faces, 4 * before.faces);
    EXPECT_EQ(after.vertices, before.vertices + before.edges);
    EXPECT_EQ(after.boundaries, before.boundaries);
    EXPECT_EQ(after.genus, before.genus);
    EXPECT_NEAR(surfaceArea(fine), surfaceArea(coarse), 1e-12 * surfaceArea(coarse));
}

} // namespace
} // namespace gimg

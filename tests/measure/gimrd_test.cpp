// The command line of gimrd, run as a user does.
#include "gimg/mesh_io.h"
#include "shapes.h"
#include "temporary_files.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
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

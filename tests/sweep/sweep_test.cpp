// gimrd sweep, run as a user does: whole, killed, in parts, with coders that misbehave.
#include "corpus/shapes.h"
#include "gimg/decode.h"
#include "gimg/mesh_io.h"
#include "shapes.h"
#include "temporary_files.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <map>
#include <thread>

using namespace gimg;
using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

namespace {

// Without printing a whole report where it does not hold.
bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

constexpr auto kPause = std::chrono::milliseconds(10);

class Sweep : public test::TemporaryFiles
{
protected:
    struct Ended
    {
        int code = -1;
        std::string out, err;
    };

    // A folder of adapters of its own, so that tests do not depend on what is installed.
    Sweep()
    {
        fs::create_directories(path("adapters"));
        fs::create_symlink(GIM_ADAPTER, path("adapters/gim"));
        fs::create_symlink(RAW_ADAPTER, path("adapters/raw"));
        mesh("ring.ply", test::torus(2, 0.7, 24, 12));
        mesh("tube.ply", test::torus(3, 0.4, 32, 8));
    }

    void mesh(const std::string& name, const Mesh& mesh) { ASSERT_TRUE(writeMesh(mesh, path(name)).ok()); }

    // An adapter that is a shell script. `encode` runs for each size N, with the input and the folder.
    void script(const std::string& name, const std::string& encode, const std::string& missing = "")
    {
        const std::string place = write(
            "adapters/" + name, "#!/bin/sh\nif [ $1 = describe ]; then\n"
                                "  echo '{\"name\":\"" +
                                    name + "\",\"title\":\"The " + name +
                                    "\",\"input\":\"mesh\",\"side\":\"peer\","
                                    "\"codec\":\"x\",\"packages\":[],\"missing\":[" +
                                    missing +
                                    "],\"uses_grid\":false}'\n"
                                    "  exit 0\nfi\nINPUT=$2 OUT=$3\nfor N in $(echo $5 | tr , ' '); do\n" +
                                    encode + "\ndone\n");
        fs::permissions(place, fs::perms::owner_all);
    }
    // What such a script does to deliver its input, in a file of $SIZE bytes.
    static std::string deliver(const std::string& size = "$N", const std::string& decode = "cp $INPUT")
    {
        return "head -c " + size + " /dev/zero > $OUT/$N.bin; " + decode +
               " $OUT/$N.ply; "
               "echo \"{\\\"target\\\":$N,\\\"bytes\\\":$(wc -c < $OUT/$N.bin),\\\"file\\\":\\\"$N.bin\\\","
               "\\\"decoded\\\":\\\"$N.ply\\\",\\\"settings\\\":{}}\"";
    }

    pid_t start(const std::string& arguments)
    {
        const std::string words = "cd '" + path("") + "' && exec env GIMRD_ADAPTERS='" + path("adapters") +
                                  "' " + GIMRD_PATH + " sweep " + arguments;
        const pid_t child = fork();
        if (child != 0) return child;
        const int out = open(path("out").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        const int err = open(path("err").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        dup2(out, STDOUT_FILENO);
        dup2(err, STDERR_FILENO);
        execl("/bin/sh", "sh", "-c", words.c_str(), nullptr);
        _exit(127);
    }
    Ended wait(pid_t child)
    {
        int status = 0;
        waitpid(child, &status, 0);
        return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read(path("out")),
                read(path("err"))};
    }
    Ended run(const std::string& arguments) { return wait(start(arguments)); }

    // All files of a folder that a reader looks at.
    std::map<std::string, std::string> files(const std::string& folder) const
    {
        std::map<std::string, std::string> contents;
        for (const auto& entry : fs::recursive_directory_iterator(path(folder))) {
            const std::string name = entry.path().lexically_relative(path(folder)).string();
            if (entry.is_regular_file() && !name.starts_with("work/running-"))
                contents[name] = read(entry.path().string());
        }
        return contents;
    }
    void expectSame(const std::string& a, const std::string& b) const
    {
        const auto left = files(a), right = files(b);
        for (const auto& [name, bytes] : left) {
            ASSERT_TRUE(right.contains(name)) << name;
            EXPECT_EQ(bytes == right.at(name), true) << name << " differs";
        }
        EXPECT_EQ(left.size(), right.size());
    }
    nlohmann::json point(const std::string& place) const
    {
        return nlohmann::json::parse(read(path(place)), nullptr, false);
    }
    // Until a file is there.
    bool appears(const std::string& place) const
    {
        for (int i = 0; i < 3000 && !fs::exists(path(place)); ++i) std::this_thread::sleep_for(kPause);
        return fs::exists(path(place));
    }
};

const std::string kSmall = " --bytes 500,900 --grids 17 --samples 2000 ";

} // namespace

TEST_F(Sweep, NumbersAreThoseOfCompare)
{
    const Ended ended = run("ring.ply tube.ply" + kSmall + "--keep --out o");
    ASSERT_EQ(ended.code, 0) << ended.err;
    for (const char* file : {"o/results.csv", "o/results.json", "o/report.html", "o/mean.svg", "o/mean.png",
                             "o/curves/ring.svg", "o/curves/tube.png", "o/thumbnails/ring/original.png"})
        EXPECT_GT(fs::file_size(path(file)), 100U) << file;
    const Result<FloatImage> image = readF32(path("o/work/ring/raw-zlib-17-900-decoded.f32"));
    ASSERT_TRUE(image.ok());
    mesh("raw.ply", gridMesh(*image));
    for (const auto& [decoded, series] : {std::pair("o/work/ring/gim-17-900-decoded.ply", "gim,17,900,"),
                                          std::pair("raw.ply", "raw-zlib,17,900,")}) {
        const std::string command = std::string(GIMRD_PATH) + " compare --json --samples 2000 " +
                                    path("ring.ply") + ' ' + path(decoded) + " > " + path("compared");
        ASSERT_EQ(std::system(command.c_str()), 0);
        const auto compared = nlohmann::json::parse(read(path("compared")));
        const std::string csv = read(path("o/results.csv"));
        const size_t at = csv.find(std::string("\nring,") + series + "done,");
        ASSERT_NE(at, std::string::npos) << csv;
        std::istringstream fields(csv.substr(at + 1));
        std::vector<std::string> values;
        for (std::string value; values.size() < 12 && std::getline(fields, value, ',');)
            values.push_back(value);
        EXPECT_LE(std::stoi(values[5]), 900);
        EXPECT_DOUBLE_EQ(std::stod(values[6]), compared.at("psnr"));
        EXPECT_DOUBLE_EQ(std::stod(values[7]), compared.at("rms_ref_to_test"));
        EXPECT_DOUBLE_EQ(std::stod(values[8]), compared.at("rms_test_to_ref"));
        EXPECT_DOUBLE_EQ(std::stod(values[11]), compared.at("hausdorff"));
    }
    const auto before = files("o");
    const Ended again = run("tube.ply ring.ply" + kSmall + "--jobs 3 --out o");
    EXPECT_EQ(again.code, 0);
    EXPECT_EQ(again.err, ""); // nothing to do
    EXPECT_EQ(before == files("o"), true);
}

TEST_F(Sweep, KilledOrInPartsItEndsWithTheSameFiles)
{
    script("slow", "sleep 0.15; " + deliver());
    const std::string what = "ring.ply tube.ply" + kSmall + "--coders none --peers raw-zlib,slow --out ";
    ASSERT_EQ(run(what + "whole").code, 0);

    const pid_t sweep = start(what + "killed");
    ASSERT_TRUE(appears("killed/points/ring/slow-500.json"));
    kill(sweep, SIGKILL);
    EXPECT_EQ(wait(sweep).code, 128 + SIGKILL);
    EXPECT_FALSE(fs::exists(path("killed/results.csv")));
    ASSERT_EQ(run(what + "killed --jobs 1").code, 0);
    expectSame("whole", "killed");
    for (const auto& entry : fs::directory_iterator(path("killed/work")))
        EXPECT_THAT(entry.path().filename().string(), Not(HasSubstr("running"))); // what the killed one left

    EXPECT_EQ(run(what + "parts --part 2/2").code, 0);
    EXPECT_FALSE(fs::exists(path("parts/results.csv")));
    EXPECT_EQ(run(what + "parts --part 1/2").code, 0);
    const Ended merged = run(what + "parts");
    EXPECT_EQ(merged.code, 0);
    EXPECT_EQ(merged.err, "");
    expectSame("whole", "parts");
}

TEST_F(Sweep, SignalsEndTheCodersToo)
{
    script("slow",
           "echo $$ > $OUT/pid; mv $OUT/pid " + path("pid") + "; [ $N = 500 ] || sleep 60; " + deliver());
    for (const int signal : {SIGTERM, SIGINT}) {
        fs::remove_all(path("o"));
        const pid_t sweep = start("ring.ply" + kSmall + "--coders none --peers slow --out o");
        ASSERT_TRUE(appears("o/points/ring/slow-500.json"));
        kill(sweep, signal);
        const Ended ended = wait(sweep);
        EXPECT_EQ(ended.code, 128 + signal);
        EXPECT_THAT(ended.err, HasSubstr("stopped"));
        const pid_t coder = std::stoi(read(path("pid")));
        for (int i = 0; i < 300 && kill(coder, 0) == 0; ++i) std::this_thread::sleep_for(kPause);
        EXPECT_NE(kill(coder, 0), 0);
        EXPECT_EQ(point("o/points/ring/slow-500.json").at("state"), "done");
        EXPECT_EQ(std::distance(fs::directory_iterator(path("o/points/ring")), {}), 1);
    }
}

TEST_F(Sweep, ChangedMeshIsNotMixed)
{
    script("copy", deliver());
    const std::string what = "ring.ply" + kSmall + "--coders none --peers copy --out o";
    ASSERT_EQ(run(what).code, 0);
    const auto before = point("o/points/ring/copy-500.json");
    mesh("ring.ply", test::torus(2, 0.9, 24, 12));
    const Ended ended = run(what);
    EXPECT_EQ(ended.code, 0);
    EXPECT_THAT(ended.err, HasSubstr("ring has changed"));
    const auto after = point("o/points/ring/copy-500.json");
    EXPECT_NE(before.at("sha256"), after.at("sha256"));
    EXPECT_NE(before.at("diagonal"), after.at("diagonal"));
    EXPECT_THAT(read(path("o/results.json")), Not(HasSubstr(before.at("sha256"))));
}

TEST_F(Sweep, FailingMeshDoesNotStopTheOthers)
{
    write("broken.ply", "ply\nformat ascii 1.0\nnonsense\n");
    Mesh fin = test::square(2); // three faces on an edge: coders of any triangles take it, ours does not
    fin.positions.emplace_back(0.2, 0.2, 1.0);
    fin.faces.push_back({0, 4, fin.vertexCount() - 1});
    mesh("fin.ply", fin);
    script("copy", deliver());
    const Ended ended = run("broken.ply none.ply fin.ply ring.ply" + kSmall + "--peers copy --out o");
    EXPECT_EQ(ended.code, 1);
    EXPECT_EQ(point("o/points/broken/copy-500.json").at("state"), "failed");
    EXPECT_EQ(point("o/points/none/gim-17-900.json").at("message"), "none.ply: no such file");
    EXPECT_EQ(point("o/points/fin/copy-500.json").at("state"), "done");
    EXPECT_THAT(point("o/points/fin/gim-17-500.json").at("message"), HasSubstr("fin.ply: "));
    EXPECT_EQ(point("o/points/ring/gim-17-500.json").at("state"), "done");
    const std::string html = read(path("o/report.html"));
    EXPECT_TRUE(contains(html, "<li>broken, The copy, 500, 900 bytes: failed: broken.ply: "));
    for (const char* file : {"o/report.html", "o/results.csv", "o/results.json"})
        EXPECT_FALSE(contains(read(path(file)), path(""))) << file; // no folders of this machine

    // Failed points are tried again.
    fs::copy_file(path("tube.ply"), path("none.ply"));
    const Ended again = run("broken.ply none.ply fin.ply ring.ply" + kSmall + "--peers copy --out o");
    EXPECT_EQ(again.code, 1);
    EXPECT_EQ(point("o/points/none/gim-17-900.json").at("state"), "done");
    EXPECT_THAT(again.err, Not(HasSubstr("ring gim")));
}

TEST_F(Sweep, AGridTooSmallForTheCutIsNoFailure)
{
    mesh("ladder.ply", shapes::surfaceOfGenus(7, 0, 4));
    const Ended ended = run(
        "ladder.ply ring.ply --bytes 900 --grids 9 --samples 2000 --coders none --peers raw-zlib --out o");
    EXPECT_EQ(ended.code, 0) << ended.err;
    const nlohmann::json ladder = point("o/points/ladder/raw-zlib-9-900.json");
    EXPECT_EQ(ladder.at("state"), "unreachable");
    EXPECT_THAT(ladder.at("message"), HasSubstr("too much for a grid of 9"));
    EXPECT_EQ(point("o/points/ring/raw-zlib-9-900.json").at("state"), "done");
}

TEST_F(Sweep, CodersThatMisbehaveAreReported)
{
    script("crash", "[ $N = 500 ] || kill -SEGV $$; " + deliver());
    script("garbage", "echo Segmentation fault; printf 'no \\377 tf-8\\n'");
    script("large", deliver("$((N + 1))"));
    script("liar", deliver() + " | sed 's/\"bytes\":[0-9]*/\"bytes\":1/'");
    script("lazy", ":");
    script("strange",
           "echo '{\"target\":500,\"bytes\":4,\"file\":\"../x\",\"decoded\":\"y\",\"settings\":{}}'");
    script("empty", deliver("$N", ": >"));
    script("small", "echo \"{\\\"target\\\":$N,\\\"unreachable\\\":\\\"too small\\\"}\"");
    script("copy", deliver());
    const std::string peers = "--peers copy,crash,empty,garbage,large,lazy,liar,small,strange ";
    const Ended ended = run("ring.ply" + kSmall + "--coders none " + peers + "--out o");
    EXPECT_EQ(ended.code, 1);
    const auto message = [&](const std::string& stem) {
        const auto json = point("o/points/ring/" + stem + ".json");
        EXPECT_EQ(json.at("state"), "failed") << stem;
        return json.at("message").get<std::string>();
    };
    EXPECT_EQ(point("o/points/ring/crash-500.json").at("state"), "done");
    EXPECT_EQ(message("crash-900"), "adapter crash: ended by signal 11");
    EXPECT_THAT(message("garbage-500"), HasSubstr("does not speak the adapters' protocol"));
    EXPECT_EQ(message("large-500"), "made a file of 501 bytes");
    EXPECT_THAT(message("liar-500"), HasSubstr("does not have the 1 bytes"));
    EXPECT_EQ(message("lazy-900"), "the coder gave no answer for this size");
    EXPECT_THAT(message("strange-500"), HasSubstr("a file named '../x'"));
    EXPECT_THAT(message("empty-500"), HasSubstr("500.ply"));
    EXPECT_EQ(point("o/points/ring/small-500.json").at("state"), "unreachable");
    EXPECT_EQ(point("o/points/ring/copy-900.json").at("state"), "done");
    EXPECT_TRUE(point("o/points/ring/copy-900.json").at("psnr").is_null()); // infinite
    EXPECT_THAT(read(path("o/results.csv")), HasSubstr("\nring,copy,0,900,done,900,inf,0,0,"));
    const std::string html = read(path("o/report.html"));
    EXPECT_TRUE(contains(html, "<li>ring, The large, 900 bytes: failed: made a file of 901 bytes</li>"));
    // The message with bytes that are no text does not spoil the files.
    EXPECT_FALSE(nlohmann::json::parse(read(path("o/results.json")), nullptr, false).is_discarded());
}

TEST_F(Sweep, WhatIsNotInstalledIsSkippedWithANote)
{
    script("copy", deliver());
    script("absent", deliver(), "\"libabsent-dev\"");
    const std::string what = "ring.ply" + kSmall + "--coders none --out o";
    const Ended all = run("ring.ply" + kSmall + "--coders none --out o");
    EXPECT_EQ(all.code, 0) << all.err;
    EXPECT_THAT(all.err, HasSubstr("absent is not installed and skipped; Debian packages: libabsent-dev"));
    EXPECT_TRUE(contains(read(path("o/report.html")), "<code>libabsent-dev</code>"));
    EXPECT_FALSE(fs::exists(path("o/points/ring/absent-500.json")));
    EXPECT_EQ(run(what + " --peers absent,copy").code, 3); // asked for by name
    EXPECT_EQ(run(what + " --peers copy").code, 0);

    write("adapters/mute", "#!/bin/sh\nexit 4\n");
    fs::permissions(path("adapters/mute"), fs::perms::owner_all);
    const Ended broken = run(what);
    EXPECT_EQ(broken.code, 1);
    EXPECT_THAT(broken.err, HasSubstr("adapter mute: ended with status 4"));
    EXPECT_TRUE(contains(read(path("o/report.html")), "adapter mute"));
    EXPECT_EQ(run(what + " --peers copy").code, 0);
}

TEST_F(Sweep, GeometryImageIsItsOwnReference)
{
    FloatImage image{17, 17, {}};
    for (int j = 0; j < 17; ++j)
        for (int i = 0; i < 17; ++i)
            for (const int x : {i, j, i * j % 5}) image.samples.push_back(static_cast<float>(x));
    ASSERT_TRUE(writeF32(image, path("wavy.f32")).ok());
    script("copy", deliver());
    const Ended ended =
        run("wavy.f32 --bytes 900 --samples 2000 --coders none --peers copy,raw-zlib --out o");
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(point("o/points/wavy/raw-zlib-17-900.json").at("reference_faces"), 512);
    EXPECT_EQ(point("o/points/wavy/copy-900.json").at("faces"), 512);
    EXPECT_TRUE(point("o/points/wavy/copy-900.json").at("psnr").is_null());
}

TEST_F(Sweep, WrongUsageIsToldFromInput)
{
    const Ended unknown = run("ring.ply" + kSmall + "--peers dracco --out o");
    EXPECT_EQ(unknown.code, 2);
    EXPECT_EQ(unknown.err, "gimrd: --peers: no coder is called 'dracco'; there are raw-zlib\n");
    EXPECT_FALSE(fs::exists(path("o")));
    EXPECT_EQ(run("ring.ply --out o").code, 2);
    EXPECT_EQ(run("ring.ply ring.ply" + kSmall + "--out o").code, 2);
    EXPECT_EQ(run("ring.ply" + kSmall + "--part 3/2 --out o").code, 2);
    EXPECT_EQ(run("ring.ply --bytes 0 --out o").code, 2);
    EXPECT_EQ(run("ring.ply --bytes 500 --grids 32 --out o").code, 2);
    write("file", "");
    EXPECT_EQ(run("ring.ply" + kSmall + "--out file").code, 1);
}

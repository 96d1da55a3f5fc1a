// gimenc --batch and --resume, run as a user does.
#include "corpus/shapes.h"
#include "gimg/mesh_io.h"
#include "temporary_files.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <sys/wait.h>
#include <thread>

namespace gimg {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class Batch : public test::TemporaryFiles
{
protected:
    struct Ended
    {
        int code;
        std::string out, err;
    };
    // Runs in the test's folder, so that lists hold plain names.
    Ended gimenc(const std::string& arguments)
    {
        const std::string command = "cd '" + path("") + "' && " GIMENC_PATH " " + arguments + " > '" +
                                    path("stdout") + "' 2> '" + path("stderr") + "'";
        const int status = std::system(command.c_str());
        return {WEXITSTATUS(status), read(path("stdout")), read(path("stderr"))};
    }
    void mesh(const std::string& name, int resolution = 4)
    {
        ASSERT_TRUE(writeMesh(shapes::sphere(1, resolution), path(name)).ok());
    }
    nlohmann::json record(const std::string& output)
    {
        return nlohmann::json::parse(read(path(output + ".json")), nullptr, false);
    }
    bool exists(const std::string& name) { return fs::exists(path(name)); }
    // How often a file was written anew shows in its inode, whatever the clock's grain.
    ino_t inode(const std::string& name)
    {
        struct stat info = {};
        ::stat(path(name).c_str(), &info);
        return info.st_ino;
    }
    std::vector<std::string> lines(const std::string& name)
    {
        std::istringstream in(read(path(name)));
        std::vector<std::string> all;
        for (std::string line; std::getline(in, line);) all.push_back(line);
        return all;
    }
    int leftovers()
    {
        int count = 0;
        for (const auto& entry : fs::recursive_directory_iterator(path("")))
            count += entry.path().filename().string().starts_with(".gimenc-");
        return count;
    }
    pid_t start(const std::vector<std::string>& arguments)
    {
        const pid_t child = ::fork();
        if (child != 0) return child;
        std::vector<char*> words;
        for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
        words.push_back(nullptr);
        const int nothing = ::open("/dev/null", O_WRONLY);
        ::dup2(nothing, STDOUT_FILENO);
        ::dup2(nothing, STDERR_FILENO);
        if (::chdir(path("").c_str()) == 0) ::execv(GIMENC_PATH, words.data());
        ::_exit(127);
    }
    // A process that `parent` started; 0 if there is none yet.
    static pid_t childOf(pid_t parent)
    {
        std::error_code error;
        for (const auto& process : fs::directory_iterator("/proc", error)) {
            std::ifstream status(process.path() / "status");
            for (std::string word; status >> word;)
                if (word == "PPid:" && status >> word && word == std::to_string(parent))
                    return std::stoi(process.path().filename().string());
        }
        return 0;
    }
    static bool waitFor(const std::function<bool()>& condition)
    {
        for (int i = 0; i < 24000 && !condition(); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        return condition();
    }
};

TEST_F(Batch, MakesWhatPlainCallsMakeAndThenNothing)
{
    mesh("a.ply"), mesh("b c.obj", 5);
    write("list",
          "# two meshes\na.ply out/a.gim\n\n--bytes 500 'b c.obj' \"out/deep/b c.gim\" # the other\n");
    const Ended first = gimenc("--batch list --bytes 400 --grid 33 --jobs 2");
    ASSERT_EQ(first.code, 0) << first.err;
    EXPECT_THAT(first.out, HasSubstr("[2/2] "));
    EXPECT_THAT(first.out, HasSubstr("\n2 done, 0 already there, 0 failed\n"));
    ASSERT_EQ(gimenc("--bytes 400 --grid 33 a.ply plain.gim").code, 0);
    EXPECT_EQ(read(path("out/a.gim")), read(path("plain.gim")));
    ASSERT_EQ(gimenc("--bytes 500 --grid 33 'b c.obj' plain.gim").code, 0);
    EXPECT_EQ(read(path("out/deep/b c.gim")), read(path("plain.gim")));
    EXPECT_EQ(record("out/a.gim").at("output_bytes"), read(path("out/a.gim")).size());

    const ino_t file = inode("out/a.gim"), itsRecord = inode("out/a.gim.json");
    const Ended second = gimenc("--batch list --grid 33 --bytes 400 --threads 1");
    EXPECT_EQ(second.code, 0);
    EXPECT_EQ(second.out, "0 done, 2 already there, 0 failed\n");
    EXPECT_EQ(inode("out/a.gim"), file);
    EXPECT_EQ(inode("out/a.gim.json"), itsRecord);
    EXPECT_EQ(gimenc("--batch list --grid 33 --bytes 400 --quiet").out, "");
    EXPECT_EQ(leftovers(), 0);
}

TEST_F(Batch, RunsAgainWhatChanged)
{
    mesh("a.ply"), mesh("b.ply");
    write("list", "a.ply a.gim\nb.ply b.gim\n");
    const auto again = [&](const std::string& options) {
        return gimenc("--batch list --grid 33 " + options).out;
    };
    EXPECT_THAT(again("--bytes 400"), HasSubstr("2 done, 0 already there"));
    write("list", "a.ply a.gim --bytes 450\nb.ply b.gim\n"); // an option of one
    EXPECT_THAT(again("--bytes 400"), HasSubstr("1 done, 1 already there"));
    EXPECT_EQ(record("a.gim").at("options"), (std::vector{"--bytes", "450", "--grid", "33"}));
    fs::rename(path("b.ply"), path("c.ply")); // the same input elsewhere is the same input
    write("list", "a.ply a.gim --bytes 450\nc.ply b.gim\n");
    EXPECT_THAT(again("--bytes 400"), HasSubstr("0 done, 2 already there"));
    std::string input = read(path("c.ply")); // another input of the same size
    input[input.size() / 2] = static_cast<char>(input[input.size() / 2] ^ 1);
    write("c.ply", input);
    EXPECT_THAT(again("--bytes 400"), HasSubstr("1 done, 1 already there"));
    std::string output = read(path("b.gim")); // a damaged output of the same size
    const std::string good = output;
    output.back() = static_cast<char>(output.back() ^ 1);
    write("b.gim", output);
    EXPECT_THAT(again("--bytes 400"), HasSubstr("1 done, 1 already there"));
    EXPECT_EQ(read(path("b.gim")), good);
    fs::remove(path("b.gim"));
    EXPECT_THAT(again("--bytes 400"), HasSubstr("1 done, 1 already there"));
    auto older = record("a.gim");
    older["gimg"] = "0.0.1";
    write("a.gim.json", older.dump());
    write("b.gim.json", "{\"status\": [], \"options\": 3"); // not ours
    EXPECT_THAT(again("--bytes 400"), HasSubstr("2 done, 0 already there"));
}

TEST_F(Batch, AFailingLineStopsNoOtherAndDestroysNothing)
{
    mesh("a.ply"), mesh("good.ply");
    write("bad.ply", "not a mesh");
    write("b.gim", "earlier");
    write("list", "bad.ply b.gim\na.ply a.gim\nnone.ply n.gim\n--bytes 10 a.ply small.gim\n");
    const Ended ended = gimenc("--batch list --grid 33 --bytes 400");
    EXPECT_EQ(ended.code, 1);
    EXPECT_THAT(ended.out, HasSubstr("1 done, 0 already there, 3 failed"));
    EXPECT_THAT(ended.err, HasSubstr("gimenc: list: line 1: bad.ply: "));
    EXPECT_THAT(ended.err, HasSubstr("gimenc: list: line 3: none.ply: cannot be read\n"));
    EXPECT_THAT(ended.err, HasSubstr("gimenc: list: line 4: a.ply: "));
    EXPECT_FALSE(exists("b.gim"));
    EXPECT_EQ(read(path("b.gim.old")), "earlier");
    EXPECT_FALSE(exists("n.gim"));
    EXPECT_EQ(record("b.gim").at("status"), "failed");
    EXPECT_THAT(record("b.gim").at("error").get<std::string>(), HasSubstr("bad.ply"));

    fs::copy_file(path("good.ply"), path("bad.ply"), fs::copy_options::overwrite_existing);
    write("list", "bad.ply b.gim\na.ply a.gim\n");
    EXPECT_THAT(gimenc("--batch list --grid 33 --bytes 400").out,
                HasSubstr("1 done, 1 already there, 0 failed"));
    EXPECT_EQ(record("b.gim").at("status"), "done");
    // A result that nothing speaks against stays, although its input cannot be looked at.
    const std::string good = read(path("b.gim"));
    fs::remove(path("bad.ply"));
    EXPECT_EQ(gimenc("--batch list --grid 33 --bytes 400").code, 1);
    EXPECT_EQ(read(path("b.gim")), good);
    EXPECT_EQ(record("b.gim").at("status"), "done");
    // One of other options does not, but it and its record are kept.
    EXPECT_EQ(gimenc("--batch list --grid 33 --bytes 401").code, 1);
    EXPECT_FALSE(exists("b.gim"));
    EXPECT_EQ(read(path("b.gim.old")), good);
    EXPECT_EQ(record("b.gim.old").at("status"), "done");
}

TEST_F(Batch, AListThatCannotBeRunStartsNothing)
{
    mesh("a.ply");
    for (const char* list : {"a.ply a.gim\na.ply a.gim\n", "a.ply a.gim\na.ply a.ply\n",
                             "a.ply a.gim\n'a.ply b.gim\n", "a.ply a.gim\na.ply\n"}) {
        write("list", list);
        const Ended ended = gimenc("--batch list --bytes 400");
        EXPECT_EQ(ended.code, 2) << list;
        EXPECT_THAT(ended.err, HasSubstr("gimenc: list: line 2: ")) << list;
        EXPECT_FALSE(exists("a.gim")) << list;
    }
    EXPECT_EQ(gimenc("--batch none --bytes 400").code, 2);
    write("list", "a.ply a.gim\n");
    for (const char* arguments :
         {"--batch list", "--batch list --bytes 400 a.ply b.gim", "--batch list --bytes 400 --json -",
          "--batch list --bytes 400 --part 3/2", "--batch list --bytes 400 --jobs 0",
          "--batch list --bytes 400 --summary t.txt", "--batch list --bytes 400 --merge t.csv --part 1/2",
          "--part 1/2 --bytes 400 a.ply a.gim"})
        EXPECT_EQ(gimenc(arguments).code, 2) << arguments;
    EXPECT_FALSE(exists("a.gim"));
    write("list", "# nothing\n");
    EXPECT_EQ(gimenc("--batch list").out, "0 done, 0 already there, 0 failed\n");
}

TEST_F(Batch, PartsTogetherAreTheList)
{
    std::string list;
    for (int i = 0; i < 5; ++i) list += "none.ply " + std::to_string(i) + ".gim\n";
    write("list", list);
    EXPECT_EQ(gimenc("--batch list --bytes 400 --part 2/3").out,
              "part 2/3: 0 done, 0 already there, 2 failed\n");
    for (int i = 0; i < 5; ++i) EXPECT_EQ(exists(std::to_string(i) + ".gim.json"), i == 1 || i == 4) << i;
    const ino_t before = inode("4.gim.json");
    EXPECT_THAT(gimenc("--batch list --bytes 400 --part 1/3").out, HasSubstr("2 failed"));
    EXPECT_THAT(gimenc("--batch list --bytes 400 --part 3/3").out, HasSubstr("1 failed"));
    for (int i = 0; i < 5; ++i) EXPECT_TRUE(exists(std::to_string(i) + ".gim.json")) << i;
    EXPECT_EQ(inode("4.gim.json"), before);
}

TEST_F(Batch, SummaryHasARowALine)
{
    mesh("a.ply");
    write("b,\"c.ply", "not a mesh");
    write("list", "a.ply a.gim\nx.ply x.gim\n'b,\"c.ply' b.gim\n");
    EXPECT_EQ(gimenc("--batch list --grid 33 --bytes 400 --part 1/2 --summary t.csv").code, 1);
    EXPECT_EQ(gimenc("--batch list --grid 33 --bytes 400 --merge t.json").code, 1);
    const auto rows = nlohmann::json::parse(read(path("t.json")));
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[0].at("status"), "done");
    EXPECT_EQ(rows[0].at("bytes"), read(path("a.gim")).size());
    EXPECT_EQ(rows[0].at("faces"), record("a.gim").at("faces"));
    EXPECT_EQ(rows[0].at("genus"), 0);
    EXPECT_EQ(rows[0].at("grid"), 33);
    EXPECT_GT(rows[0].at("psnr"), 30);
    EXPECT_EQ(rows[0].at("seconds"), record("a.gim").at("seconds").at("total"));
    EXPECT_EQ(rows[1].at("status"), "pending");
    EXPECT_TRUE(rows[1].at("bytes").is_null());
    EXPECT_EQ(rows[2].at("status"), "failed");
    const std::vector<std::string> table = lines("t.csv");
    ASSERT_EQ(table.size(), 4u);
    EXPECT_EQ(table[0], "input,output,options,status,bytes,psnr,faces,genus,grid,seconds,error");
    EXPECT_THAT(table[1], HasSubstr("a.ply,a.gim,--bytes 400 --grid 33,done,"));
    EXPECT_EQ(table[2], "x.ply,x.gim,--bytes 400 --grid 33,pending,,,,,,,");
    EXPECT_THAT(table[3],
                HasSubstr("\"b,\"\"c.ply\",b.gim,--bytes 400 --grid 33,failed,,,,,,,\"b,\"\"c.ply: "));
    // Records of other options are not of this list.
    EXPECT_THAT(gimenc("--batch list --grid 33 --bytes 401 --merge t.csv").out,
                HasSubstr("0 done, 0 failed, 3 pending"));
    write("list", "a.ply a.gim\n");
    EXPECT_EQ(gimenc("--batch list --grid 33 --bytes 400 --merge t.csv").code, 0);
}

TEST_F(Batch, KilledInTheMiddleItResumesToTheSameBytes)
{
    std::string list, whole;
    for (const char* name : {"1", "2", "3", "4"}) {
        mesh(std::string(name) + ".ply", 4 + name[0] % 4);
        list += std::string(name) + ".ply out/" + name + ".gim\n";
        whole += std::string(name) + ".ply whole/" + name + ".gim\n";
    }
    write("list", list), write("whole-list", whole);
    ASSERT_EQ(gimenc("--batch whole-list --grid 33 --bytes 400 --jobs 2").code, 0);

    const pid_t batch = start({"gimenc", "--batch", "list", "--grid", "33", "--bytes", "400"});
    ASSERT_TRUE(waitFor([&] { return exists("out/1.gim.json"); }));
    ::kill(batch, SIGKILL);
    int status = 0;
    ::waitpid(batch, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
    for (const char* name : {"1", "2", "3", "4"}) {
        const std::string file = std::string(name) + ".gim";
        if (!exists("out/" + file)) continue;
        EXPECT_EQ(read(path("out/" + file)), read(path("whole/" + file))) << name;
    }
    const ino_t finished = inode("out/1.gim");
    const Ended rest = gimenc("--batch list --grid 33 --bytes 400");
    EXPECT_EQ(rest.code, 0) << rest.err;
    EXPECT_THAT(rest.out, testing::Not(HasSubstr("0 already there")));
    EXPECT_EQ(inode("out/1.gim"), finished);
    for (const char* name : {"1", "2", "3", "4"}) {
        const std::string file = std::string(name) + ".gim";
        EXPECT_EQ(read(path("out/" + file)), read(path("whole/" + file))) << name;
    }
}

TEST_F(Batch, AJobThatIsKilledCountsAsFailed)
{
    mesh("a.ply", 40), mesh("b.ply");
    write("list", "--grid 513 --psnr 90 a.ply a.gim\nb.ply b.gim\n");
    const pid_t batch = start({"gimenc", "--batch", "list", "--bytes", "400", "--grid", "33"});
    pid_t job = 0;
    ASSERT_TRUE(waitFor([&] { return (job = childOf(batch)) != 0; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    ::kill(job, SIGKILL);
    int status = 0;
    ::waitpid(batch, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 1);
    EXPECT_EQ(record("a.gim").at("error"), "a.ply: ended by signal 9 (Killed)");
    EXPECT_EQ(record("b.gim").at("status"), "done");
}

TEST_F(Batch, TwoAtOnceDoNoHarm)
{
    mesh("a.ply"), mesh("b.ply", 5);
    write("list", "a.ply a.gim\nb.ply b.gim\n");
    const std::vector<std::string> command = {"gimenc", "--batch", "list", "--grid", "33", "--bytes", "400"};
    const pid_t both[] = {start(command), start(command)};
    for (const pid_t one : both) {
        int status = 0;
        ::waitpid(one, &status, 0);
        EXPECT_EQ(status, 0);
    }
    EXPECT_EQ(gimenc("--batch list --grid 33 --bytes 400").out, "0 done, 2 already there, 0 failed\n");
    EXPECT_EQ(leftovers(), 0);
}

TEST_F(Batch, PlainCallsResumeToo)
{
    mesh("a.ply");
    EXPECT_EQ(gimenc("--resume --grid 33 --bytes 400 a.ply new/a.gim").code, 0);
    EXPECT_EQ(gimenc("--resume --bytes 400 --grid 33 a.ply new/a.gim").out, "new/a.gim: already there\n");
    write("list", "a.ply new/a.gim\n"); // the same record as in a list
    EXPECT_THAT(gimenc("--batch list --grid 33 --bytes 400").out, HasSubstr("1 already there"));
    EXPECT_EQ(gimenc("--resume --grid 33 --bytes 10 a.ply new/a.gim").code, 3);
    EXPECT_EQ(record("new/a.gim").at("status"), "failed");
}

} // namespace
} // namespace gimg

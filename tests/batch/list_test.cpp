// What a list of jobs says, and how it is shared out.
#include "gimenc/list.h"
#include "tools/cli.h"
#include "tools/whole_file.h"

#include "temporary_files.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>

namespace gimg::gimenc {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> wordsOf(const std::string& line)
{
    const auto lines = splitList(line);
    EXPECT_TRUE(lines.ok()) << line;
    return lines && lines->size() == 1 ? lines->front().words : std::vector<std::string>();
}

TEST(List, SplitsWordsAsAShellDoes)
{
    EXPECT_THAT(wordsOf("  a.obj\tb.gim \r\n"), ElementsAre("a.obj", "b.gim"));
    EXPECT_THAT(wordsOf("'a b' \"c d\" e\\ f"), ElementsAre("a b", "c d", "e f"));
    EXPECT_THAT(wordsOf("a'b 'c\"d\\\" e\"f"), ElementsAre("ab cd\" ef"));
    EXPECT_THAT(wordsOf("'\\' \"\\\\\" \"\\n\" \\\\"), ElementsAre("\\", "\\", "\\n", "\\"));
    EXPECT_THAT(wordsOf("'' \"\""), ElementsAre("", ""));
    EXPECT_THAT(wordsOf("a#b '#c' \\#d #e 'f"), ElementsAre("a#b", "#c", "#d"));
    EXPECT_THAT(wordsOf("$HOME * ~"), ElementsAre("$HOME", "*", "~"));
}

TEST(List, LinesKeepTheirNumbers)
{
    const auto lines = splitList("# first\n\na b\n \t\nc");
    ASSERT_TRUE(lines.ok());
    ASSERT_EQ(lines->size(), 2u);
    EXPECT_EQ(lines->at(0).number, 3);
    EXPECT_EQ(lines->at(1).number, 5);
    EXPECT_TRUE(splitList("")->empty());
}

TEST(List, BadLinesAreNamed)
{
    EXPECT_EQ(splitList("a b\n'c d\n").error().message, "line 2: a quote is not closed");
    EXPECT_EQ(splitList("a b\n\n\"c\\\"\n").error().message, "line 3: a quote is not closed");
    EXPECT_EQ(splitList("a b\\\nc").error().message, "line 1: nothing follows the backslash");
}

Arguments defaultsOf(size_t bytes)
{
    Arguments a;
    a.bytes = bytes;
    return a;
}

TEST(List, ALinesOwnOptionsWin)
{
    Arguments defaults = defaultsOf(5000);
    defaults.grid = 65;
    const auto own = parseLine({"--psnr", "60", "--grid=129", "i.ply", "o.gim"}, defaults);
    ASSERT_TRUE(own.ok()) << own.error().message;
    EXPECT_THAT(fileOptions(*own), ElementsAre("--psnr", "60", "--grid", "129"));
    EXPECT_EQ(own->input, "i.ply");
    EXPECT_EQ(own->output, "o.gim");
    EXPECT_THAT(fileOptions(*parseLine({"i.ply", "o.gim", "--weld", "never"}, defaults)),
                ElementsAre("--bytes", "5000", "--grid", "65", "--weld", "never"));
    EXPECT_THAT(
        fileOptions(*parseLine({"i.ply", "o.gim", "--max-genus", "06", "--close-holes", "1.50%"}, defaults)),
        ElementsAre("--bytes", "5000", "--grid", "65", "--close-holes", "1.5%", "--max-genus", "6"));
    EXPECT_THAT(
        fileOptions(*parseLine({"i.ply", "o.gim", "--max-genus", "auto", "--close-holes", "2e-1"}, defaults)),
        ElementsAre("--bytes", "5000", "--grid", "65", "--close-holes", "0.2", "--max-genus", "auto"));
    EXPECT_THAT(fileOptions(*parseLine(
                    {"--from-image", "--max-error", "2e-3", "--tolerance=.001", "--effort", "8", "i.f32", "o.gim"},
                    defaultsOf(5000))),
                ElementsAre("--max-error", "0.002", "--from-image", "--tolerance", "0.001", "--effort", "8"));
    EXPECT_THAT(fileOptions(*parseLine({"--raw", "float", "i.ply", "o.gim"}, defaults)),
                ElementsAre("--raw", "float", "--grid", "65"));
}

TEST(List, LinesThatAreNoCallAreRefused)
{
    const auto error = [](const std::vector<std::string>& words, const Arguments& defaults) {
        const auto parsed = parseLine(words, defaults);
        return parsed ? std::string() : parsed.error().message;
    };
    const Arguments bytes = defaultsOf(5000);
    EXPECT_EQ(error({"i.ply", "o.gim"}, bytes), "");
    EXPECT_EQ(error({"i.ply"}, bytes), "OUTPUT is required");
    EXPECT_EQ(error({"i.ply", "o.gim"}, {}), "one of --bytes, --psnr, --max-error and --raw is required");
    EXPECT_NE(error({"i.ply", "o.gim", "third"}, bytes), "");
    EXPECT_NE(error({"--bytes", "1", "--psnr", "60", "i.ply", "o.gim"}, bytes), "");
    EXPECT_NE(error({"--bytes", "-1", "i.ply", "o.gim"}, bytes), "");
    EXPECT_NE(error({"--batch", "list"}, bytes), "");
    EXPECT_NE(error({"--help"}, bytes), "");
    EXPECT_THAT(error({"--json", "f", "i.ply", "o.gim"}, bytes), HasSubstr("OUTPUT.json"));
}

class Lists : public test::TemporaryFiles
{
protected:
    std::string refusal(const std::string& text)
    {
        const auto jobs = readJobs(write("list", text), defaultsOf(1000));
        if (jobs) return "";
        EXPECT_EQ(jobs.error().message.find(path("list") + ": "), 0u);
        return jobs.error().message.substr(path("list").size() + 2);
    }
};

TEST_F(Lists, FilesThatClashAreRefused)
{
    EXPECT_EQ(refusal("a.ply a.gim\nb.ply b.gim\na.ply c.gim\n"), "");
    EXPECT_EQ(refusal("a.ply a.gim\n\nb.ply ./x/../a.gim\n"),
              "line 3: ./x/../a.gim is written by line 1 too");
    EXPECT_EQ(refusal("a.ply a.ply\n"), "line 1: a.ply is the input of line 1");
    EXPECT_EQ(refusal("a.ply a.gim\nb.ply a.ply\n"), "line 2: a.ply is the input of line 1");
    EXPECT_EQ(refusal("a.ply a\nb.ply a.json\n"), "line 2: a.json is written by line 1 too");
    EXPECT_EQ(refusal("a.ply a.gim\nb.ply b.gim --grid\n"), "line 2: --grid: 1 required INT missing");
}

TEST(Part, SharesCoverEveryLineOnce)
{
    for (size_t count = 1; count <= 7; ++count)
        for (size_t line = 0; line < 20; ++line) {
            size_t takers = 0;
            for (size_t index = 1; index <= count; ++index)
                takers += cli::parsePart(std::to_string(index) + "/" + std::to_string(count))->has(line);
            EXPECT_EQ(takers, 1u) << line << " of " << count;
        }
    EXPECT_TRUE(cli::parsePart("2/3")->has(1));
    EXPECT_TRUE(cli::parsePart("2/3")->has(4));
    for (const char* text :
         {"0/3", "4/3", "1/0", "", "1", "1/", "/2", "-1/2", "1/2 ", "1/2/3", "a/b", "1.0/2"})
        EXPECT_FALSE(cli::parsePart(text)) << text;
}

class WholeFile : public test::TemporaryFiles
{
};

TEST_F(WholeFile, ReplacesAndLeavesNothingElse)
{
    const std::string file = write("file", "earlier");
    ASSERT_EQ(::symlink(file.c_str(), path("link").c_str()), 0);
    EXPECT_TRUE(cli::writeWhole(path("link"), "later", 5));
    EXPECT_EQ(read(file), "later");
    EXPECT_TRUE(std::filesystem::is_symlink(path("link")));
    EXPECT_FALSE(cli::writeWhole(path("none/file"), "x", 1));
    EXPECT_FALSE(cli::writeWhole(path(""), "x", 1)); // a folder
    ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
    const int reader = ::open(path("pipe").c_str(), O_RDONLY | O_NONBLOCK);
    EXPECT_TRUE(cli::writeWhole(path("pipe"), "through", 7));
    char through[8] = {};
    EXPECT_EQ(::read(reader, through, sizeof through), 7);
    EXPECT_STREQ(through, "through");
    ::close(reader);
    const std::filesystem::directory_iterator entries(path(""));
    EXPECT_EQ(std::distance(begin(entries), end(entries)), 3);
}

TEST_F(WholeFile, Sha256IsThatOfTheStandard)
{
    const char* const ofAbc =
        "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"; // FIPS 180-2
    EXPECT_EQ(cli::contentsOf("abc", 3).sha256, ofAbc);
    const auto contents = cli::contentsOf(write("abc", "abc"));
    ASSERT_TRUE(contents);
    EXPECT_EQ(contents->sha256, ofAbc);
    EXPECT_EQ(contents->bytes, 3u);
    EXPECT_FALSE(cli::contentsOf(path("none")));
    EXPECT_FALSE(cli::contentsOf(path("")));
}

} // namespace
} // namespace gimg::gimenc

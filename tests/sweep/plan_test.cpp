// What a sweep consists of, and how it falls into parts.
#include "cli.h"
#include "gimrd/sweep_plan.h"
#include "temporary_files.h"

#include <gmock/gmock.h>

#include <set>

using namespace gimg;
using namespace gimg::gimrd;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

namespace {

CoderProgram coder(const std::string& name, bool ours, bool takesImage, bool usesGrid)
{
    CoderProgram program;
    program.name = name;
    program.title = "Title of " + name;
    program.ours = ours;
    program.takesImage = takesImage;
    program.usesGrid = usesGrid;
    return program;
}

const std::vector<CoderProgram> kCoders = {coder("gim", true, false, true),
                                           coder("draco", false, false, false),
                                           coder("openjpeg", false, true, false)};

std::vector<std::string> ids(const SweepPlan& plan)
{
    std::vector<std::string> list;
    for (const Series& series : plan.series) list.push_back(series.id);
    return list;
}

class Plan : public test::TemporaryFiles
{
};

} // namespace

TEST_F(Plan, GridsMatterToThoseWhoUseThem)
{
    const std::string image = write("image.f32", std::string(9 * 9 * 12, '\0'));
    const Result<SweepPlan> plan =
        planSweep({{"b.ply", image, "a.ply"}, {3072, 1536, 3072}, {0, 129}, {}, {}}, kCoders);
    ASSERT_TRUE(plan.ok());
    EXPECT_THAT(plan->sizes, ElementsAre(1536, 3072));
    EXPECT_THAT(ids(*plan),
                ElementsAre("gim", "gim-129", "draco", "openjpeg-9", "openjpeg-129", "openjpeg-257"));
    EXPECT_EQ(plan->series[1].label, "Title of gim, grid 129");
    EXPECT_EQ(plan->series[2].label, "Title of draco");
    EXPECT_EQ(plan->meshes[0].name, "a");
    EXPECT_EQ(plan->meshes[2].imageSide, 9);
    // Two meshes with 2 + 1 + 2 series; the image has 2 + 1 + its own side.
    EXPECT_EQ(plan->jobs.size(), 14U);
    for (const Job& job : plan->jobs)
        EXPECT_EQ(plan->series[job.series].id == "openjpeg-9", job.mesh == 2 && job.series == 3);
}

TEST_F(Plan, WithoutGridsEachCoderHasItsOwn)
{
    const Result<SweepPlan> plan = planSweep({{"a.ply"}, {1000}, {}, {}, {}}, kCoders);
    ASSERT_TRUE(plan.ok());
    EXPECT_THAT(ids(*plan), ElementsAre("gim", "draco", "openjpeg-257"));
    EXPECT_EQ(plan->series[2].label, "Title of openjpeg");
}

TEST_F(Plan, NamesChooseCoders)
{
    using Names = std::vector<std::string>;
    const auto plan = [](std::optional<Names> ours, std::optional<Names> peers) {
        return planSweep({{"a.ply"}, {1000}, {}, std::move(ours), std::move(peers)}, kCoders);
    };
    EXPECT_THAT(ids(*plan(std::nullopt, Names{"none"})), ElementsAre("gim"));
    EXPECT_THAT(ids(*plan(Names{"none"}, Names{"draco"})), ElementsAre("draco"));
    EXPECT_EQ(plan(Names{"none"}, Names{"none"}).error().kind, ErrorKind::BadArgument);
    EXPECT_EQ(plan(std::nullopt, Names{"dracco"}).error().message,
              "--peers: no coder is called 'dracco'; there are draco, openjpeg");
    EXPECT_EQ(plan(Names{"draco"}, std::nullopt).error().message,
              "--coders: no coder is called 'draco'; there are gim");
}

TEST_F(Plan, TwoMeshesOfOneNameAreRefused)
{
    const Result<SweepPlan> plan = planSweep({{"x/bunny.obj", "y/bunny.ply"}, {1000}, {}, {}, {}}, kCoders);
    ASSERT_FALSE(plan.ok());
    EXPECT_THAT(plan.error().message, HasSubstr("x/bunny.obj and y/bunny.ply"));
}

TEST(Parts, CoverEveryJobExactlyOnce)
{
    for (const size_t jobs : {1U, 7U, 96U})
        for (const size_t count : {1U, 2U, 5U, 120U}) {
            std::multiset<size_t> covered;
            for (size_t index = 1; index <= count; ++index)
                for (size_t job = 0; job < jobs; ++job)
                    if (cli::Part{index, count}.has(job)) covered.insert(job);
            EXPECT_EQ(covered.size(), jobs);
            EXPECT_EQ(std::set<size_t>(covered.begin(), covered.end()).size(), jobs);
        }
    EXPECT_TRUE((cli::Part{2, 8}.has(1))); // the second job
}

TEST(Parts, AreWrittenAsIOfN)
{
    EXPECT_EQ(cli::parsePart("3/8")->index, 3U);
    EXPECT_EQ(cli::parsePart("3/8")->count, 8U);
    for (const char* wrong : {"", "3", "0/8", "9/8", "3/", "/8", "3/8x", "-1/8", "3 /8"})
        EXPECT_FALSE(cli::parsePart(wrong)) << wrong;
}

#include "codec/coefficients.h"

#include <gtest/gtest.h>

namespace gimg::codec {
namespace {

template <unsigned Cap> void expectSameClasses()
{
    for (uint64_t sum = 0; sum < 70000; ++sum)
        ASSERT_EQ(quickClass<Cap>(sum), activityClass(sum, Cap)) << sum;
    EXPECT_EQ(quickClass<Cap>(uint64_t{1} << 40), Cap);
}

TEST(ActivityClass, FromTheTableIsTheSame)
{
    expectSameClasses<7>();
    expectSameClasses<9>();
    expectSameClasses<11>();
    expectSameClasses<13>();
    expectSameClasses<17>();
    expectSameClasses<23>();
}

} // namespace
} // namespace gimg::codec

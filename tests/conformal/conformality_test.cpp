#include "gimg/conformality.h"

#include "shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace gimg {
namespace {

// Two right isosceles triangles.
Mesh square() { return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}}; }

TEST(Conformality, OfAStretchBySides)
{
    // Angles of 45, 90, 45 degrees become atan(1/2), 90, atan(2).
    const Conformality c = conformality(square(), std::vector<Vec2>{{0, 0}, {2, 0}, {2, 1}, {0, 1}});
    const double error = 45 - std::atan(0.5) * 180 / std::numbers::pi;
    EXPECT_NEAR(c.largestAngleError, error, 1e-12);
    EXPECT_NEAR(c.medianAngleError, error, 1e-12); // two corners of three
    EXPECT_NEAR(c.quasiConformalRatio, 2, 1e-12);
    EXPECT_NEAR(c.areaDistortion, 0, 1e-7); // all areas doubled
    EXPECT_EQ(c.degenerate, 0);
}

TEST(Conformality, OfUnevenScalesIsTheirSpread)
{
    // Each face on its own: similar triangles, one of them three times as long. Logs of area: 0 and log 9.
    const std::vector<std::array<Vec2, 3>> corners{{Vec2(0, 0), Vec2(1, 0), Vec2(1, 1)},
                                                   {Vec2(5, 0), Vec2(8, 3), Vec2(5, 3)}};
    const Conformality c = conformality(square(), corners);
    EXPECT_NEAR(c.largestAngleError, 0, 1e-12);
    EXPECT_NEAR(c.quasiConformalRatio, 1, 1e-7);
    EXPECT_NEAR(c.areaDistortion, std::log(9.0) / 2, 1e-12);
}

TEST(Conformality, LeavesOutTrianglesWithoutArea)
{
    const Conformality c =
        conformality(square(), std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {2, 2, 0}});
    EXPECT_EQ(c.degenerate, 1);
    EXPECT_NEAR(c.largestAngleError, 0, 1e-12);
}

TEST(Conformality, AngleErrorOfAConformalMapFallsWithTheTriangles)
{
    const auto median = [](int n) {
        const Mesh disk = shapes::disk(0.5, n);
        std::vector<Vec2> image;
        for (const Vec3& p : disk.positions) {
            const std::complex<double> w = std::exp(std::complex<double>(p.x(), p.y()));
            image.push_back({w.real(), w.imag()});
        }
        return conformality(disk, image).medianAngleError;
    };
    const double coarse = median(10), fine = median(20);
    EXPECT_LT(coarse, 1.3);
    EXPECT_LT(fine, coarse / 1.9);
    EXPECT_GT(fine, coarse / 2.1);
}

} // namespace
} // namespace gimg

#include "gimg/moebius.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace gimg {
namespace {

class Directions
{
public:
    Vec3 operator()()
    {
        const double x = normal_(random_), y = normal_(random_), z = normal_(random_);
        return Vec3(x, y, z).normalized();
    }
    std::vector<Vec3> many(int count)
    {
        std::vector<Vec3> points;
        for (int i = 0; i < count; ++i) points.push_back((*this)());
        return points;
    }

private:
    std::mt19937 random_{7};
    std::normal_distribution<double> normal_;
};

// The isometry of the ball that takes c to its centre, as it is known in vectors.
Vec3 centredByVectors(const Vec3& c, const Vec3& p)
{
    return (1 - c.squaredNorm()) * (p - c) / (p - c).squaredNorm() - c;
}

TEST(Stereographic, KeepsOrientationSeenFromOutside)
{
    EXPECT_EQ(stereographic({0, 0, 1}), 0.0);
    EXPECT_EQ(stereographic({1, 0, 0}), 1.0);
    EXPECT_EQ(stereographic({0, 1, 0}), (std::complex<double>{0, 1}));
    EXPECT_LT((ontoSphere({1e200, 0}) - Vec3(0, 0, -1)).norm(), 1e-15);
    Directions direction;
    for (int i = 0; i < 50; ++i) {
        const Vec3 p = direction();
        EXPECT_LT((ontoSphere(stereographic(p)) - p).norm(), 1e-15);
    }
}

TEST(Moebius, CentringIsTheIsometryOfTheBall)
{
    Directions direction;
    for (double radius : {1e-9, 0.1, 0.7, 0.999})
        for (int i = 0; i < 20; ++i) {
            const Vec3 c = radius * direction(), p = direction();
            EXPECT_LT((Moebius::centring(c)(p) - centredByVectors(c, p)).norm(), 1e-15 / (1 - radius));
        }
    const Vec3 nearlySouth = 0.5 * Vec3(1e-9, 0, -1).normalized(), p(0.6, 0, 0.8);
    EXPECT_LT((Moebius::centring(nearlySouth)(p) - centredByVectors(nearlySouth, p)).norm(), 1e-15);
}

TEST(Moebius, RotationsAreTheirMatrices)
{
    Directions direction;
    for (int i = 0; i < 20; ++i) {
        const Eigen::Matrix3d rotation = Eigen::AngleAxisd(0.3 * i, direction()).toRotationMatrix();
        const Vec3 p = direction();
        EXPECT_LT((Moebius::rotating(rotation)(p) - rotation * p).norm(), 2e-15);
    }
}

TEST(Moebius, ComposesAndInverts)
{
    Directions direction;
    const Moebius a({1, 2}, {0.5, -1}, {0, 0.3}, {2, 1}), b = Moebius::centring(0.4 * direction());
    for (int i = 0; i < 20; ++i) {
        const Vec3 p = direction();
        EXPECT_LT(((a * b)(p)-a(b(p))).norm(), 1e-14);
        EXPECT_LT((a.inverse()(a(p)) - p).norm(), 1e-14);
        EXPECT_LT((ontoSphere(a(stereographic(p))) - a(p)).norm(), 1e-14);
    }
    EXPECT_NEAR(std::abs(a.a() * a.d() - a.b() * a.c() - 1.0), 0, 1e-15);
}

TEST(Moebius, IsFixedByThreePoints)
{
    Directions direction;
    for (int i = 0; i < 20; ++i) {
        const std::array<Vec3, 3> from{direction(), direction(), direction()},
            to{direction(), Vec3(0, 0, -1), direction()};
        const Result<Moebius> map = Moebius::byThreePoints(from, to);
        ASSERT_TRUE(map.ok());
        for (int k = 0; k < 3; ++k) EXPECT_LT(((*map)(from[k]) - to[k]).norm(), 1e-12);
        // A Moebius map keeps the cross ratio: a fourth point's too.
        const Vec3 p = direction(), q = (*map)(p);
        const auto ratio = [](const std::array<Vec3, 3>& a, const Vec3& b) {
            return (a[0] - b).norm() * (a[1] - a[2]).norm() / ((a[1] - b).norm() * (a[0] - a[2]).norm());
        };
        EXPECT_NEAR(ratio(to, q) / ratio(from, p), 1, 1e-10);
    }
    const Vec3 x(1, 0, 0), y(0, 1, 0);
    const Result<Moebius> bad = Moebius::byThreePoints({x, y, x}, {x, y, -y});
    ASSERT_FALSE(bad.ok());
    EXPECT_EQ(bad.error().kind, ErrorKind::BadArgument);
}

TEST(CentringMass, BringsTheMeanToTheCentre)
{
    Directions direction;
    const std::vector<Vec3> even = direction.many(500);
    std::vector<double> mass;
    for (int i = 0; i < 500; ++i) mass.push_back(1 + i % 7);
    for (double radius : {0.0, 0.5, 0.99, 0.99999}) {
        const Moebius away = Moebius::centring(radius * direction());
        std::vector<Vec3> points;
        for (const Vec3& p : even) points.push_back(away(p));
        const Result<Moebius> map = centringMass(points, mass);
        ASSERT_TRUE(map.ok()) << radius;
        for (Vec3& p : points) p = (*map)(p);
        EXPECT_LT(massCentre(points, mass).norm(), 1e-10) << radius;
    }
}

TEST(CentringMass, IsUniqueUpToRotation)
{
    // However the points were moved before, what is centred differs by a rotation: distances agree.
    Directions direction;
    const std::vector<Vec3> points = direction.many(40);
    const std::vector<double> mass(40, 1.0);
    std::vector<Vec3> moved;
    const Moebius away({2, 1}, {0, 1}, {1, -1}, {1, 0.5});
    for (const Vec3& p : points) moved.push_back(away(p));
    const Result<Moebius> first = centringMass(points, mass), second = centringMass(moved, mass);
    ASSERT_TRUE(first.ok() && second.ok());
    for (int i = 1; i < 40; ++i)
        EXPECT_NEAR(((*first)(points[i]) - (*first)(points[0])).norm(),
                    ((*second)(moved[i]) - (*second)(moved[0])).norm(), 1e-10);
}

TEST(CentringMass, RefusesMoreThanHalfOfTheMassInOnePoint)
{
    const std::vector<Vec3> points{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
    const Result<Moebius> map = centringMass(points, {3.1, 1, 1, 1});
    ASSERT_FALSE(map.ok());
    EXPECT_EQ(map.error().kind, ErrorKind::BadArgument);
    EXPECT_TRUE(centringMass(points, {2.9, 1, 1, 1}).ok());
}

TEST(BestMoebius, FindsTheMapThatWasApplied)
{
    Directions direction;
    const std::vector<Vec3> from = direction.many(12);
    const Moebius map = Moebius::centring(0.6 * direction()) *
                        Moebius::rotating(Eigen::AngleAxisd(2, direction()).toRotationMatrix());
    std::vector<Vec3> to;
    for (const Vec3& p : from) to.push_back(map(p));
    const Result<Moebius> found = bestMoebius(from, to);
    ASSERT_TRUE(found.ok());
    for (size_t i = 0; i < from.size(); ++i) EXPECT_LT(((*found)(from[i]) - to[i]).norm(), 1e-9);
    EXPECT_FALSE(bestMoebius({from[0], from[1]}, {to[0], to[1]}).ok());
}

TEST(BestRotation, IsProperAndRight)
{
    Directions direction;
    const Eigen::Matrix3d rotation = Eigen::AngleAxisd(1.1, direction()).toRotationMatrix();
    const std::vector<Vec3> from = direction.many(10);
    std::vector<Vec3> to, mirrored;
    for (const Vec3& p : from) to.push_back(rotation * p), mirrored.push_back(-p);
    EXPECT_LT((bestRotation(from, to) - rotation).norm(), 1e-13);
    EXPECT_NEAR(bestRotation(from, mirrored).determinant(), 1, 1e-13);
}

} // namespace
} // namespace gimg

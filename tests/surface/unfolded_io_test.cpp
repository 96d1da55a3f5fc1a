#include "gimg/unfolded_io.h"

#include "gimg/mesh_io.h"
#include "gimg/stretch.h"
#include "gimg/unfold.h"
#include "mesh/temporary_files.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <sstream>

namespace gimg {
namespace {

class UnfoldedIo : public test::TemporaryFiles
{
protected:
    // A torus in the map of a linear system: quick, and exactly on the square.
    void SetUp() override
    {
        test::TemporaryFiles::SetUp();
        UnfoldOptions options;
        options.param = MapKind::MeanValue;
        Result<Unfolded> made = unfold(shapes::torus(2, 1, 16, 8), options);
        ASSERT_TRUE(made.ok()) << made.error().message;
        unfolded = std::move(*made);
    }

    Unfolded unfolded;
};

TEST_F(UnfoldedIo, ObjHasTheSurfaceItsMapAndTheCutAsLines)
{
    ASSERT_TRUE(writeUnfolded(unfolded.square, unfolded.map, path("map.obj")).ok());
    const Result<MeshFile> back = readMesh(path("map.obj"));
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_EQ(back->mesh.positions, unfolded.square.surface.positions);
    EXPECT_EQ(back->mesh.faces, unfolded.square.surface.faces);

    std::vector<Vec2> st;
    double cut = 0;
    std::istringstream lines(read(path("map.obj")));
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string key;
        words >> key;
        if (key == "vt") {
            double s = 0, t = 0;
            words >> s >> t;
            st.emplace_back(s, t);
        }
        if (key != "l") continue;
        int v = 0;
        words >> v;
        for (int w; words >> w; v = w)
            cut += (back->mesh.positions[w - 1] - back->mesh.positions[v - 1]).norm();
    }
    EXPECT_EQ(st, unfolded.map.st);
    EXPECT_NEAR(cut, cutLength(unfolded.square.surface, unfolded.square.cut), 1e-12);
}

TEST_F(UnfoldedIo, PlyHasTheOpenedSurfaceAndTheStretchOfItsFaces)
{
    ASSERT_TRUE(writeUnfolded(unfolded.square, unfolded.map, path("map.ply")).ok());
    const Mesh& disk = unfolded.square.disk.mesh;
    const Result<Mesh> back = readTriangles(path("map.ply"));
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_EQ(back->positions, disk.positions);
    EXPECT_EQ(back->faces, disk.faces);

    const std::string file = read(path("map.ply"));
    const size_t vertices = file.find("end_header\n") + 11, faces = vertices + 40 * disk.positions.size();
    ASSERT_EQ(file.size(), faces + 21 * disk.faces.size());
    const auto number = [&](size_t at) {
        double value = 0;
        std::memcpy(&value, &file[at], sizeof value);
        return value;
    };
    EXPECT_EQ(number(vertices + 24), unfolded.map.st[0][0]);
    EXPECT_EQ(number(faces - 8), unfolded.map.st.back()[1]);
    EXPECT_EQ(number(file.size() - 8), faceStretch(disk, unfolded.map.st).back());
}

TEST_F(UnfoldedIo, OtherFormatsAreRefused)
{
    EXPECT_EQ(writeUnfolded(unfolded.square, unfolded.map, path("map.stl")).error().kind,
              ErrorKind::FormatUnknown);
    EXPECT_EQ(writeUnfolded(unfolded.square, unfolded.map, path("none/map.obj")).error().kind,
              ErrorKind::FileNotWritable);
}

TEST_F(UnfoldedIo, MeanSquareOfTheLocalStretchIsOneOverTheEfficiency)
{
    const Mesh& disk = unfolded.square.disk.mesh;
    const std::vector<double> stretch = faceStretch(disk, unfolded.map.st);
    double sum = 0;
    for (size_t f = 0; f < disk.faces.size(); ++f) {
        const Triangle& t = disk.faces[f];
        const Vec3 a = disk.positions[t[1]] - disk.positions[t[0]],
                   b = disk.positions[t[2]] - disk.positions[t[0]];
        sum += 0.5 * a.cross(b).norm() * stretch[f] * stretch[f];
    }
    EXPECT_NEAR(sum / surfaceArea(disk) * unfolded.map.efficiency, 1, 1e-12);
}

// A rectangle of 4 x 1 from the unit square: |Ss| = 4, |St| = 1, area 4.
TEST(FaceStretch, OfAnAffineMapIsKnown)
{
    const Mesh mesh{{{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    for (double stretch : faceStretch(mesh, {{0, 0}, {1, 0}, {1, 1}, {0, 1}}))
        EXPECT_NEAR(stretch, std::sqrt((16 + 1) / 2.0 / 4), 1e-15);
}

} // namespace
} // namespace gimg

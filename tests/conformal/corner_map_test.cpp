#include "gimg/corner_map.h"

#include "gimg/mesh_io.h"
#include "mesh/temporary_files.h"
#include "shapes.h"

#include <gtest/gtest.h>

#include <cstring>
#include <sstream>

namespace gimg {
namespace {

// Two triangles whose common edge has two images.
Mesh twoTriangles() { return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}}; }

CornerMap twoIslands() { return {{{0, 0}, {1, 0}, {1, 1}, {5, 0}, {6, 1}, {5, 1}}, {{0, 1, 2}, {3, 4, 5}}}; }

class CornerMapIo : public test::TemporaryFiles
{
};

TEST_F(CornerMapIo, ObjNamesTheVertexAndTheCopyOfEveryCorner)
{
    ASSERT_TRUE(writeCornerMap(twoTriangles(), twoIslands(), path("map.obj")).ok());
    EXPECT_EQ(read(path("map.obj")), "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                                     "vt 0 0\nvt 1 0\nvt 1 1\nvt 5 0\nvt 6 1\nvt 5 1\n"
                                     "f 1/1 2/2 3/3\nf 1/4 3/5 4/6\n");
}

TEST_F(CornerMapIo, PlyHasSixCoordinatesAFaceAndReadsBack)
{
    const std::vector<double> quality = {0.25, -3};
    ASSERT_TRUE(writeCornerMap(twoTriangles(), twoIslands(), path("map.ply"), quality).ok());
    const std::string bytes = read(path("map.ply"));
    const size_t body = bytes.find("end_header\n") + 11;
    const size_t face = 1 + 3 * 4 + 1 + 6 * 4 + 8;
    ASSERT_EQ(bytes.size() - body, 4 * 24 + 2 * face);
    float corner[6];
    std::memcpy(corner, &bytes[body + 96 + face + 14], sizeof corner);
    EXPECT_EQ(std::vector<float>(corner, corner + 6), (std::vector<float>{5, 0, 6, 1, 5, 1}));
    double last = 0;
    std::memcpy(&last, &bytes[bytes.size() - 8], 8);
    EXPECT_EQ(last, -3);
    const Result<MeshFile> back = readMesh(path("map.ply"));
    ASSERT_TRUE(back.ok()) << back.error().message;
    EXPECT_EQ(back->mesh.faces, twoTriangles().faces);
}

TEST_F(CornerMapIo, RefusesWhatDoesNotFit)
{
    CornerMap map = twoIslands();
    EXPECT_EQ(writeCornerMap(twoTriangles(), map, path("map.stl")).error().kind, ErrorKind::FormatUnknown);
    EXPECT_EQ(writeCornerMap(twoTriangles(), map, path("no/map.obj")).error().kind,
              ErrorKind::FileNotWritable);
    map.corners[1][2] = 6;
    EXPECT_EQ(writeCornerMap(twoTriangles(), map, path("map.obj")).error().kind, ErrorKind::BadArgument);
    map.corners.pop_back();
    EXPECT_EQ(writeCornerMap(twoTriangles(), map, path("map.obj")).error().kind, ErrorKind::BadArgument);
}

TEST_F(CornerMapIo, LinesKeepTheirVerticesOnly)
{
    const std::vector<std::vector<int>> lines = {{3, 2, 0, 3}, {2, 1}};
    ASSERT_TRUE(writeLines(twoTriangles(), lines, path("lines.obj")).ok());
    EXPECT_EQ(read(path("lines.obj")), "v 0 1 0\nv 1 1 0\nv 0 0 0\nv 1 0 0\nl 1 2 3 1\nl 2 4\n");
    ASSERT_TRUE(writeLines(twoTriangles(), lines, path("lines.ply")).ok());
    const std::string ply = read(path("lines.ply"));
    EXPECT_NE(ply.find("element edge 4\n"), std::string::npos);
    EXPECT_EQ(ply.substr(ply.find("end_header\n") + 11),
              "0 1 0\n1 1 0\n0 0 0\n1 0 0\n0 1 0\n1 2 0\n2 0 0\n1 3 1\n");
    const std::vector<std::vector<int>> bad = {{0, 4}};
    EXPECT_EQ(writeLines(twoTriangles(), bad, path("lines.obj")).error().kind, ErrorKind::BadArgument);
    EXPECT_EQ(writeLines(twoTriangles(), lines, path("lines.off")).error().kind, ErrorKind::FormatUnknown);
}

TEST_F(CornerMapIo, FormsAreSixNumbersAFace)
{
    Eigen::VectorXcd form(6);
    for (int h = 0; h < 6; ++h) form[h] = {h + 0.5, -1.0 * h};
    const std::vector<Eigen::VectorXcd> forms = {form, 2 * form};
    ASSERT_TRUE(writeForms(twoTriangles(), forms, path("forms.ply")).ok());
    const std::string bytes = read(path("forms.ply"));
    const size_t body = bytes.find("end_header\n") + 11, face = 13 + 2 * (1 + 48);
    ASSERT_EQ(bytes.size() - body, 96 + 2 * face);
    double numbers[6];
    std::memcpy(numbers, &bytes[bytes.size() - 48], sizeof numbers);
    EXPECT_EQ(std::vector<double>(numbers, numbers + 6), (std::vector<double>{7, -6, 9, -8, 11, -10}));
    EXPECT_EQ(writeForms(twoTriangles(), forms, path("forms.obj")).error().kind, ErrorKind::FormatUnknown);
    EXPECT_EQ(writeForms(shapes::torus(2, 1, 8, 8), forms, path("forms.ply")).error().kind,
              ErrorKind::BadArgument);
}

TEST(Checkerboard, FieldsPartsAndMarks)
{
    Checkerboard board;
    board.side = 0.25;
    const Color dark{1, 2, 3}, light{4, 5, 6}, blue{7, 8, 9}, white{10, 11, 12};
    board.colors = {{dark, light}, {blue, white}};
    board.part = {0, 3}; // the second face has the colours of part 1
    board.marks = {{9, 9, 9}};
    board.markRadius = 0.5;
    const auto color = checkerboardColor(twoIslands(), board);
    const auto at = [&](int face, double u, double v) { // uv = (0,0) + ... of the first island
        return color(face, {1 - u, u - v, v}, {0, 0, 0});
    };
    EXPECT_EQ(at(0, 0.2, 0.1), dark);
    EXPECT_EQ(at(0, 0.3, 0.1), light);
    EXPECT_EQ(at(0, 0.3, 0.26), dark);
    EXPECT_EQ(color(1, {0.9, 0.04, 0.06}, {0, 0, 0}), blue);  // (5.04, 0.1)
    EXPECT_EQ(color(1, {0.65, 0.2, 0.15}, {0, 0, 0}), white); // (5.2, 0.35): fields 20 and 1
    const Color mark = at(0, 0.2, 0.1), near = color(0, {0.8, 0.1, 0.1}, {9, 9, 9.4});
    EXPECT_NE(mark, near);
    EXPECT_EQ(color(0, {0.8, 0.1, 0.1}, {9, 9, 9.6}), dark);
}

} // namespace
} // namespace gimg

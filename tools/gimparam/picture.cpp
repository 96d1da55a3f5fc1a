#include "picture.h"

#include <CLI/App.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <complex>

namespace gimg::gimparam {
namespace {

constexpr double kDot = 0.012; // radius of a mark, of the bounding box's diagonal

// A pair of colours for each handle, in turn.
const std::vector<std::array<Color, 2>> kPairs = {
    {Color{205, 160, 84}, Color{250, 241, 222}},  {Color{92, 146, 184}, Color{222, 235, 243}},
    {Color{190, 104, 88}, Color{247, 226, 219}},  {Color{112, 158, 100}, Color{225, 238, 217}},
    {Color{140, 112, 168}, Color{234, 226, 242}}, {Color{84, 156, 150}, Color{217, 238, 235}},
    {Color{150, 140, 120}, Color{238, 234, 226}}};

double areaOf(const CornerMap& map)
{
    double area = 0;
    for (size_t f = 0; f < map.corners.size(); ++f) {
        const int face = static_cast<int>(f);
        const Vec2 a = map.at(face, 1) - map.at(face, 0), b = map.at(face, 2) - map.at(face, 0);
        area += std::abs(a[0] * b[1] - a[1] * b[0]) / 2;
    }
    return area;
}

// From coordinates in the parallelogram of a handle to fields. Lattice bases are changed by integers only,
// until neither side gets shorter by the other (Gauss).
Eigen::Matrix2d fieldsOf(const Handle& handle, double side)
{
    std::complex<double> p = handle.periodA, q = handle.periodB;
    Eigen::Matrix2d sides = Eigen::Matrix2d::Identity(); // columns: p and q in terms of A and B
    for (;;) {
        if (std::norm(q) < std::norm(p)) {
            std::swap(p, q);
            sides.col(0).swap(sides.col(1));
        }
        const double whole = std::round((std::conj(p) * q).real() / std::norm(p));
        if (whole == 0) break;
        q -= whole * p;
        sides.col(1) -= whole * sides.col(0);
    }
    const auto even = [&](double length) { return 2 * std::max(1.0, std::round(length / (2 * side))); };
    return Eigen::Vector2d(even(std::abs(p)), even(std::abs(q))).asDiagonal() * sides.inverse();
}

} // namespace

void addPicture(CLI::App& command, PictureOptions& picture)
{
    CLI::Option* file =
        command
            .add_option("--picture", picture.path,
                        "draw the surface under a checkerboard to this .png; red dots are "
                        "branch points")
            ->check(CLI::Validator(
                [](const std::string& path) {
                    return path.ends_with(".png") ? std::string() : path + ": a picture is written to .png";
                },
                "FILE"));
    command.add_option("--picture-size", picture.size, "pixels a side")
        ->needs(file)
        ->check(CLI::Range(16, 8192));
    command
        .add_option("--fields", picture.fields,
                    "the map is as large as so many times so many fields (default: 40)")
        ->needs(file)
        ->check(CLI::PositiveNumber);
    command.add_option("--look", picture.toward, "direction from the eye into the scene, X,Y,Z")
        ->needs(file)
        ->delimiter(',')
        ->allow_extra_args(false)
        ->expected(3);
    command.add_option("--up", picture.up, "direction that is up in the picture, X,Y,Z (default: 0,1,0)")
        ->needs(file)
        ->delimiter(',')
        ->allow_extra_args(false)
        ->expected(3);
}

double fieldSide(const CornerMap& map, double fields) { return std::sqrt(areaOf(map)) / fields; }

CornerMap seamlessFields(const HandleSeparation& separation, const CornerMap& modular, double side)
{
    std::vector<Eigen::Matrix2d> toFields;
    for (const Handle& handle : separation.handles) toFields.push_back(fieldsOf(handle, side));
    CornerMap fields = modular;
    for (size_t f = 0; f < fields.corners.size(); ++f)
        for (int c : fields.corners[f]) fields.uv[c] = toFields[separation.handleOf[f]] * modular.uv[c];
    return fields;
}

Status writePicture(const Mesh& mesh, const CornerMap& map, double side, const std::vector<int>& part,
                    const std::vector<Vec3>& marks, const PictureOptions& picture)
{
    Checkerboard board;
    board.side = side;
    if (!(board.side > 0)) return Error{ErrorKind::BadArgument, "the map has no area to draw"};
    board.colors = kPairs;
    board.part = part;
    board.marks = marks;
    board.markRadius = kDot * boundingBoxDiagonal(mesh);
    RenderOptions options;
    options.width = options.height = picture.size;
    options.view.toward = {picture.toward[0], picture.toward[1], picture.toward[2]};
    options.view.up = {picture.up[0], picture.up[1], picture.up[2]};
    options.smooth = true;
    options.inside = std::nullopt;
    options.supersampling = 5;
    options.color = checkerboardColor(map, std::move(board));
    const Result<RgbImage> image = render(mesh, options);
    if (!image) return image.error();
    return writePng(*image, picture.path);
}

} // namespace gimg::gimparam

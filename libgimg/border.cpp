#include "gimg/border.h"

#include "border_layout.h"

#include <algorithm>
#include <cmath>

namespace gimg {
namespace {

constexpr int kLargestGrid = BorderOptions::kLargestGrid;

bool isGridSize(int n) { return n >= 3 && n <= kLargestGrid && ((n - 1) & (n - 2)) == 0; }

// ---- edges across the corners ----------------------------------------------------------------------------

void splitEdge(Mesh& mesh, int v, int w, int middle)
{
    const size_t faces = mesh.faces.size();
    for (size_t f = 0; f < faces; ++f)
        for (int k = 0; k < 3; ++k) {
            const int a = mesh.faces[f][k], b = mesh.faces[f][(k + 1) % 3], c = mesh.faces[f][(k + 2) % 3];
            if (!((a == v && b == w) || (a == w && b == v))) continue;
            mesh.faces[f] = {a, middle, c};
            mesh.faces.push_back({middle, b, c});
            break;
        }
}

// Parameters of the path's vertices, in [0, length], by arc length on the surface.
std::vector<double> arcParameters(const Mesh& mesh, const CutPath& path, int length, double smallestEdge)
{
    std::vector<double> u = {0.0};
    for (size_t i = 0; i + 1 < path.vertices.size(); ++i) {
        const double edge = (mesh.positions[path.vertices[i + 1]] - mesh.positions[path.vertices[i]]).norm();
        u.push_back(u.back() + std::max(edge, smallestEdge));
    }
    const double scale = length / u.back();
    for (double& x : u) x *= scale;
    u.back() = length;
    return u;
}

// Makes a vertex of the path fall on `corner`: a vertex that is nearly there is moved along, else the edge is
// split. Splitting happens on the surface, hence on both mates.
void placeVertexAt(double corner, Mesh& mesh, CutPath& path, std::vector<double>& u)
{
    constexpr double kNearly = 0.1; // of the edge that spans the corner
    const size_t i = static_cast<size_t>(std::upper_bound(u.begin(), u.end(), corner) - u.begin()) - 1;
    if (u[i] == corner) return;
    const double fraction = (corner - u[i]) / (u[i + 1] - u[i]);
    const bool fixedLow = i == 0 || u[i] == std::floor(u[i]);
    const bool fixedHigh = i + 2 == u.size() || u[i + 1] == std::floor(u[i + 1]);
    if (fraction < kNearly && !fixedLow) {
        u[i] = corner;
        return;
    }
    if (fraction > 1 - kNearly && !fixedHigh) {
        u[i + 1] = corner;
        return;
    }
    const int v = path.vertices[i], w = path.vertices[i + 1], middle = mesh.vertexCount();
    mesh.positions.push_back((1 - fraction) * mesh.positions[v] + fraction * mesh.positions[w]);
    splitEdge(mesh, v, w, middle);
    path.vertices.insert(path.vertices.begin() + static_cast<long>(i) + 1, middle);
    u.insert(u.begin() + static_cast<long>(i) + 1, corner);
}

// ---- degenerate edges and triangles ----------------------------------------------------------------------

// Splits every marked edge of the mesh at its midpoint, and the faces on both sides with it.
void splitMarkedEdges(Mesh& mesh, const std::vector<bool>& marked)
{
    const Halfedges he(mesh.faces, mesh.vertexCount());
    std::vector<int> middle(he.count(), -1);
    for (int h = 0; h < he.count(); ++h) {
        if (!marked[h] || middle[h] >= 0) continue;
        middle[h] = mesh.vertexCount();
        if (!he.onBoundary(h)) middle[he.twin(h)] = middle[h];
        mesh.positions.push_back(0.5 * (mesh.positions[he.tail(h)] + mesh.positions[he.head(h)]));
    }
    const int faces = mesh.faceCount();
    for (int f = 0; f < faces; ++f) {
        const Triangle t = mesh.faces[f];
        const int m[3] = {middle[3 * f], middle[3 * f + 1], middle[3 * f + 2]};
        const int splits = (m[0] >= 0) + (m[1] >= 0) + (m[2] >= 0);
        if (splits == 0) continue;
        const auto at = [&](int k) { return t[k % 3]; };
        if (splits == 3) {
            mesh.faces[f] = {m[0], m[1], m[2]};
            for (int k = 0; k < 3; ++k) mesh.faces.push_back({at(k), m[k], m[(k + 2) % 3]});
        } else if (splits == 1) {
            const int k = m[0] >= 0 ? 0 : m[1] >= 0 ? 1 : 2;
            mesh.faces[f] = {at(k), m[k], at(k + 2)};
            mesh.faces.push_back({m[k], at(k + 1), at(k + 2)});
        } else {
            const int k = m[0] < 0 ? 0 : m[1] < 0 ? 1 : 2; // the whole edge
            const int next = m[(k + 1) % 3], last = m[(k + 2) % 3];
            mesh.faces[f] = {next, at(k + 2), last};
            mesh.faces.push_back({at(k), at(k + 1), next});
            mesh.faces.push_back({at(k), next, last});
        }
    }
}

// (s,t) of a border position in [0, 4 side).
Vec2 onSquare(double position, int side)
{
    const int edge = std::min(3, static_cast<int>(position / side));
    const double x = position / side - edge;
    switch (edge) {
    case 0:
        return {x, 0};
    case 1:
        return {1, x};
    case 2:
        return {1 - x, 1};
    default:
        return {0, 1 - x};
    }
}

uint8_t sidesOf(double position, int side)
{
    uint8_t mask = 0;
    for (int edge = 0; edge < 4; ++edge)
        if (position >= edge * side && position <= (edge + 1) * side)
            mask = static_cast<uint8_t>(mask | 1 << edge);
    if (position == 0) mask |= 8;
    return mask;
}

Status placeOnSquare(SquareDisk& square)
{
    Result<DiskMesh> opened = openAlong(square.surface, square.cut);
    if (!opened) return opened.error();
    square.disk = std::move(*opened);
    const int side = square.lowest - 1, perimeter = 4 * side;
    square.borderPosition.assign(square.disk.origin.size(), Vec2::Zero());
    square.squareSides.assign(square.disk.origin.size(), 0);
    double begin = square.start;
    for (const DiskSide& s : square.disk.sides) {
        const std::vector<double>& u = square.pathParameter[s.path];
        const int length = square.pathLength[s.path];
        for (size_t i = 0; i < s.vertices.size(); ++i) {
            double position = begin + (s.reversed ? length - u[u.size() - 1 - i] : u[i]);
            if (position >= perimeter) position -= perimeter;
            square.borderPosition[s.vertices[i]] = onSquare(position, side);
            square.squareSides[s.vertices[i]] = sidesOf(position, side);
        }
        begin += length;
        if (begin >= perimeter) begin -= perimeter;
    }
    return Done{};
}

Status checkLayout(const CutGraph& cut, const BorderLayout& layout, int grid)
{
    const auto refuse = [](const char* why) { return Error{ErrorKind::BadArgument, why}; };
    if (!isGridSize(grid) || !isGridSize(layout.lowest) || layout.lowest > grid)
        return refuse("grid or lowest level of the layout is not 2^j + 1, or the lowest is larger");
    if (layout.pathLength.size() != cut.paths.size()) return refuse("not one length a path of the cut");
    const int perimeter = 4 * (layout.lowest - 1);
    if (layout.start < 0 || layout.start >= perimeter) return refuse("the layout starts off the border");
    int64_t total = 0;
    for (size_t p = 0; p < cut.paths.size(); ++p) {
        if (layout.pathLength[p] < 1) return refuse("a path of the layout has no length");
        total += int64_t{layout.pathLength[p]} * (cut.paths[p].boundary ? 1 : 2);
    }
    if (total != perimeter) return refuse("the layout's lengths do not add up to the border");
    return Done{};
}

} // namespace

std::vector<gim_side> SquareDisk::seam() const { return seamWord(disk, cut, pathLength); }

Result<SquareDisk> layOutBorder(const Mesh& mesh, const CutGraph& cut, const BorderOptions& options)
{
    if (options.grid != 0 && !isGridSize(options.grid))
        return Error{ErrorKind::BadArgument, "grid " + std::to_string(options.grid) +
                                                 " is not 2^j + 1 between 3 and " +
                                                 std::to_string(kLargestGrid)};
    if (options.lowest != 0 && !isGridSize(options.lowest))
        return Error{ErrorKind::BadArgument,
                     "lowest level " + std::to_string(options.lowest) + " is not 2^j + 1"};
    if (options.grid != 0 && options.lowest > options.grid)
        return Error{ErrorKind::BadArgument, "lowest level " + std::to_string(options.lowest) +
                                                 " is larger than the grid " + std::to_string(options.grid)};

    Result<DiskMesh> disk = openAlong(mesh, cut);
    if (!disk) return disk.error();
    SquareDisk square;
    square.grid = options.grid;
    Result<BorderLayout> layout = Error{ErrorKind::TargetUnreachable, ""};
    for (int grid = options.grid != 0 ? options.grid : std::max(BorderOptions::kDefaultGrid, options.lowest);
         grid <= kLargestGrid && !layout.ok(); grid = 2 * grid - 1) {
        layout = proportionalLayout(cut, *disk, mesh, grid, options.lowest, options.layout);
        square.grid = grid;
        if (options.grid != 0) break;
    }
    if (!layout) return layout.error();

    return layOutBorder(mesh, cut, *layout, square.grid);
}

Result<SquareDisk> layOutBorder(const Mesh& mesh, const CutGraph& cut, const BorderLayout& layout, int grid)
{
    if (const Status fits = checkLayout(cut, layout, grid); !fits) return fits.error();
    Result<DiskMesh> disk = openAlong(mesh, cut);
    if (!disk) return disk.error();
    SquareDisk square;
    square.grid = grid;
    square.surface = mesh;
    square.cut = cut;
    square.lowest = layout.lowest;
    square.start = layout.start;
    square.pathLength = layout.pathLength;
    const double smallestEdge = 1e-7 * boundingBoxDiagonal(mesh);
    for (size_t p = 0; p < cut.paths.size(); ++p)
        square.pathParameter.push_back(arcParameters(mesh, cut.paths[p], square.pathLength[p], smallestEdge));

    const int side = square.lowest - 1;
    int begin = square.start;
    for (const DiskSide& s : disk->sides) {
        const int length = square.pathLength[s.path];
        for (int corner = 0; corner <= 8 * side; corner += side)
            if (corner > begin && corner < begin + length) {
                const double at = s.reversed ? begin + length - corner : corner - begin;
                placeVertexAt(at, square.surface, square.cut.paths[s.path], square.pathParameter[s.path]);
            }
        begin += length;
    }

    if (const Status placed = placeOnSquare(square); !placed) return placed.error();
    const Halfedges he(square.disk.mesh.faces, square.disk.mesh.vertexCount());
    std::vector<bool> marked(he.count(), false);
    bool any = false;
    for (int h = 0; h < he.count(); ++h) {
        marked[h] =
            !he.onBoundary(h) && square.squareSides[he.tail(h)] != 0 && square.squareSides[he.head(h)] != 0;
        any = any || marked[h];
    }
    if (any) {
        // Faces of disk and surface correspond, so the disk's halfedges name the surface's edges too.
        splitMarkedEdges(square.surface, marked);
        if (const Status placed = placeOnSquare(square); !placed) return placed.error();
    }
    return square;
}

} // namespace gimg

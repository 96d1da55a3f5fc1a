#include "gimg/border.h"

#include "codec/seam.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

namespace gimg {
namespace {

constexpr int kDefaultLowest = 33;
constexpr int kLargestGrid = BorderOptions::kLargestGrid;

bool isGridSize(int n) { return n >= 3 && n <= kLargestGrid && ((n - 1) & (n - 2)) == 0; }

// ---- integer lengths -------------------------------------------------------------------------------------

struct PathNeeds
{
    double target = 0;    // share of the perimeter in lowest-grid units
    int minimum = 1;      // shortest length that keeps the seam a simplicial complex
    int multiplicity = 2; // sides of the opened border that carry the path: 2 for mates, 1 for boundaries
};

// A loop needs three edges, and of several paths between the same two nodes only one may be a single edge.
std::vector<int> minimalLengths(const CutGraph& cut)
{
    std::map<std::pair<int, int>, int> parallel;
    std::vector<int> minimum;
    for (const CutPath& path : cut.paths) {
        const auto [low, high] = std::minmax(path.vertices.front(), path.vertices.back());
        const bool loop = low == high;
        minimum.push_back(loop ? 3 : parallel[{low, high}]++ == 0 ? 1 : 2);
    }
    return minimum;
}

// Rounds the targets to integers whose sum over both mates is the perimeter; the residual goes to the paths
// that rounding treated worst, one unit (on both mates) at a time.
std::optional<std::vector<int>> allocate(const std::vector<PathNeeds>& needs, int perimeter)
{
    std::vector<int> length;
    int residual = perimeter;
    for (const PathNeeds& need : needs) {
        length.push_back(std::max(need.minimum, static_cast<int>(std::lround(need.target))));
        residual -= need.multiplicity * length.back();
    }
    while (residual < 0) {
        int chosen = -1;
        double worst = -1e300;
        for (size_t p = 0; p < needs.size(); ++p) {
            const double excess = length[p] - needs[p].target;
            if (length[p] > needs[p].minimum && excess > worst) worst = excess, chosen = static_cast<int>(p);
        }
        if (chosen < 0) return std::nullopt;
        --length[chosen];
        residual += needs[chosen].multiplicity;
    }
    while (residual > 0) {
        int chosen = -1;
        double worst = -1e300;
        for (size_t p = 0; p < needs.size(); ++p) {
            const double lack = needs[p].target - length[p];
            if (needs[p].multiplicity <= residual && lack > worst) worst = lack, chosen = static_cast<int>(p);
        }
        if (chosen < 0) return std::nullopt;
        ++length[chosen];
        residual -= needs[chosen].multiplicity;
    }
    return length;
}

// ---- the layout search -----------------------------------------------------------------------------------

struct Layout
{
    int lowest = 0;
    int start = 0;
    std::vector<int> pathLength;
};

std::vector<gim_side> seamWord(const std::vector<DiskSide>& sides, const CutGraph& cut,
                               const std::vector<int>& pathLength)
{
    std::vector<int> label(cut.paths.size(), -1);
    int labels = 0;
    std::vector<gim_side> word;
    for (const DiskSide& side : sides) {
        const bool seen = label[side.path] >= 0;
        if (!seen) label[side.path] = labels++;
        gim_side out{};
        out.path = static_cast<uint32_t>(label[side.path]);
        out.length = static_cast<uint32_t>(pathLength[side.path]);
        out.kind = cut.paths[side.path].boundary ? GIM_SIDE_BOUNDARY : seen ? GIM_SIDE_MATE : GIM_SIDE_FIRST;
        word.push_back(out);
    }
    return word;
}

// The valence of every cut-node in the cut: how many path ends meet there.
std::map<int, int> nodeValences(const CutGraph& cut)
{
    std::map<int, int> valence;
    for (const CutPath& path : cut.paths) {
        ++valence[path.vertices.front()];
        ++valence[path.vertices.back()];
    }
    return valence;
}

// Border positions, relative to the first side, where cut-nodes of valence 1 lie.
std::vector<int> tipPositions(const DiskMesh& disk, const CutGraph& cut, const std::vector<int>& pathLength)
{
    const std::map<int, int> valence = nodeValences(cut);
    std::vector<int> tips;
    int position = 0;
    for (const DiskSide& side : disk.sides) {
        if (valence.at(disk.origin[side.vertices.front()]) == 1) tips.push_back(position);
        position += pathLength[side.path];
    }
    return tips;
}

// Rotations of the border, the best first: tips stay as far from the corners as they can (at a corner the
// geometry is poor, next to one the seam stops being simplicial).
std::vector<int> rotationsBestFirst(const std::vector<int>& tips, int lowest)
{
    const int side = lowest - 1;
    std::vector<std::pair<int, int>> scored;
    for (int start = 0; start < 4 * side; ++start) {
        int clearance = side;
        for (int tip : tips) {
            const int along = (start + tip) % side;
            clearance = std::min({clearance, along, side - along});
        }
        if (tips.empty() || clearance > 0) scored.push_back({-clearance, start});
    }
    std::stable_sort(scored.begin(), scored.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<int> starts;
    for (const auto& entry : scored) starts.push_back(entry.second);
    return starts;
}

std::optional<Layout> layoutAt(int lowest, const CutGraph& cut, const DiskMesh& disk,
                               std::vector<PathNeeds> needs, double totalLength, int slack)
{
    const int perimeter = 4 * (lowest - 1);
    int minimalPerimeter = 0;
    for (PathNeeds& need : needs) {
        need.target *= perimeter / totalLength;
        minimalPerimeter += need.multiplicity * need.minimum;
    }
    if (minimalPerimeter * slack > perimeter) return std::nullopt;
    const std::optional<std::vector<int>> length = allocate(needs, perimeter);
    if (!length) return std::nullopt;
    const std::vector<gim_side> word = seamWord(disk.sides, cut, *length);
    for (int start : rotationsBestFirst(tipPositions(disk, cut, *length), lowest))
        if (codec::seamIsSimplicial(word.data(), static_cast<uint32_t>(word.size()),
                                    static_cast<uint32_t>(start), static_cast<uint32_t>(lowest),
                                    static_cast<uint32_t>(lowest)))
            return Layout{lowest, start, *length};
    return std::nullopt;
}

// The star's centre at the corners; nothing if the cut is no star of four paths.
std::optional<Layout> octahedralLayoutAt(int lowest, const CutGraph& cut, const DiskMesh& disk)
{
    const int side = lowest - 1;
    if (cut.paths.size() != 4 || disk.sides.size() != 8 || side < 2) return std::nullopt;
    for (const auto& [node, valence] : nodeValences(cut))
        if (valence != 1 && valence != 4) return std::nullopt;
    const int first = disk.origin[disk.sides[0].vertices.front()];
    const Layout layout{lowest, nodeValences(cut).at(first) == 4 ? 0 : side / 2,
                        std::vector<int>(4, side / 2)};
    const std::vector<gim_side> word = seamWord(disk.sides, cut, layout.pathLength);
    if (!codec::seamIsSimplicial(word.data(), static_cast<uint32_t>(word.size()),
                                 static_cast<uint32_t>(layout.start), static_cast<uint32_t>(lowest),
                                 static_cast<uint32_t>(lowest)))
        return std::nullopt;
    return layout;
}

Error doesNotFit(const CutGraph& cut, const char* what, int size)
{
    const std::string paths = cut.paths.size() == 1 ? " path" : " paths";
    return {ErrorKind::TargetUnreachable, "the cut has " + std::to_string(cut.paths.size()) + paths +
                                              ", too much for " + what + " " + std::to_string(size) +
                                              "; use a larger one"};
}

// The asked lowest level, or the smallest from the default on; preferably one whose border is at least twice
// as long as the cut needs, so that lengths can follow the surface.
Result<Layout> findLayout(const CutGraph& cut, const DiskMesh& disk, const Mesh& mesh, int grid, int asked,
                          SquareLayout kind)
{
    const int first = std::min(kDefaultLowest, std::max(3, (grid - 1) / 4 + 1));
    if (kind == SquareLayout::Octahedral) {
        if (const auto layout = octahedralLayoutAt(asked > 0 ? asked : first, cut, disk)) return *layout;
        return Error{
            ErrorKind::TargetUnreachable,
            "the cut is no star of four paths, or the lowest level is too small: no octahedral layout"};
    }
    const std::vector<int> minimum = minimalLengths(cut);
    std::vector<PathNeeds> needs(cut.paths.size());
    double total = 0;
    for (size_t p = 0; p < needs.size(); ++p) {
        needs[p].target = cutLength(mesh, {{cut.paths[p]}});
        needs[p].minimum = minimum[p];
        needs[p].multiplicity = cut.paths[p].boundary ? 1 : 2;
        total += needs[p].multiplicity * needs[p].target;
    }
    if (asked > 0) {
        if (const auto layout = layoutAt(asked, cut, disk, needs, total, 1)) return *layout;
        return doesNotFit(cut, "a lowest level of", asked);
    }
    for (int slack : {2, 1})
        for (int lowest = first; lowest <= grid; lowest = 2 * lowest - 1)
            if (const auto layout = layoutAt(lowest, cut, disk, needs, total, slack)) return *layout;
    return doesNotFit(cut, "a grid of", grid);
}

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

} // namespace

std::vector<gim_side> SquareDisk::seam() const { return seamWord(disk.sides, cut, pathLength); }

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
    Result<Layout> layout = Error{ErrorKind::TargetUnreachable, ""};
    for (int grid = options.grid != 0 ? options.grid : std::max(BorderOptions::kDefaultGrid, options.lowest);
         grid <= kLargestGrid && !layout.ok(); grid = 2 * grid - 1) {
        layout = findLayout(cut, *disk, mesh, grid, options.lowest, options.layout);
        square.grid = grid;
        if (options.grid != 0) break;
    }
    if (!layout) return layout.error();

    square.surface = mesh;
    square.cut = cut;
    square.lowest = layout->lowest;
    square.start = layout->start;
    square.pathLength = layout->pathLength;
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

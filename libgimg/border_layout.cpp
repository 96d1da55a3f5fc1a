#include "border_layout.h"

#include "codec/seam.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

namespace gimg {
namespace {

constexpr int kDefaultLowest = 33;

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

bool gluesToSimplices(const BorderLayout& layout, const DiskMesh& disk, const CutGraph& cut)
{
    const std::vector<gim_side> word = seamWord(disk, cut, layout.pathLength);
    return codec::seamIsSimplicial(word.data(), static_cast<uint32_t>(word.size()),
                                   static_cast<uint32_t>(layout.start), static_cast<uint32_t>(layout.lowest),
                                   static_cast<uint32_t>(layout.lowest));
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

std::optional<BorderLayout> layoutAt(int lowest, const CutGraph& cut, const DiskMesh& disk,
                                     std::vector<PathNeeds> needs, double totalLength, int slack)
{
    const int perimeter = 4 * (lowest - 1);
    int minimalPerimeter = 0;
    for (PathNeeds& need : needs) {
        need.target *= perimeter / totalLength;
        minimalPerimeter += need.multiplicity * need.minimum;
    }
    if (minimalPerimeter * slack > perimeter) return std::nullopt;
    const std::optional<std::vector<int>> length = roundLengths(needs, perimeter);
    if (!length) return std::nullopt;
    for (int start : rotationsBestFirst(tipPositions(disk, cut, *length), lowest)) {
        const BorderLayout layout{lowest, start, *length};
        if (gluesToSimplices(layout, disk, cut)) return layout;
    }
    return std::nullopt;
}

// The star's centre at the corners; nothing if the cut is no star of four paths.
std::optional<BorderLayout> octahedralLayoutAt(int lowest, const CutGraph& cut, const DiskMesh& disk)
{
    const int side = lowest - 1;
    if (cut.paths.size() != 4 || disk.sides.size() != 8 || side < 2) return std::nullopt;
    for (const auto& [node, valence] : nodeValences(cut))
        if (valence != 1 && valence != 4) return std::nullopt;
    const int first = disk.origin[disk.sides[0].vertices.front()];
    const BorderLayout layout{lowest, nodeValences(cut).at(first) == 4 ? 0 : side / 2,
                              std::vector<int>(4, side / 2)};
    if (!gluesToSimplices(layout, disk, cut)) return std::nullopt;
    return layout;
}

Error doesNotFit(const CutGraph& cut, const char* what, int size)
{
    const std::string paths = cut.paths.size() == 1 ? " path" : " paths";
    return {ErrorKind::TargetUnreachable, "the cut has " + std::to_string(cut.paths.size()) + paths +
                                              ", too much for " + what + " " + std::to_string(size) +
                                              "; use a larger one"};
}

} // namespace

std::vector<PathNeeds> pathNeeds(const CutGraph& cut)
{
    std::map<std::pair<int, int>, int> parallel;
    std::vector<PathNeeds> needs;
    for (const CutPath& path : cut.paths) {
        const auto [low, high] = std::minmax(path.vertices.front(), path.vertices.back());
        const int minimum = low == high ? 3 : parallel[{low, high}]++ == 0 ? 1 : 2;
        needs.push_back({0, minimum, path.boundary ? 1 : 2});
    }
    return needs;
}

std::optional<std::vector<int>> roundLengths(const std::vector<PathNeeds>& needs, int perimeter)
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

bool isSound(const BorderLayout& layout, const DiskMesh& disk, const CutGraph& cut)
{
    for (int tip : tipPositions(disk, cut, layout.pathLength))
        if ((layout.start + tip) % (layout.lowest - 1) == 0) return false;
    return gluesToSimplices(layout, disk, cut);
}

std::vector<gim_side> seamWord(const DiskMesh& disk, const CutGraph& cut, const std::vector<int>& pathLength)
{
    std::vector<int> label(cut.paths.size(), -1);
    int labels = 0;
    std::vector<gim_side> word;
    for (const DiskSide& side : disk.sides) {
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

// The asked lowest level, or the smallest from the default on; preferably one whose border is at least twice
// as long as the cut needs, so that lengths can follow the surface.
Result<BorderLayout> proportionalLayout(const CutGraph& cut, const DiskMesh& disk, const Mesh& mesh, int grid,
                                        int asked, SquareLayout kind)
{
    const int first = std::min(kDefaultLowest, std::max(3, (grid - 1) / 4 + 1));
    if (kind == SquareLayout::Octahedral) {
        if (const auto layout = octahedralLayoutAt(asked > 0 ? asked : first, cut, disk)) return *layout;
        return Error{
            ErrorKind::TargetUnreachable,
            "the cut is no star of four paths, or the lowest level is too small: no octahedral layout"};
    }
    std::vector<PathNeeds> needs = pathNeeds(cut);
    double total = 0;
    for (size_t p = 0; p < needs.size(); ++p) {
        needs[p].target = cutLength(mesh, {{cut.paths[p]}});
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

} // namespace gimg

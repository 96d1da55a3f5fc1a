#include "gimg/global_parameterization.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <utility>

namespace gimg {
namespace {

constexpr double kShrunken = 100; // times the least stretch: what the tip is looked for in
constexpr int kBranchRings = 4;   // around branch points, where stretch is small as well

// Distance along edges from the nearest of the given vertices; infinite where there is no way.
std::vector<double> distances(const Mesh& mesh, const std::vector<int>& from)
{
    const Halfedges he(mesh.faces, mesh.vertexCount());
    std::vector<double> distance(mesh.positions.size(), std::numeric_limits<double>::infinity());
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    for (int v : from) {
        distance[v] = 0;
        open.push({0, v});
    }
    std::vector<std::vector<int>> neighbours(mesh.positions.size());
    for (int h = 0; h < he.count(); ++h) {
        neighbours[he.tail(h)].push_back(he.head(h));
        if (he.onBoundary(h)) neighbours[he.head(h)].push_back(he.tail(h));
    }
    while (!open.empty()) {
        const auto [d, v] = open.top();
        open.pop();
        if (d > distance[v]) continue;
        for (int w : neighbours[v]) {
            const double longer = d + (mesh.positions[w] - mesh.positions[v]).norm();
            if (longer >= distance[w]) continue;
            distance[w] = longer;
            open.push({longer, w});
        }
    }
    return distance;
}

// The vertex farthest from some others among those that can be left out.
int farthest(const Mesh& mesh, const std::vector<int>& from)
{
    const std::vector<double> distance = distances(mesh, from);
    std::vector<int> order(mesh.positions.size());
    for (int v = 0; v < mesh.vertexCount(); ++v) order[v] = v;
    std::stable_sort(order.begin(), order.end(), [&](int v, int w) { return distance[v] > distance[w]; });
    for (int v : order)
        if (distance[v] < std::numeric_limits<double>::infinity() && puncture(mesh, {&v, 1}).ok()) return v;
    return -1;
}

std::vector<int> boundaryVertices(const Mesh& mesh)
{
    const Halfedges he(mesh.faces, mesh.vertexCount());
    std::vector<int> vertices;
    for (int h = 0; h < he.count(); ++h)
        if (he.onBoundary(h)) vertices.push_back(he.tail(h));
    return vertices;
}

// Where the most even map of a surface shrinks it most: the far end of that region.
Result<int> mostShrunken(const Mesh& mesh, const ConformalOptions& options)
{
    const Result<SurfaceForms> forms = surfaceForms(mesh, options);
    if (!forms) return forms.error();
    const Result<UniformForm> even = mostUniformForm(mesh, forms->basis, forms->hasBoundary());
    if (!even) return even.error();
    std::vector<int> branches;
    if (forms->hasBoundary()) {
        const Result<BoundedBranchPoints> found =
            branchPoints(*forms->cover, combination(forms->coverBasis, even->coefficients));
        if (!found) return found.error();
        for (const BranchPoints* points : {&found->inside, &found->onBoundary})
            for (const BranchPoint& point : points->points) {
                const int v = std::min(point.vertex, forms->cover->mirror[point.vertex]);
                if (v < mesh.vertexCount()) branches.push_back(v);
            }
    } else {
        const Result<BranchPoints> found = branchPoints(mesh, even->form);
        if (!found) return found.error();
        for (const BranchPoint& point : found->points) branches.push_back(point.vertex);
    }
    const std::vector<bool> nearBranch = ringsAround(mesh, branches, kBranchRings);
    const std::vector<double> stretch = vertexStretch(mesh, even->form);
    double least = std::numeric_limits<double>::infinity();
    for (size_t v = 0; v < stretch.size(); ++v)
        if (!nearBranch[v]) least = std::min(least, stretch[v]);
    std::vector<int> others;
    for (int v = 0; v < mesh.vertexCount(); ++v)
        if (nearBranch[v] || stretch[v] > kShrunken * least) others.push_back(v);
    if (others.empty()) others = boundaryVertices(mesh);
    if (others.empty()) others = {0};
    return farthest(mesh, others);
}

} // namespace

std::vector<bool> ringsAround(const Mesh& mesh, std::span<const int> vertices, int rings)
{
    std::vector<bool> in(mesh.positions.size(), false);
    for (int v : vertices) in[v] = true;
    for (int ring = 0; ring < rings; ++ring) {
        std::vector<bool> wider = in;
        for (const Triangle& t : mesh.faces)
            if (in[t[0]] || in[t[1]] || in[t[2]]) wider[t[0]] = wider[t[1]] = wider[t[2]] = true;
        in.swap(wider);
    }
    return in;
}

Result<std::vector<int>> findPunctures(const Mesh& mesh, int count, const ConformalOptions& options)
{
    if (count < 1) return Error{ErrorKind::BadArgument, "at least one puncture must be asked for"};
    std::vector<int> found;
    while (static_cast<int>(found.size()) < count) {
        const Result<PuncturedSurface> punctured = puncture(mesh, found);
        if (!punctured) return punctured.error();
        const Mesh& rest = punctured->mesh;
        const Topology type = topology(rest);
        int tip = -1;
        if (type.genus == 0 && type.boundaries == 0)
            tip = farthest(rest, {farthest(rest, {0})}); // one end of the longest way
        else if (type.genus == 0 && type.boundaries == 1)
            tip = farthest(rest, boundaryVertices(rest));
        else {
            const Result<int> shrunken = mostShrunken(rest, options);
            if (!shrunken) return shrunken.error();
            tip = *shrunken;
        }
        if (tip < 0) return Error{ErrorKind::BadArgument, "no vertex is left that can be left out"};
        found.push_back(punctured->vertexOf[tip]);
    }
    return found;
}

} // namespace gimg

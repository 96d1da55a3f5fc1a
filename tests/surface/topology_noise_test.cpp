#include "gimg/topology_noise.h"

#include "corpus/shapes.h"
#include "gimg/cut.h"
#include "gimg/disk.h"
#include "manifold_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <queue>

namespace gimg {
namespace {

using std::numbers::pi;

void expectTopology(const Mesh& mesh, int genus, int boundaries)
{
    const test::ManifoldCheck check = test::checkManifold(mesh.faces);
    EXPECT_EQ(check.fault, "");
    EXPECT_EQ(check.genus, genus);
    EXPECT_EQ(check.boundaries, boundaries);
    std::set<int> used;
    for (const Triangle& f : mesh.faces) used.insert(f.begin(), f.end());
    EXPECT_EQ(static_cast<int>(used.size()), mesh.vertexCount());
}

HandleRemoval removed(const Mesh& mesh, const HandleOptions& options)
{
    Result<HandleRemoval> result = removeHandles(mesh, options);
    EXPECT_TRUE(result.ok());
    return *result;
}

HoleClosing closed(const Mesh& mesh, double maxLength)
{
    Result<HoleClosing> result = closeHoles(mesh, maxLength);
    EXPECT_TRUE(result.ok());
    return *result;
}

Mesh withoutLooseVertices(const Mesh& mesh) { return removed(mesh, {topology(mesh).genus}).mesh; }

// The other ends of the edges at an inner vertex, counter-clockwise.
std::vector<int> ringOf(const Mesh& mesh, int v)
{
    const Halfedges he(mesh.faces, mesh.vertexCount());
    std::vector<int> ring;
    const int first = he.outgoing(v);
    for (int h = first; ring.empty() || h != first; h = he.rotateCcw(h)) ring.push_back(he.head(h));
    return ring;
}

Mesh withoutStar(const Mesh& mesh, int v)
{
    Mesh open = mesh;
    std::erase_if(open.faces, [&](const Triangle& f) { return std::find(f.begin(), f.end(), v) != f.end(); });
    return open;
}

// A tube from the ring around one inner vertex to that around another of the same valence.
Mesh withHandle(const Mesh& mesh, int v, int w)
{
    const std::vector<int> from = ringOf(mesh, v), to = ringOf(mesh, w);
    const size_t n = from.size();
    EXPECT_EQ(n, to.size());
    Mesh joined = withoutStar(withoutStar(mesh, v), w);
    for (size_t i = 0; i < n; ++i) {
        const int a = from[i], b = from[(i + 1) % n], c = to[(2 * n - i - 1) % n], d = to[(n - i) % n];
        joined.faces.push_back({a, b, c});
        joined.faces.push_back({a, c, d});
    }
    return withoutLooseVertices(joined);
}

int nearestVertex(const Mesh& mesh, const Vec3& p)
{
    const auto closer = [&](const Vec3& a, const Vec3& b) {
        return (a - p).squaredNorm() < (b - p).squaredNorm();
    };
    return static_cast<int>(std::min_element(mesh.positions.begin(), mesh.positions.end(), closer) -
                            mesh.positions.begin());
}

// The shortest loop of edges that does not separate: of every vertex the shortest path tree, with every edge
// outside the tree a loop; whether it separates is seen by flooding. Boundary loops are filled for that.
class AllLoops
{
public:
    explicit AllLoops(const Mesh& mesh) : mesh_(mesh), filled_(mesh.faces)
    {
        const Halfedges open(mesh.faces, mesh.vertexCount());
        std::vector<int> center(static_cast<size_t>(mesh.vertexCount()), -1);
        int vertices = mesh.vertexCount();
        for (int start = 0; start < open.count(); ++start) {
            if (!open.onBoundary(start) || center[open.tail(start)] >= 0) continue;
            for (int h = start; center[open.tail(h)] < 0; h = open.outgoing(open.head(h))) {
                center[open.tail(h)] = vertices;
                filled_.push_back({open.head(h), open.tail(h), vertices});
            }
            ++vertices;
        }
        he_.emplace(filled_, vertices);
    }

    double shortest() const
    {
        double best = std::numeric_limits<double>::infinity();
        for (int root = 0; root < mesh_.vertexCount(); ++root) best = std::min(best, through(root, best));
        return best;
    }

private:
    bool isReal(int h) const
    {
        return he_->tail(h) < mesh_.vertexCount() && he_->head(h) < mesh_.vertexCount();
    }
    double length(int h) const
    {
        return (mesh_.positions[he_->head(h)] - mesh_.positions[he_->tail(h)]).norm();
    }

    double through(int root, double best) const
    {
        const size_t n = mesh_.positions.size();
        std::vector<double> distance(n, std::numeric_limits<double>::infinity());
        std::vector<int> entry(n, -1);
        std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>>
            queue;
        distance[root] = 0;
        queue.push({0.0, root});
        while (!queue.empty()) {
            const auto [d, v] = queue.top();
            queue.pop();
            if (d > distance[v]) continue;
            const int first = he_->outgoing(v);
            int h = first;
            do {
                if (isReal(h) && d + length(h) < distance[he_->head(h)]) {
                    distance[he_->head(h)] = d + length(h);
                    entry[he_->head(h)] = h;
                    queue.push({distance[he_->head(h)], he_->head(h)});
                }
                h = he_->rotateCcw(h);
            } while (h != first);
        }
        std::vector<std::pair<double, int>> loops;
        for (int h = 0; h < he_->count(); ++h)
            if (isReal(h) && h < he_->twin(h) && entry[he_->head(h)] != h &&
                entry[he_->tail(h)] != he_->twin(h))
                loops.push_back({distance[he_->tail(h)] + length(h) + distance[he_->head(h)], h});
        std::sort(loops.begin(), loops.end());
        for (const auto& [total, h] : loops) {
            if (total >= best) break;
            if (!separates(h, entry)) return total;
        }
        return best;
    }

    bool separates(int closing, const std::vector<int>& entry) const
    {
        std::vector<bool> onLoop(static_cast<size_t>(he_->count()), false);
        const auto flip = [&](int h) { onLoop[h] = onLoop[he_->twin(h)] = !onLoop[h]; };
        flip(closing);
        for (int end : {he_->tail(closing), he_->head(closing)})
            for (int h = entry[end]; h >= 0; h = entry[he_->tail(h)]) flip(h);
        std::vector<bool> seen(filled_.size(), false);
        std::vector<int> stack = {0};
        seen[0] = true;
        size_t count = 1;
        while (!stack.empty()) {
            const int f = stack.back();
            stack.pop_back();
            for (int h = 3 * f; h < 3 * f + 3; ++h) {
                const int g = he_->twin(h) / 3;
                if (onLoop[h] || seen[g]) continue;
                seen[g] = true;
                ++count;
                stack.push_back(g);
            }
        }
        return count < filled_.size();
    }

    const Mesh& mesh_;
    std::vector<Triangle> filled_;
    std::optional<Halfedges> he_;
};

// Uneven edge lengths, so that no two loops are equally long.
Mesh shaken(Mesh mesh)
{
    for (Vec3& p : mesh.positions)
        p += 0.03 * Vec3(std::sin(57 * p[0] + 31 * p[1]), std::sin(43 * p[1] + 71 * p[2]),
                         std::sin(83 * p[2] + p[0]));
    return mesh;
}

TEST(RemoveHandles, LoopOfATorusIsItsShortestCircle)
{
    // A thin one is cut through its tube; one with a narrow opening is cut around the opening.
    const auto perimeter = [](int n, double radius) { return 2 * n * radius * std::sin(pi / n); };
    const auto area = [](int n, double radius) { return 0.5 * n * radius * radius * std::sin(2 * pi / n); };
    struct Case
    {
        double minor, radius;
        int edges;
    };
    for (const auto& [minor, radius, edges] : {Case{0.5, 0.5, 24}, Case{1.8, 0.2, 48}}) {
        const Mesh torus = shapes::torus(2, minor, 48, 24);
        const HandleRemoval result = removed(torus, {});
        ASSERT_EQ(result.handles.size(), 1u);
        const RemovedHandle& handle = result.handles[0];
        EXPECT_EQ(handle.edges, edges);
        EXPECT_NEAR(handle.length, perimeter(edges, radius), 1e-9);
        EXPECT_NEAR(handle.fraction * boundingBoxDiagonal(torus), handle.length, 1e-9);
        EXPECT_NEAR(handle.at.norm(), minor < 1 ? 2 : 0, 1e-9);
        expectTopology(result.mesh, 0, 0);
        EXPECT_NEAR(shapes::volume(result.mesh), shapes::volume(torus), 1e-9);
        EXPECT_NEAR(surfaceArea(result.mesh) - surfaceArea(torus), 2 * area(edges, radius), 1e-9);
        EXPECT_EQ(result.mesh.vertexCount(), torus.vertexCount() + edges + 2);
    }
}

class ShortestLoop : public testing::TestWithParam<std::pair<int, int>>
{
};

TEST_P(ShortestLoop, IsTheShortestOfAllEachTime)
{
    const auto [genus, loops] = GetParam();
    const Mesh mesh = shaken(shapes::surfaceOfGenus(genus, loops, 2));
    const HandleRemoval all = removed(mesh, {});
    ASSERT_EQ(static_cast<int>(all.handles.size()), genus);
    for (int left = genus; left > 0; --left) {
        const HandleRemoval sofar = removed(mesh, {left});
        ASSERT_EQ(static_cast<int>(sofar.handles.size()), genus - left);
        expectTopology(sofar.mesh, left, loops);
        EXPECT_NEAR(all.handles[static_cast<size_t>(genus - left)].length, AllLoops(sofar.mesh).shortest(),
                    1e-9);
    }
    expectTopology(all.mesh, 0, loops);
}

INSTANTIATE_TEST_SUITE_P(Topologies, ShortestLoop,
                         testing::Values(std::pair(1, 0), std::pair(2, 3), std::pair(3, 2)));

TEST(RemoveHandles, TinyHandleGoesAndTheOthersStay)
{
    const Mesh surface = shapes::surfaceOfGenus(2, 0, 10);
    const int v = nearestVertex(surface, {0.3, -0.1, 1}), w = nearestVertex(surface, {0.9, -0.1, 1});
    const Mesh noisy = withHandle(surface, v, w);
    expectTopology(noisy, 3, 0);
    const HandleRemoval result = removed(noisy, {2});
    ASSERT_EQ(result.handles.size(), 1u);
    EXPECT_LT(result.handles[0].fraction, 0.12);
    EXPECT_LT(result.handles[0].edges, 9);
    expectTopology(result.mesh, 2, 0);
    EXPECT_NEAR(shapes::volume(result.mesh) / shapes::volume(noisy), 1, 1e-9);
    EXPECT_NEAR(surfaceArea(result.mesh) / surfaceArea(noisy), 1, 0.01);
    for (int i = 0; i < noisy.vertexCount(); ++i) EXPECT_EQ(result.mesh.positions[i], noisy.positions[i]);
    // The same by length: the next loop is far longer.
    const double length = result.handles[0].length;
    EXPECT_EQ(removed(noisy, {0, length}).mesh.faces, result.mesh.faces);
    EXPECT_EQ(removed(noisy, {0, 1.5 * length}).handles.size(), 1u);
    EXPECT_TRUE(removed(noisy, {0, 0.99 * length}).handles.empty());
    EXPECT_GT(removed(noisy, {1}).handles[1].length, 3 * length);
}

TEST(RemoveHandles, LoopOfThreeEdgesIsClosedByATriangle)
{
    const Mesh torus = shapes::torus(2, 0.5, 24, 3);
    const HandleRemoval result = removed(torus, {});
    ASSERT_EQ(result.handles.size(), 1u);
    EXPECT_EQ(result.handles[0].edges, 3);
    EXPECT_EQ(result.mesh.faceCount(), torus.faceCount() + 2);
    EXPECT_EQ(result.mesh.vertexCount(), torus.vertexCount() + 3);
    expectTopology(result.mesh, 0, 0);
}

TEST(RemoveHandles, LoopAlongBoundariesIsCutThere)
{
    // A triangle is missing beside every second edge of each second circle around the tube, and these
    // circles are the shorter ones.
    constexpr int kAround = 30, kTube = 10;
    Mesh torus = shapes::torus(3, 0.5, kAround, kTube);
    std::vector<Triangle> kept;
    for (int i = 0; i < kAround; ++i)
        for (int j = 0; j < kTube; ++j) {
            const int v = i * kTube + j, face = 2 * v;
            if (i % 2 == 1 || j % 2 == 1) kept.push_back(torus.faces[face]);
            kept.push_back(torus.faces[face + 1]);
            const double angle = 2 * pi * i / kAround;
            const Vec3 axis(3 * std::cos(angle), 3 * std::sin(angle), 0);
            if (i % 2 == 1) torus.positions[v] = axis + 0.9 * (torus.positions[v] - axis);
        }
    torus.faces = kept;
    expectTopology(torus, 1, kAround * kTube / 4);
    const HandleRemoval result = removed(torus, {});
    ASSERT_EQ(result.handles.size(), 1u);
    EXPECT_NEAR(result.handles[0].length, 2 * kTube * 0.45 * std::sin(pi / kTube), 1e-9);
    expectTopology(result.mesh, 0, kAround * kTube / 4);
}

TEST(RemoveHandles, NothingToDoChangesNothing)
{
    const Mesh sphere = shapes::sphere(1, 4);
    EXPECT_EQ(removed(sphere, {}).mesh.faces, sphere.faces);
    const Mesh torus = shapes::torus(2, 1, 12, 8);
    EXPECT_EQ(removed(torus, {1}).mesh.faces, torus.faces);
    EXPECT_EQ(removeHandles(torus, {-1}).error().kind, ErrorKind::BadArgument);
    EXPECT_EQ(removeHandles(torus, {0, -1}).error().kind, ErrorKind::BadArgument);
    EXPECT_EQ(removeHandles(torus, {0, std::nan("")}).error().kind, ErrorKind::BadArgument);
    EXPECT_EQ(closeHoles(torus, std::nan("")).error().kind, ErrorKind::BadArgument);
}

TEST(CloseHoles, PuncturesOfASphereAreFilledAndLargerOnesStay)
{
    const Mesh sphere = shapes::sphere(1, 16);
    Mesh open = sphere;
    for (const Vec3& p : {Vec3(0.2, 0, 1), Vec3(-1, 0.3, 0.1), Vec3(0.4, 0.4, -0.8)})
        open = withoutStar(open, nearestVertex(sphere, p));
    std::erase_if(open.faces, [&](const Triangle& f) { return open.positions[f[0]][1] > 0.7; });
    open = withoutLooseVertices(open);
    expectTopology(open, 0, 4);
    const HoleClosing result = closed(open, 1.0);
    ASSERT_EQ(result.holes.size(), 3u);
    expectTopology(result.mesh, 0, 1);
    for (const ClosedHole& hole : result.holes) {
        EXPECT_EQ(hole.edges, 6);
        EXPECT_EQ(hole.zipped, 0);
        EXPECT_NEAR(hole.at.norm(), 1, 0.01);
        EXPECT_NEAR(hole.length, 2 * pi * 0.07, 0.06);
    }
    EXPECT_LE(result.holes[0].length, result.holes[2].length);
    const HoleClosing everything = closed(open, 10);
    expectTopology(everything.mesh, 0, 0);
    EXPECT_TRUE(closed(open, 0.1).holes.empty());
    // The cap of the large hole is flat: what it cuts off a sphere has this area and volume.
    const double h = 0.3, base = pi * h * (2 - h);
    EXPECT_NEAR(surfaceArea(everything.mesh), surfaceArea(sphere) - 2 * pi * h + base, 0.1);
    EXPECT_NEAR(shapes::volume(everything.mesh), shapes::volume(sphere) - pi * h * h * (1 - h / 3), 0.05);
}

Mesh sphereWithCrack(int edges)
{
    const Mesh sphere = shapes::sphere(1, 8);
    const Halfedges he(sphere.faces, sphere.vertexCount());
    CutPath path;
    path.vertices = {nearestVertex(sphere, {0, 0, 1})};
    while (static_cast<int>(path.vertices.size()) <= edges) {
        int next = -1; // as far to +x as one edge goes
        for (int v : ringOf(sphere, path.vertices.back()))
            if (next < 0 || sphere.positions[v][0] > sphere.positions[next][0]) next = v;
        path.vertices.push_back(next);
    }
    const Result<DiskMesh> opened = openAlong(sphere, {{path}});
    EXPECT_TRUE(opened.ok());
    return opened->mesh;
}

TEST(CloseHoles, CrackIsZipped)
{
    const Mesh cracked = sphereWithCrack(5);
    const Mesh sphere = shapes::sphere(1, 8);
    expectTopology(cracked, 0, 1);
    const HoleClosing result = closed(cracked, 3);
    ASSERT_EQ(result.holes.size(), 1u);
    EXPECT_EQ(result.holes[0].edges, 10);
    EXPECT_EQ(result.holes[0].zipped, 5);
    expectTopology(result.mesh, 0, 0);
    EXPECT_EQ(result.mesh.vertexCount(), sphere.vertexCount());
    EXPECT_EQ(result.mesh.faceCount(), sphere.faceCount());
    EXPECT_NEAR(surfaceArea(result.mesh), surfaceArea(sphere), 1e-9);
}

TEST(CloseHoles, CrackWithAVertexOnOneSideOnlyIsZippedAsFarAsItGoes)
{
    Mesh cracked = sphereWithCrack(5);
    const Halfedges he(cracked.faces, cracked.vertexCount());
    int h = 0; // an edge in the middle of the crack
    while (!he.onBoundary(h) || std::abs(cracked.positions[he.tail(h)][0] - 0.4) > 0.1) ++h;
    const int middle = cracked.vertexCount();
    cracked.positions.push_back(0.5 * (cracked.positions[he.tail(h)] + cracked.positions[he.head(h)]));
    const int apex = he.tail(Halfedges::prev(h));
    cracked.faces[static_cast<size_t>(h / 3)] = {he.tail(h), middle, apex};
    cracked.faces.push_back({middle, he.head(h), apex});
    const HoleClosing result = closed(cracked, 3);
    ASSERT_EQ(result.holes.size(), 1u);
    EXPECT_EQ(result.holes[0].edges, 11);
    EXPECT_EQ(result.holes[0].zipped, 4);
    expectTopology(result.mesh, 0, 0);
    EXPECT_EQ(result.mesh.faceCount(), cracked.faceCount() + 1);
    EXPECT_NEAR(surfaceArea(result.mesh), surfaceArea(shapes::sphere(1, 8)), 1e-9);
}

TEST(CloseHoles, HoleAmongVerticesThatAreAllAdjacentGetsACentre)
{
    // The torus of seven vertices, each of which is adjacent to all others.
    Mesh torus;
    for (int i = 0; i < 7; ++i) torus.positions.emplace_back(std::cos(i), std::sin(i), 0.1 * i * i);
    for (int i = 0; i < 7; ++i) {
        torus.faces.push_back({i, (i + 1) % 7, (i + 3) % 7});
        torus.faces.push_back({i, (i + 3) % 7, (i + 2) % 7});
    }
    expectTopology(torus, 1, 0);
    for (const bool touching : {false, true}) {
        Mesh open = torus;
        const std::vector<int> ring = ringOf(open, 0);
        if (touching) open.positions[ring[2]] = open.positions[ring[0]]; // as if a crack, but they are joined
        open = withoutLooseVertices(withoutStar(open, 0));
        expectTopology(open, 1, 1);
        const HoleClosing result = closed(open, 100);
        ASSERT_EQ(result.holes.size(), 1u);
        EXPECT_EQ(result.holes[0].zipped, 0);
        expectTopology(result.mesh, 1, 0);
        EXPECT_EQ(result.mesh.vertexCount(), 7);
    }
}

TEST(CloseHoles, HandlesStay)
{
    const Mesh surface = shapes::surfaceOfGenus(2, 4, 8);
    const HoleClosing result = closed(surface, 100);
    EXPECT_EQ(result.holes.size(), 4u);
    expectTopology(result.mesh, 2, 0);
    expectTopology(removed(result.mesh, {}).mesh, 0, 0);
}

} // namespace
} // namespace gimg

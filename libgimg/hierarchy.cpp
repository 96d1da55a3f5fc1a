#include "hierarchy.h"

#include <algorithm>
#include <limits>
#include <queue>

namespace gimg {

struct Hierarchy::Candidate
{
    double cost = std::numeric_limits<double>::infinity();
    int vertex = -1;
    int target = -1;
    int stamp = 0;
    bool operator<(const Candidate& other) const
    {
        return cost != other.cost ? cost > other.cost : vertex > other.vertex; // cheapest on top
    }
};

Hierarchy::Hierarchy(const Mesh& disk, const std::vector<uint8_t>& squareSides)
    : disk_(disk), squareSides_(squareSides), faces_(disk.faces), faceAlive_(disk.faces.size(), true),
      vertexAlive_(disk.positions.size(), true), facesOf_(disk.positions.size()),
      quadric_(disk.positions.size(), Eigen::Matrix4d::Zero()), ringMark_(disk.positions.size(), 0),
      seenMark_(disk.positions.size(), 0)
{
    for (size_t f = 0; f < faces_.size(); ++f) {
        const Vec3& p = disk.positions[faces_[f][0]];
        Vec3 normal = (disk.positions[faces_[f][1]] - p).cross(disk.positions[faces_[f][2]] - p);
        const double doubled = normal.norm();
        if (doubled > 0) normal /= doubled;
        const Eigen::Vector4d plane(normal.x(), normal.y(), normal.z(), -normal.dot(p));
        for (int v : faces_[f]) {
            facesOf_[v].push_back(static_cast<int>(f));
            quadric_[v] += doubled * (plane * plane.transpose());
        }
        scale_ += doubled;
    }
    for (size_t v = 0; v < disk.positions.size(); ++v) interior_ += squareSides[v] == 0;
    // A flat region still prefers short collapses, so that coarse triangles stay round.
    scale_ *= 1e-3 / static_cast<double>(std::max<size_t>(1, faces_.size()));
}

void Hierarchy::findRing(int v)
{
    // Each face at v contributes a step from its second to its third corner.
    steps_.clear();
    for (int f : facesOf_[v]) {
        const Triangle& t = faces_[f];
        const int k = t[0] == v ? 0 : t[1] == v ? 1 : 2;
        steps_.push_back({t[(k + 1) % 3], t[(k + 2) % 3]});
    }
    ring_ = {steps_[0].first};
    for (size_t i = 1; i < steps_.size(); ++i)
        for (const auto& step : steps_)
            if (step.first == ring_.back()) {
                ring_.push_back(step.second);
                break;
            }
}

std::vector<Triangle> Hierarchy::star(int v) const
{
    std::vector<Triangle> triangles;
    for (int f : facesOf_[v]) {
        Triangle t = faces_[f];
        while (t[0] != v) std::rotate(t.begin(), t.begin() + 1, t.end());
        triangles.push_back(t);
    }
    return triangles;
}

double Hierarchy::quadricError(int v, int target) const
{
    const Vec3& p = disk_.positions[target];
    const Eigen::Vector4d h(p.x(), p.y(), p.z(), 1);
    return std::max(0.0, h.dot((quadric_[v] + quadric_[target]) * h)) +
           scale_ * (p - disk_.positions[v]).squaredNorm();
}

int Hierarchy::commonNeighbours(int u)
{
    ++seen_;
    int common = 0;
    for (int f : facesOf_[u])
        for (int w : faces_[f]) {
            if (ringMark_[w] != mark_ || seenMark_[w] == seen_ || w == u) continue;
            seenMark_[w] = seen_;
            ++common;
        }
    return common;
}

// The cheapest neighbour that v may collapse to.
bool Hierarchy::findCollapse(int v, size_t largestValence, Candidate& candidate)
{
    findRing(v);
    const std::vector<int>& around = ring_;
    const size_t k = around.size();
    candidate.cost = std::numeric_limits<double>::infinity();
    candidate.vertex = v;
    ++mark_;
    size_t borderNeighbours = 0;
    for (int w : around) {
        ringMark_[w] = mark_;
        borderNeighbours += squareSides_[w] != 0;
    }
    normals_.resize(k); // of v's faces, twice their area long; with their lengths
    for (size_t j = 0; j < k; ++j) {
        const Vec3 &p = disk_.positions[v], &a = disk_.positions[around[j]],
                   &b = disk_.positions[around[(j + 1) % k]];
        const Vec3 normal = (a - p).cross(b - p);
        normals_[j] = {normal, normal.norm()};
    }
    for (size_t i = 0; i < k; ++i) {
        const int u = around[i];
        const size_t left = (i + 1) % k, right = (i + k - 1) % k;
        if (squareSides_[u] != 0) {
            // No new edge may join two border vertices.
            const size_t linked = 1 + (squareSides_[around[left]] != 0) + (squareSides_[around[right]] != 0);
            if (borderNeighbours > linked) continue;
        } else if (facesOf_[u].size() + k > largestValence + 4) {
            continue;
        }
        double cost = quadricError(v, u);
        if (cost >= candidate.cost) continue;
        // Folding over is costly but not forbidden, so that coarsening never gets stuck.
        for (size_t j = 0; j < k && cost < candidate.cost; ++j) {
            const size_t next = (j + 1) % k;
            if (j == i || next == i) continue;
            const Vec3& a = disk_.positions[around[j]];
            const Vec3& b = disk_.positions[around[next]];
            const auto& [before, beforeLength] = normals_[j];
            const Vec3 after = (a - disk_.positions[u]).cross(b - disk_.positions[u]);
            const double afterLength = after.norm();
            if (before.dot(after) <= 0.2 * beforeLength * afterLength)
                cost += afterLength * (a - disk_.positions[u]).squaredNorm();
        }
        // Link condition: only the two ring vertices next to u may be neighbours of both, or an edge doubles.
        if (cost < candidate.cost && commonNeighbours(u) == 2) {
            candidate.cost = cost;
            candidate.target = u;
        }
    }
    return candidate.cost < std::numeric_limits<double>::infinity();
}

void Hierarchy::collapse(const Candidate& candidate)
{
    Removal removal{candidate.vertex, candidate.target, {}, {-1, -1}};
    int deleted = 0;
    for (int f : facesOf_[removal.vertex]) {
        Triangle& t = faces_[f];
        if (std::find(t.begin(), t.end(), removal.target) != t.end()) {
            removal.deleted[deleted++] = f;
            faceAlive_[f] = false;
            for (int w : t)
                if (w != removal.vertex) std::erase(facesOf_[w], f);
        } else {
            removal.moved.push_back(f);
            std::replace(t.begin(), t.end(), removal.vertex, removal.target);
            facesOf_[removal.target].push_back(f);
        }
    }
    quadric_[removal.target] += quadric_[removal.vertex];
    facesOf_[removal.vertex].clear();
    vertexAlive_[removal.vertex] = false;
    --interior_;
    removals_.push_back(std::move(removal));
}

void Hierarchy::coarsenTo(int interior)
{
    // Bounded valences give well-shaped levels; the last vertices need more.
    for (size_t largestValence : {14, 40, 200}) coarsen(largestValence, interior);
    coarsen(disk_.positions.size(), interior);
}

void Hierarchy::coarsen(size_t largestValence, int interior)
{
    std::vector<int> stamp(disk_.positions.size(), 0);
    std::priority_queue<Candidate> queue;
    const auto enqueue = [&](int v) {
        if (squareSides_[v] != 0 || !vertexAlive_[v]) return;
        Candidate candidate;
        ++stamp[v];
        if (!findCollapse(v, largestValence, candidate)) return;
        candidate.stamp = stamp[v];
        queue.push(candidate);
    };
    for (int v = 0; v < disk_.vertexCount(); ++v) enqueue(v);
    while (interior_ > interior && !queue.empty()) {
        const Candidate best = queue.top();
        queue.pop();
        if (!vertexAlive_[best.vertex] || best.stamp != stamp[best.vertex]) continue;
        // The neighbourhood may have changed without this vertex being asked again.
        Candidate now;
        if (!findCollapse(best.vertex, largestValence, now)) continue;
        if (now.cost > best.cost * (1 + 1e-12)) {
            now.stamp = ++stamp[best.vertex];
            queue.push(now);
            continue;
        }
        const std::vector<int> around = ring_; // as findCollapse left it
        collapse(now);
        for (int w : around) enqueue(w);
    }
}

Mesh Hierarchy::current(std::vector<int>& vertexOf) const
{
    Mesh mesh;
    vertexOf.clear();
    std::vector<int> index(disk_.positions.size(), -1);
    for (int v = 0; v < disk_.vertexCount(); ++v) {
        if (!vertexAlive_[v]) continue;
        index[v] = mesh.vertexCount();
        vertexOf.push_back(v);
        mesh.positions.push_back(disk_.positions[v]);
    }
    for (size_t f = 0; f < faces_.size(); ++f)
        if (faceAlive_[f])
            mesh.faces.push_back({index[faces_[f][0]], index[faces_[f][1]], index[faces_[f][2]]});
    return mesh;
}

int Hierarchy::refine()
{
    const Removal removal = std::move(removals_.back());
    removals_.pop_back();
    for (int f : removal.moved) {
        std::replace(faces_[f].begin(), faces_[f].end(), removal.target, removal.vertex);
        std::erase(facesOf_[removal.target], f);
        facesOf_[removal.vertex].push_back(f);
    }
    for (int f : removal.deleted) {
        faceAlive_[f] = true;
        for (int w : faces_[f]) facesOf_[w].push_back(f);
    }
    vertexAlive_[removal.vertex] = true;
    ++interior_;
    return removal.vertex;
}

} // namespace gimg

#include "polygon_triangulator.h"

#include <algorithm>
#include <limits>

namespace gimg {

namespace {

constexpr int kLargestProgrammed = 32; // the table takes n^2 cells and n^3 / 6 steps

// Past these numbers of point tests ears are cut unseen: no file may take minutes.
constexpr int64_t kPolygonTests = int64_t{1} << 23;
constexpr int64_t kAllTests = int64_t{1} << 26;

uint64_t edgeKey(int a, int b)
{
    const auto [low, high] = std::minmax(a, b);
    return static_cast<uint64_t>(low) << 32 | static_cast<uint32_t>(high);
}

/// Smaller is better: first the diagonals that double an edge, then area, then length to break ties among
/// flat ones.
struct Cost
{
    int doubled = 0;
    double area = 0;
    double length2 = 0; ///< sum of the squared lengths of the diagonals

    bool operator<(const Cost& o) const
    {
        if (doubled != o.doubled) return doubled < o.doubled;
        // Areas of triangulations of a flat polygon differ by rounding only.
        const double slack = 1e-9 * std::max(area, o.area);
        if (area < o.area - slack) return true;
        if (o.area < area - slack) return false;
        return length2 < o.length2;
    }
};

} // namespace

PolygonTriangulator::PolygonTriangulator(const PolygonSoup& soup) : soup_(soup)
{
    if (soup.corners.size() == 3 * soup.faceCount()) return; // triangles only: there will be no diagonals
    for (size_t f = 0; f < soup.faceCount(); ++f) {
        const std::span<const int> face = soup.face(f);
        for (size_t k = 0; k < face.size(); ++k)
            edges_.push_back(edgeKey(face[k], face[(k + 1) % face.size()]));
    }
    std::sort(edges_.begin(), edges_.end());
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
}

bool PolygonTriangulator::isEdge(int a, int b) const
{
    const uint64_t key = edgeKey(a, b);
    return std::binary_search(edges_.begin(), edges_.end(), key) || diagonals_.contains(key);
}

void PolygonTriangulator::append(std::span<const int> polygon, std::vector<Triangle>& triangles)
{
    if (polygon.size() == 3) {
        triangles.push_back({polygon[0], polygon[1], polygon[2]});
        return;
    }
    ring_.clear();
    for (int v : polygon)
        if (ring_.empty() || ring_.back() != v) ring_.push_back(v);
    while (ring_.size() > 1 && ring_.back() == ring_.front()) ring_.pop_back();
    if (ring_.size() < 3) {
        if (!ring_.empty()) triangles.push_back({ring_.front(), ring_.back(), ring_.back()});
        return;
    }
    if (ring_.size() <= kLargestProgrammed)
        leastArea(triangles);
    else
        clipEars(triangles);
}

void PolygonTriangulator::leastArea(std::vector<Triangle>& triangles)
{
    const int n = static_cast<int>(ring_.size());
    const auto at = [&](int i) -> const Vec3& { return soup_.positions[ring_[i]]; };
    // Cell (i, j): the best triangulation of the corners i..j, closed by the chord i-j.
    std::vector<Cost> cost(static_cast<size_t>(n) * n);
    std::vector<int> apex(static_cast<size_t>(n) * n, -1);
    for (int span = 2; span < n; ++span)
        for (int i = 0, j = span; j < n; ++i, ++j) {
            Cost chord;
            if (span < n - 1) {
                chord.doubled = isEdge(ring_[i], ring_[j]) || ring_[i] == ring_[j];
                chord.length2 = (at(j) - at(i)).squaredNorm();
            }
            Cost best;
            int bestApex = -1;
            for (int k = i + 1; k < j; ++k) {
                const Cost &left = cost[i * n + k], &right = cost[k * n + j];
                const double area = 0.5 * (at(k) - at(i)).cross(at(j) - at(i)).norm();
                const Cost c{left.doubled + right.doubled + chord.doubled, left.area + right.area + area,
                             left.length2 + right.length2 + chord.length2};
                if (bestApex < 0 || c < best) {
                    best = c;
                    bestApex = k;
                }
            }
            cost[i * n + j] = best;
            apex[i * n + j] = bestApex;
        }
    std::vector<std::pair<int, int>> chords{{0, n - 1}};
    while (!chords.empty()) {
        const auto [i, j] = chords.back();
        chords.pop_back();
        if (j - i < 2) continue;
        const int k = apex[i * n + j];
        triangles.push_back({ring_[i], ring_[k], ring_[j]});
        if (j - i < n - 1) diagonals_.insert(edgeKey(ring_[i], ring_[j]));
        chords.emplace_back(k, j);
        chords.emplace_back(i, k);
    }
}

// In the projection along the polygon's area vector, which shrinks the polygon least.
void PolygonTriangulator::clipEars(std::vector<Triangle>& triangles)
{
    Vec3 normal = Vec3::Zero();
    const Vec3& origin = soup_.positions[ring_[0]];
    for (size_t k = 1; k + 1 < ring_.size(); ++k)
        normal += (soup_.positions[ring_[k]] - origin).cross(soup_.positions[ring_[k + 1]] - origin);
    int drop = 0;
    normal.cwiseAbs().maxCoeff(&drop);
    const int n = static_cast<int>(ring_.size());
    std::vector<Vec2> flat;
    for (int v : ring_) {
        const Vec3& p = soup_.positions[v];
        flat.emplace_back(p[(drop + 1) % 3], normal[drop] < 0 ? -p[(drop + 2) % 3] : p[(drop + 2) % 3]);
    }
    const auto turn = [&flat](int i, int j, int k) { // twice the area of the corners i, j, k
        const Vec2 a = flat[j] - flat[i], b = flat[k] - flat[i];
        return a[0] * b[1] - a[1] * b[0];
    };

    std::vector<int> next(ring_.size()), prev(ring_.size());
    for (int i = 0; i < n; ++i) {
        next[i] = (i + 1) % n;
        prev[i] = (i + n - 1) % n;
    }
    const auto reflex = [&](int i) { return !(turn(prev[i], i, next[i]) > 0); };
    std::vector<int> reflexCorners; // only these can lie inside an ear; clipping makes no new ones
    for (int i = 0; i < n; ++i)
        if (reflex(i)) reflexCorners.push_back(i);
    std::vector<bool> clipped(ring_.size(), false);

    int64_t tests = 0;
    const auto isEar = [&](int i) {
        const int a = prev[i], c = next[i];
        ++tests;
        if (reflex(i) || isEdge(ring_[a], ring_[c])) return false;
        for (int r : reflexCorners) {
            ++tests;
            if (clipped[r] || turn(a, i, r) < 0 || turn(i, c, r) < 0 || turn(c, a, r) < 0) continue;
            if (ring_[r] != ring_[a] && ring_[r] != ring_[i] && ring_[r] != ring_[c]) return false;
        }
        return true;
    };
    int left = n;
    int misses = 0;
    for (int i = 0; left > 3;) {
        // Where no ear is left (the projection crosses itself) any corner will do.
        if (misses > left || tests > kPolygonTests || tests_ > kAllTests || isEar(i)) {
            triangles.push_back({ring_[prev[i]], ring_[i], ring_[next[i]]});
            diagonals_.insert(edgeKey(ring_[prev[i]], ring_[next[i]]));
            clipped[i] = true;
            next[prev[i]] = next[i];
            prev[next[i]] = prev[i];
            --left;
            misses = 0;
            i = next[next[i]]; // every other corner first: fat triangles, no fan
        } else {
            ++misses;
            i = next[i];
        }
        if (left == 3) triangles.push_back({ring_[prev[i]], ring_[i], ring_[next[i]]});
    }
    tests_ += tests;
}

} // namespace gimg

#include "crease_net.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gimg {
namespace {

constexpr double kTurn = 40; // degrees: a chain that turns by more has a corner there

using Segments = std::vector<CreaseNet::Segment>;

Vec3 normalOf(const std::vector<Vec3>& x, const Triangle& t)
{
    return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).normalized();
}

Segments sharpEdges(const std::vector<Vec3>& x, const std::vector<Triangle>& faces, double angle)
{
    const Halfedges he(faces, static_cast<int>(x.size()));
    const double cosine = std::cos(angle * std::numbers::pi / 180);
    Segments sharp;
    for (int h = 0; h < he.count(); ++h) {
        const int twin = he.twin(h);
        if (twin < h) continue;
        const Vec3 left = normalOf(x, faces[Halfedges::face(h)]),
                   right = normalOf(x, faces[Halfedges::face(twin)]);
        // Faces without area, whose normal is zero or is not a number, are no side of an edge.
        if (!(left.squaredNorm() > 0.5 && right.squaredNorm() > 0.5 && left.dot(right) < cosine)) continue;
        const int a = he.tail(h), b = he.head(h);
        const Vec3 along = (x[b] - x[a]).normalized();
        // Into the faces, at right angles to the edge; folded flat they are opposite normals' difference.
        const Vec3 side = left.cross(along) - right.cross(-along);
        if (!(side.squaredNorm() > 1e-12)) continue;
        sharp.push_back({x[a], x[b], side.normalized(), left + right, {a, b}});
    }
    return sharp;
}

// The segments that end at each vertex.
std::vector<std::vector<int>> fansOf(const Segments& segments, int vertexCount)
{
    std::vector<std::vector<int>> fans(vertexCount);
    for (size_t s = 0; s < segments.size(); ++s)
        for (const int v : segments[s].end) fans[v].push_back(static_cast<int>(s));
    return fans;
}

double turnAt(const Segments& segments, const std::vector<int>& fan, int vertex)
{
    const auto away = [&](const CreaseNet::Segment& s) -> Vec3 {
        return s.end[0] == vertex ? s.direction() : Vec3(-s.direction());
    };
    const double cosine = -away(segments[fan[0]]).dot(away(segments[fan[1]]));
    return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

} // namespace

Vec3 CreaseNet::Segment::nearest(const Vec3& q) const
{
    const Vec3 d = to - from;
    return from + std::clamp(d.dot(q - from) / d.squaredNorm(), 0.0, 1.0) * d;
}

CreaseNet::CreaseNet(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces, double angle,
                     double shortest)
    : segments_(sharpEdges(positions, faces, angle))
{
    const auto vertices = static_cast<int>(positions.size());
    // A chain that is left out can join two others to one, or leave a third one loose.
    for (size_t before = 0; before != segments_.size();) {
        before = segments_.size();
        linkChains(vertices);
        const std::vector<std::vector<int>> fans = fansOf(segments_, vertices);
        std::vector<double> lengths(chains_, 0);
        std::vector<bool> loose(chains_, true);
        for (const Segment& s : segments_) {
            lengths[s.chain] += (s.to - s.from).norm();
            for (const int v : s.end)
                if (fans[v].size() > 2) loose[s.chain] = false;
        }
        for (const Segment& s : segments_)
            for (const int v : s.end)
                if (fans[v].size() == 1) loose[s.chain] = true;
        std::erase_if(segments_,
                      [&](const Segment& s) { return loose[s.chain] && lengths[s.chain] < shortest; });
    }
    std::vector<Vec3> ends;
    std::vector<Triangle> lines;
    for (const Segment& s : segments_) {
        const auto k = static_cast<int>(ends.size());
        ends.insert(ends.end(), {s.from, s.to});
        lines.push_back({k, k + 1, k + 1});
    }
    if (!lines.empty()) tree_ = NearestTree(std::move(ends), lines);
}

void CreaseNet::linkChains(int vertexCount)
{
    corners_.clear();
    for (Segment& s : segments_) s.next = {-1, -1}, s.chain = -1;
    const std::vector<std::vector<int>> fans = fansOf(segments_, vertexCount);
    std::vector<int> sharp; // vertices
    for (int v = 0; v < vertexCount; ++v) {
        const std::vector<int>& fan = fans[v];
        if (fan.size() < 2) continue;
        if (fan.size() > 2 || turnAt(segments_, fan, v) > kTurn) {
            sharp.push_back(v);
            continue;
        }
        for (int k = 0; k < 2; ++k) {
            Segment& s = segments_[fan[k]];
            s.next[s.end[0] == v ? 0 : 1] = fan[1 - k];
        }
    }
    chains_ = 0;
    for (size_t first = 0; first < segments_.size(); ++first) {
        if (segments_[first].chain >= 0) continue;
        std::vector<int> open = {static_cast<int>(first)};
        while (!open.empty()) {
            Segment& s = segments_[open.back()];
            open.pop_back();
            s.chain = chains_;
            for (const int t : s.next)
                if (t >= 0 && segments_[t].chain < 0) open.push_back(t);
        }
        ++chains_;
    }
    for (const int v : sharp) {
        const Segment& first = segments_[fans[v][0]];
        Corner corner{first.end[0] == v ? first.from : first.to, Vec3::Zero(), {}};
        for (const int s : fans[v]) {
            corner.outwards += segments_[s].outwards;
            corner.chains.push_back(segments_[s].chain);
        }
        corners_.push_back(std::move(corner));
    }
}

double CreaseNet::length() const
{
    double sum = 0;
    for (const Segment& s : segments_) sum += (s.to - s.from).norm();
    return sum;
}

CreaseNet::Place CreaseNet::nearest(const Vec3& q) const
{
    const int s = tree_.nearest(q, 0).face;
    return {segments_[s].nearest(q), s};
}

CreaseNet::Place CreaseNet::nearestAlong(const Vec3& q, int segment) const
{
    Place best{segments_[segment].nearest(q), segment};
    // Small facets can make the distance rise for a step before it falls again.
    constexpr int kPatience = 3;
    for (const int towards : {0, 1}) {
        int at = segment, came = towards, worse = 0;
        while (worse < kPatience) {
            const int next = segments_[at].next[came];
            if (next < 0 || next == segment) break;
            came = segments_[next].next[0] == at ? 1 : 0;
            at = next;
            const Vec3 point = segments_[at].nearest(q);
            if ((point - q).squaredNorm() < (best.point - q).squaredNorm())
                best = {point, at}, worse = 0;
            else
                ++worse;
        }
    }
    return best;
}

} // namespace gimg

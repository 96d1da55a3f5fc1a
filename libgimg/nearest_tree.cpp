#include "nearest_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace gimg {

namespace {

constexpr double kLargestCoordinate = 1e9;  // in units of the frame: beyond, floats cull nothing
constexpr double kRoundingDistance = 1e-14; // samples of a triangle lie this far off it
constexpr double kOnePoint = 1e-12;         // so near, two nearest points are one
constexpr double kSliverSine2 = 1e-16;      // below, rounding turns a normal more than the triangle is wide
constexpr double kNoNormal = 1e-9;          // of all weights: normals that cancel leave rounding

bool hasNormal(const Vec3& n, const Vec3& ab, const Vec3& ac)
{
    return n.squaredNorm() > kSliverSine2 * ab.squaredNorm() * ac.squaredNorm();
}

double alongSegment(const Vec3& q, const Vec3& a, const Vec3& b)
{
    const Vec3 ab = b - a;
    const double length2 = ab.squaredNorm();
    return length2 > 0 ? std::clamp((q - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
}

double squaredDistanceToSegment(const Vec3& q, const Vec3& a, const Vec3& b)
{
    return (q - a - alongSegment(q, a, b) * (b - a)).squaredNorm();
}

/// The point that squaredDistanceToTriangle() measures to, as weights of a, b, c.
Vec3 nearestOnTriangle(const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c)
{
    const Vec3 ab = b - a, ac = c - a;
    const Vec3 n = ab.cross(ac);
    const double overA = (c - b).cross(q - b).dot(n), overB = (q - a).cross(ac).dot(n),
                 overC = ab.cross(q - a).dot(n);
    if (hasNormal(n, ab, ac) && overA >= 0 && overB >= 0 && overC >= 0)
        return Vec3(overA, overB, overC) / (overA + overB + overC);
    const Vec3* corners[] = {&a, &b, &c};
    Vec3 best = Vec3::Zero();
    double best2 = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        const Vec3 &from = *corners[k], &to = *corners[(k + 1) % 3];
        const double t = alongSegment(q, from, to);
        const double distance2 = (q - from - t * (to - from)).squaredNorm();
        if (distance2 >= best2) continue;
        best2 = distance2;
        best.setZero();
        best[k] = 1 - t;
        best[(k + 1) % 3] = t;
    }
    return best;
}

} // namespace

double squaredDistanceToTriangle(const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c)
{
    const Vec3 ab = b - a, ac = c - a, bc = c - b;
    const Vec3 aq = q - a, bq = q - b;
    const Vec3 n = ab.cross(ac);
    const bool flat = !hasNormal(n, ab, ac);
    const bool beyondAb = flat || ab.cross(aq).dot(n) < 0, beyondBc = flat || bc.cross(bq).dot(n) < 0,
               beyondAc = flat || aq.cross(ac).dot(n) < 0;
    if (!beyondAb && !beyondBc && !beyondAc) {
        const double h = aq.dot(n);
        return h * h / n.squaredNorm();
    }
    // The nearest point of a convex polygon lies on an edge that separates it from q.
    double nearest = std::numeric_limits<double>::infinity();
    if (beyondAb) nearest = squaredDistanceToSegment(q, a, b);
    if (beyondBc) nearest = std::min(nearest, squaredDistanceToSegment(q, b, c));
    if (beyondAc) nearest = std::min(nearest, squaredDistanceToSegment(q, a, c));
    return nearest;
}

UnitFrame::UnitFrame(const Mesh& mesh)
{
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 high = -low;
    for (const Triangle& t : mesh.faces)
        for (int v : t) {
            low = low.cwiseMin(mesh.positions[v]);
            high = high.cwiseMax(mesh.positions[v]);
        }
    center = low + (high - low) / 2;
    int exponent = 0;
    std::frexp((high - low).maxCoeff(), &exponent);
    scale = std::ldexp(1.0, -exponent);
}

std::vector<Vec3> UnitFrame::inside(const Mesh& mesh) const
{
    std::vector<Vec3> positions(mesh.positions.size(), Vec3::Zero());
    for (const Triangle& t : mesh.faces)
        for (int v : t) positions[v] = inside(mesh.positions[v]);
    return positions;
}

NearestTree::NearestTree(std::vector<Vec3> positions, const std::vector<Triangle>& faces)
    : faces_(faces), positions_(std::move(positions))
{
    for (const Triangle& t : faces_)
        for (int v : t) extent_ = std::max(extent_, positions_[v].cwiseAbs().maxCoeff());
    if (!tooLarge()) scene_ = EmbreeScene(positions_, faces_);
}

bool NearestTree::tooLarge() const { return !(extent_ <= kLargestCoordinate); }

/// Embree culls with rounded coordinates: neither those of the triangles nor that of the query may hide the
/// nearest triangle, so the search radius stays a little larger than the distance found. Every triangle that
/// ties with the nearest one is then seen too.
struct NearestTree::Query
{
    const NearestTree& tree;
    const Vec3& q;
    Found best;
    std::vector<Found>* ties =
        nullptr; ///< all faces that may be as near as the nearest one, but for rounding
    double slack = 0, tieDistance2 = 0;

    /// Takes the new best distance over; returns the radius.
    float radius()
    {
        const double distance = std::sqrt(best.distance2);
        if (ties) {
            const double limit = distance + tree.onePoint();
            tieDistance2 = limit * limit;
        }
        return static_cast<float>(distance * (1 + 1e-5) + slack);
    }

    bool visit(int face, float& queryRadius)
    {
        // Most triangles of a leaf are farther, which their boxes show at a fraction of the cost.
        if (tree.distance2ToBox(q, face) > (ties ? tieDistance2 : best.distance2) * (1 + 1e-9)) return false;
        const double distance2 = tree.distance2ToFace(q, face);
        if (ties && distance2 <= tieDistance2) ties->push_back({face, distance2});
        if (distance2 >= best.distance2) {
            if (distance2 == best.distance2) best.face = std::min(best.face, face);
            return false;
        }
        best = {face, distance2};
        const float smaller = radius();
        if (smaller >= queryRadius) return false;
        queryRadius = smaller;
        return true;
    }
};

void NearestTree::search(Query& query) const
{
    query.slack = 4e-7 * (extent_ + query.q.cwiseAbs().maxCoeff());
    const Eigen::Vector3f rounded = query.q.cast<float>();
    RTCPointQuery sphere{};
    sphere.x = rounded[0];
    sphere.y = rounded[1];
    sphere.z = rounded[2];
    sphere.radius = query.radius();
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    const auto visit = [](RTCPointQueryFunctionArguments* arguments) {
        return static_cast<Query*>(arguments->userPtr)
            ->visit(static_cast<int>(arguments->primID), arguments->query->radius);
    };
    rtcPointQuery(scene_.get(), &sphere, &context, visit, &query);
}

NearestTree::Found NearestTree::nearest(const Vec3& q, int near) const
{
    Query query{*this, q, {near, distance2ToFace(q, near)}};
    search(query);
    return query.best;
}

double NearestTree::onePoint() const { return kOnePoint * std::max(1.0, extent_); }

double NearestTree::distance(double distance2) const
{
    const double distance = std::sqrt(distance2);
    return distance > kRoundingDistance * std::max(1.0, extent_) ? distance : 0.0;
}

double NearestTree::distance2ToFace(const Vec3& q, int face) const
{
    const Triangle& t = faces_[face];
    return squaredDistanceToTriangle(q, positions_[t[0]], positions_[t[1]], positions_[t[2]]);
}

double NearestTree::distance2ToBox(const Vec3& q, int face) const
{
    const Triangle& t = faces_[face];
    const Vec3 &a = positions_[t[0]], &b = positions_[t[1]], &c = positions_[t[2]];
    const Vec3 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    return (low - q).cwiseMax(q - high).cwiseMax(0.0).squaredNorm();
}

Vec3 NearestTree::nearestOnFace(const Vec3& q, int face) const
{
    const Triangle& t = faces_[face];
    return nearestOnTriangle(q, positions_[t[0]], positions_[t[1]], positions_[t[2]]);
}

Vec3 NearestTree::pointOfFace(int face, const Vec3& weights) const
{
    const Triangle& t = faces_[face];
    return weights[0] * positions_[t[0]] + weights[1] * positions_[t[1]] + weights[2] * positions_[t[2]];
}

void NearestTree::makeNormals()
{
    normals_.reserve(faces_.size());
    for (const Triangle& t : faces_) {
        const Vec3 ab = positions_[t[1]] - positions_[t[0]], ac = positions_[t[2]] - positions_[t[0]];
        const Vec3 n = ab.cross(ac);
        normals_.push_back(hasNormal(n, ab, ac) ? Vec3(n.normalized()) : Vec3(Vec3::Zero()));
    }
}

/// The angle that a face takes up around a point p of it: all of it within, half of it on an edge.
double NearestTree::angleAt(const Vec3& p, int face) const
{
    const double near2 = onePoint() * onePoint();
    const Triangle& t = faces_[face];
    const Vec3* corners[] = {&positions_[t[0]], &positions_[t[1]], &positions_[t[2]]};
    for (int k = 0; k < 3; ++k) {
        if ((*corners[k] - p).squaredNorm() > near2) continue;
        const Vec3 forth = *corners[(k + 1) % 3] - *corners[k], back = *corners[(k + 2) % 3] - *corners[k];
        return std::atan2(forth.cross(back).norm(), forth.dot(back));
    }
    for (int k = 0; k < 3; ++k)
        if (squaredDistanceToSegment(p, *corners[k], *corners[(k + 1) % 3]) <= near2) return std::numbers::pi;
    return 2 * std::numbers::pi;
}

Vec3 NearestTree::nearestNormal(const Vec3& q, Found& found) const
{
    thread_local std::vector<Found> ties;
    ties.assign({{found.face, distance2ToFace(q, found.face)}});
    Query query{*this, q, ties.front(), &ties};
    search(query);
    found = query.best;
    const double limit2 = query.tieDistance2;
    std::erase_if(ties, [limit2](const Found& tie) { return tie.distance2 > limit2; });
    const auto inOrder = [](const Found& x, const Found& y) { return x.face < y.face; };
    const auto same = [](const Found& x, const Found& y) { return x.face == y.face; };
    std::sort(ties.begin(), ties.end(), inOrder);
    ties.erase(std::unique(ties.begin(), ties.end(), same), ties.end()); // `near` is visited once more
    if (ties.size() == 1) return normals_[found.face];

    const Vec3 p = pointOfFace(found.face, nearestOnFace(q, found.face));
    Vec3 sum = Vec3::Zero();
    double weights = 0;
    for (const Found& tie : ties) {
        const Vec3 ofTie = pointOfFace(tie.face, nearestOnFace(q, tie.face));
        if ((ofTie - p).squaredNorm() > onePoint() * onePoint()) continue; // as near, but elsewhere
        if (normals_[tie.face].isZero(0)) continue;
        const double angle = angleAt(p, tie.face);
        sum += angle * normals_[tie.face];
        weights += angle;
    }
    return sum.norm() > kNoNormal * weights ? Vec3(sum.normalized()) : Vec3(Vec3::Zero());
}

} // namespace gimg

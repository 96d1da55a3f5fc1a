#include "gimg/intrinsic.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gimg {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// Kahan's form of Heron's formula. Where rounding has broken the triangle inequality, the triangle is as thin
// as a double can tell.
double triangleArea(double a, double b, double c)
{
    if (a < b) std::swap(a, b);
    if (b < c) std::swap(b, c);
    if (a < b) std::swap(a, b);
    const double slack = std::max(c - (a - b), kEpsilon * a);
    return 0.25 * std::sqrt((a + (b + c)) * slack * (c + (a - b)) * (a + (b - c)));
}

// Where the apex of a triangle over the base from 0 to `base` lies; `left` and `right` are its other sides.
Vec2 apex(double base, double left, double right)
{
    return {0.5 * (base + (left - right) * (left + right) / base),
            2 * triangleArea(base, left, right) / base};
}

} // namespace

Result<IntrinsicTriangulation> IntrinsicTriangulation::of(const Mesh& mesh)
{
    return of(polyhedralSurface(mesh));
}

Result<IntrinsicTriangulation> IntrinsicTriangulation::of(const PolyhedralSurface& surface)
{
    IntrinsicTriangulation triangulation(surface);
    constexpr double kSmallest = 1e-70, kLargest = 1e70; // products of four stay in range
    double longest = 0;
    for (double length : triangulation.length_) {
        if (!(length <= kLargest)) return Error{ErrorKind::NotFinite, "an edge is longer than 1e70"};
        longest = std::max(longest, length);
    }
    if (longest < kSmallest) return Error{ErrorKind::EmptyMesh, "no edge has a length above 1e-70"};
    triangulation.lengthen();
    return triangulation;
}

IntrinsicTriangulation::IntrinsicTriangulation(const PolyhedralSurface& surface)
    : vertexCount_(surface.vertexCount), length_(surface.lengths)
{
    const Halfedges he(surface.faces, surface.vertexCount);
    for (int h = 0; h < he.count(); ++h) {
        tail_.push_back(he.tail(h));
        next_.push_back(Halfedges::next(h));
        twin_.push_back(he.twin(h));
        face_.push_back(Halfedges::face(h));
    }
}

void IntrinsicTriangulation::lengthen()
{
    constexpr double kLeastSlack = 1e-6; // of the mean length
    double sum = 0;
    for (double length : length_) sum += length;
    const double least = kLeastSlack * sum / halfedgeCount();
    for (int h = 0; h < halfedgeCount(); ++h)
        addedLength_ = std::max(addedLength_, least - (length_[next(h)] + length_[prev(h)] - length_[h]));
    for (double& length : length_) length += addedLength_;
}

double IntrinsicTriangulation::area(int h) const
{
    return triangleArea(length_[h], length_[next(h)], length_[prev(h)]);
}

double IntrinsicTriangulation::cotangent(int h) const
{
    const double a = length_[h], b = length_[next(h)], c = length_[prev(h)];
    return (b * b + (c - a) * (c + a)) / (4 * area(h));
}

double IntrinsicTriangulation::angle(int h) const
{
    const double a = length_[next(h)], b = length_[prev(h)], c = length_[h];
    return std::atan2(4 * area(h), b * b + (c - a) * (c + a));
}

double IntrinsicTriangulation::weightSum(int h, double& rounding) const
{
    double sum = 0;
    rounding = 0;
    for (int side : {h, twin_[h]}) {
        if (side < 0) continue;
        sum += cotangent(side);
        double squares = 0;
        for (int k : {side, next(side), prev(side)}) squares += length_[k] * length_[k];
        rounding += 4 * kEpsilon * squares / area(side);
    }
    return sum;
}

double IntrinsicTriangulation::weight(int h) const
{
    double rounding = 0;
    const double sum = weightSum(h, rounding);
    return sum < 0 && sum >= -rounding ? 0 : 0.5 * sum;
}

int IntrinsicTriangulation::negativeEdges() const
{
    int count = 0;
    for (int h = 0; h < halfedgeCount(); ++h) count += h < twin_[h] && isNegative(h);
    return count;
}

DelaunayReport IntrinsicTriangulation::makeDelaunay()
{
    constexpr size_t kMostFlips = 200; // an edge; a few tenths are usual
    DelaunayReport report;
    report.negativeBefore = negativeEdges();
    const size_t before = flips_, most = before + kMostFlips * length_.size();
    std::vector<int> waiting;
    std::vector<bool> isWaiting(length_.size(), false);
    const auto wait = [&](int h) {
        if (onBoundary(h)) return;
        const int edge = std::min(h, twin_[h]);
        if (!isWaiting[edge]) waiting.push_back(edge);
        isWaiting[edge] = true;
    };
    for (int h = halfedgeCount() - 1; h >= 0; --h) wait(h);
    while (!waiting.empty() && flips_ < most) {
        const int h = waiting.back();
        waiting.pop_back();
        isWaiting[h] = false;
        // (The angles opposite to an edge inside one face are angles of one triangle: it is Delaunay.)
        if (face_[h] == face_[twin_[h]] || !isNegative(h)) continue;
        flip(h);
        for (int side : {h, twin_[h]}) wait(next(side)), wait(prev(side));
    }
    report.flips = static_cast<int>(flips_ - before);
    report.negativeAfter = negativeEdges();
    return report;
}

double IntrinsicTriangulation::otherDiagonal(int h) const
{
    const int t = twin_[h];
    const Vec2 c = apex(length_[h], length_[prev(h)], length_[next(h)]);
    const Vec2 d = apex(length_[h], length_[next(t)], length_[prev(t)]);
    return std::hypot(c.x() - d.x(), c.y() + d.y());
}

// The triangles a b c and b a d with h = ab become d c a and c d b with h = dc.
void IntrinsicTriangulation::flip(int h)
{
    const int t = twin_[h], bc = next(h), ca = prev(h), ad = next(t), db = prev(t);
    length_[h] = length_[t] = otherDiagonal(h);
    tail_[h] = tail_[db];
    tail_[t] = tail_[ca];
    next_[h] = ca, next_[ca] = ad, next_[ad] = h;
    next_[t] = db, next_[db] = bc, next_[bc] = t;
    face_[ad] = face_[h];
    face_[bc] = face_[t];
    steps_.push_back({h, t, db, bc, -1});
    ++flips_;
}

// The triangle u v w of h = uv becomes u m w and m v w. Returns the first of three new halfedges mw, mv, wm.
int IntrinsicTriangulation::halve(int h, int middle)
{
    const int vw = next(h), wu = prev(h), added = halfedgeCount();
    const double a = length_[h], b = length_[vw], c = length_[wu];
    const double median = 0.5 * std::sqrt(std::max(2 * b * b + (2 * c * c - a * a), (b - c) * (b - c)));
    const int newFace = faceCount();
    tail_.insert(tail_.end(), {middle, middle, tail_[wu]});
    next_.insert(next_.end(), {wu, vw, added + 1});
    twin_.insert(twin_.end(), {added + 2, -1, added});
    face_.insert(face_.end(), {face_[h], newFace, newFace});
    length_.insert(length_.end(), {median, 0.5 * a, median});
    next_[h] = added;
    next_[vw] = added + 2;
    face_[vw] = newFace;
    return added;
}

int IntrinsicTriangulation::split(int h)
{
    const int t = twin_[h];
    if (t >= 0 && face_[h] == face_[t]) return -1;
    const int middle = vertexCount_++;
    steps_.push_back({h, t, prev(h), t < 0 ? -1 : prev(t), halfedgeCount()});
    const int left = halve(h, middle);
    if (t >= 0) {
        const int right = halve(t, middle);
        twin_[h] = right + 1, twin_[right + 1] = h;
        twin_[t] = left + 1, twin_[left + 1] = t;
        length_[t] *= 0.5;
    }
    length_[h] *= 0.5;
    return middle;
}

std::vector<Triangle> IntrinsicTriangulation::faces() const
{
    std::vector<Triangle> triangles;
    for (int h = 0; h < halfedgeCount(); ++h)
        if (h < next(h) && h < prev(h)) triangles.push_back({tail(h), tail(next(h)), tail(prev(h))});
    return triangles;
}

Eigen::VectorXd IntrinsicTriangulation::vertexAreas() const
{
    Eigen::VectorXd areas = Eigen::VectorXd::Zero(vertexCount_);
    for (int h = 0; h < halfedgeCount(); ++h) areas[tail(h)] += area(h) / 3;
    return areas;
}

Eigen::SparseMatrix<double> IntrinsicTriangulation::cotangentLaplacian() const
{
    std::vector<Eigen::Triplet<double>> entries;
    for (int h = 0; h < halfedgeCount(); ++h) {
        if (h < twin_[h] || tail(h) == head(h)) continue; // once an edge
        const double w = weight(h);
        entries.emplace_back(tail(h), tail(h), w);
        entries.emplace_back(head(h), head(h), w);
        entries.emplace_back(tail(h), head(h), -w);
        entries.emplace_back(head(h), tail(h), -w);
    }
    Eigen::SparseMatrix<double> laplacian(vertexCount_, vertexCount_);
    laplacian.setFromTriplets(entries.begin(), entries.end());
    return laplacian;
}

std::vector<double> IntrinsicTriangulation::carried(std::vector<double> closedForm) const
{
    std::vector<double>& form = closedForm;
    form.resize(tail_.size());
    for (const Step& step : steps_) {
        const auto& [h, t, first, second, added] = step;
        if (added < 0) {
            form[h] = form[first] + form[second];
            form[t] = -form[h];
            continue;
        }
        form[h] *= 0.5;
        form[added + 1] = form[h];
        form[added] = -form[h] - form[first];
        form[added + 2] = -form[added];
        if (t < 0) continue;
        form[t] = form[added + 4] = -form[h];
        form[added + 3] = -form[t] - form[second];
        form[added + 5] = -form[added + 3];
    }
    return closedForm;
}

} // namespace gimg

#include "gimg/global_parameterization.h"
#include "gimg/intrinsic.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

namespace gimg {
namespace {

constexpr double kNudge = 1e-9;     // of the form's size around a vertex
constexpr double kResolved = 1e-13; // of the form's largest value: no less can be told from rounding

// Fractions of the golden ratio: spread over [-1, 1), and no two alike.
double scattered(int v, double start)
{
    double integer = 0;
    return 2 * std::modf(start + v * 0.6180339887498949, &integer) - 1;
}

// Adds df for a function f that is tiny at every vertex, so that no edge and no triangle of a symmetric
// surface has an image without length or area. A closed form stays closed.
void nudge(const IntrinsicTriangulation& t, ComplexOneForm& form)
{
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(t.vertexCount()), count = sum;
    for (int h = 0; h < t.halfedgeCount(); ++h) {
        sum[t.tail(h)] += std::abs(form[h]);
        count[t.tail(h)] += 1;
    }
    Eigen::VectorXcd f(t.vertexCount());
    for (int v = 0; v < t.vertexCount(); ++v)
        f[v] = kNudge * sum[v] / std::max(count[v], 1.0) *
               std::complex<double>(scattered(v, 0.25), scattered(v, 0.5) * 0.7);
    for (int h = 0; h < t.halfedgeCount(); ++h) form[h] += f[t.head(h)] - f[t.tail(h)];
}

double cross(std::complex<double> a, std::complex<double> b) { return (std::conj(a) * b).imag(); }
double dot(std::complex<double> a, std::complex<double> b) { return (std::conj(a) * b).real(); }

struct Turns
{
    std::vector<double> angle;  // per vertex: of the corners of faces that are not in `unclear`
    std::vector<double> excess; // per vertex: of all corners, less a full turn, in full turns
    std::vector<int> unclear; // one halfedge of each face that is flipped, or so small that rounding decides
};

Turns turnsOf(const IntrinsicTriangulation& t, const ComplexOneForm& form)
{
    Turns turns;
    turns.angle.assign(static_cast<size_t>(t.vertexCount()), 0.0);
    turns.excess.assign(static_cast<size_t>(t.vertexCount()), -1.0);
    const double leastHeight = kResolved * form.cwiseAbs().maxCoeff();
    std::vector<bool> seen(static_cast<size_t>(t.halfedgeCount()), false);
    for (int h = 0; h < t.halfedgeCount(); ++h) {
        if (seen[h]) continue;
        const int next = t.next(h), prev = t.prev(h);
        const double longest = std::max({std::abs(form[h]), std::abs(form[next]), std::abs(form[prev])});
        const bool clear = cross(form[h], form[next]) > leastHeight * longest;
        if (!clear) turns.unclear.push_back(h);
        for (int corner : {h, next, prev}) {
            seen[corner] = true;
            const std::complex<double> out = form[corner], in = -form[t.prev(corner)];
            const double angle = std::atan2(std::abs(cross(out, in)), dot(out, in));
            if (clear) turns.angle[t.tail(corner)] += angle;
            turns.excess[t.tail(corner)] += angle / (2 * std::numbers::pi);
        }
    }
    return turns;
}

// Vertices joined where an unclear face has them.
class Patches
{
public:
    explicit Patches(int vertices) : parent_(static_cast<size_t>(vertices))
    {
        std::iota(parent_.begin(), parent_.end(), 0);
    }
    int of(int v)
    {
        while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
        return v;
    }
    void join(int v, int w)
    {
        const int a = of(v), b = of(w);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<int> parent_;
};

/// Vertices of nonzero index together: one with a cone, or those of a patch of unclear faces.
struct Place
{
    int index = 0;
    std::vector<int> vertices;
    BranchPoint point; // what it is if the index is positive
};

BranchPoint pointAt(const Mesh& mesh, const Turns& turns, const Place& place)
{
    BranchPoint point{place.vertices[0], Vec3::Zero(), place.index};
    double sum = 0;
    for (int v : place.vertices) {
        point.position += turns.excess[v] * mesh.positions[v];
        sum += turns.excess[v];
        if (turns.excess[v] > turns.excess[point.vertex]) point.vertex = v;
    }
    point.position /= sum;
    return point;
}

std::vector<Place> placesOf(const Mesh& mesh, const IntrinsicTriangulation& t, const Turns& turns)
{
    Patches patches(mesh.vertexCount());
    for (int h : turns.unclear) {
        patches.join(t.tail(h), t.head(h));
        patches.join(t.tail(h), t.tail(t.prev(h)));
    }
    std::vector<double> index(mesh.positions.size(), 0.0);
    // Around a patch the turns of the clear faces count. Inside, it does not matter how a face lies: its
    // angles, half a turn, if it is clear, or those of a flipped one, negative, and its own index of 1.
    for (int h : turns.unclear) index[patches.of(t.tail(h))] += 0.5;
    std::vector<bool> used(mesh.positions.size(), false);
    for (const Triangle& f : mesh.faces)
        for (int v : f) used[v] = true;
    for (int v = 0; v < mesh.vertexCount(); ++v)
        if (used[v]) index[patches.of(v)] += turns.angle[v] / (2 * std::numbers::pi) - 1;

    std::vector<Place> places;
    std::vector<int> placeOf(mesh.positions.size(), -1);
    for (int v = 0; v < mesh.vertexCount(); ++v) {
        const int root = patches.of(v);
        const int whole = static_cast<int>(std::lround(index[root]));
        if (whole == 0) continue;
        if (placeOf[root] < 0) {
            placeOf[root] = static_cast<int>(places.size());
            places.push_back({whole, {}, {}});
        }
        places[placeOf[root]].vertices.push_back(v);
    }
    for (Place& place : places)
        if (place.index > 0) place.point = pointAt(mesh, turns, place);
    return places;
}

Result<std::vector<Place>> findPlaces(const Mesh& mesh, const ComplexOneForm& form)
{
    if (form.size() != 3 * static_cast<Eigen::Index>(mesh.faceCount()))
        return Error{ErrorKind::BadArgument, std::to_string(form.size()) + " numbers of a 1-form for " +
                                                 std::to_string(mesh.faceCount()) + " faces"};
    Result<IntrinsicTriangulation> delaunay = IntrinsicTriangulation::of(mesh);
    if (!delaunay) return delaunay.error();
    delaunay->makeDelaunay();
    const auto carried = [&](const Eigen::VectorXd& part) {
        return delaunay->carried(std::vector<double>(part.data(), part.data() + part.size()));
    };
    const std::vector<double> re = carried(form.real()), im = carried(form.imag());
    ComplexOneForm here(form.size());
    for (size_t h = 0; h < re.size(); ++h) here[static_cast<Eigen::Index>(h)] = {re[h], im[h]};
    nudge(*delaunay, here);
    return placesOf(mesh, *delaunay, turnsOf(*delaunay, here));
}

void add(const Place& place, BranchPoints& found)
{
    found.total += place.index;
    if (place.index > 0)
        found.points.push_back(place.point);
    else
        ++found.negative;
}

} // namespace

Result<BranchPoints> branchPoints(const Mesh& mesh, const ComplexOneForm& form)
{
    const Result<std::vector<Place>> places = findPlaces(mesh, form);
    if (!places) return places.error();
    BranchPoints found;
    for (const Place& place : *places) add(place, found);
    return found;
}

Result<BoundedBranchPoints> branchPoints(const DoubleCover& cover, const ComplexOneForm& formOnCover)
{
    const Result<std::vector<Place>> places = findPlaces(cover.mesh, formOnCover);
    if (!places) return places.error();
    BoundedBranchPoints found;
    for (const Place& place : *places) {
        found.total += place.index;
        bool first = false, second = false; // copies that it has vertices of; both where it meets the seam
        for (int v : place.vertices) {
            first |= cover.mirror[v] >= v;
            second |= cover.mirror[v] <= v;
        }
        if (first && second)
            add(place, found.onBoundary);
        else if (first)
            add(place, found.inside);
    }
    return found;
}

} // namespace gimg

#include "gimg/handle_separation.h"

#include "conformal/handle_tori.h"
#include "conformal/min_cut.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace gimg {
namespace {

constexpr double kCapacityUnits = 1099511627776.0; // 2^40 for the sum of all lengths
constexpr int kNone = -1;
constexpr double kRounding = 1e-12; // by which a corner may lie outside of [0,1)^2

std::vector<CapacityEdge> dualEdges(const Halfedges& he, const ComplexOneForm& form)
{
    double sum = 0;
    for (int h = 0; h < he.count(); ++h) sum += std::abs(form[h]);
    const double unit = sum > 0 ? kCapacityUnits / sum : 0;
    std::vector<CapacityEdge> edges;
    for (int h = 0; h < he.count(); ++h)
        if (h < he.twin(h)) edges.push_back({h / 3, he.twin(h) / 3, std::llround(unit * std::abs(form[h]))});
    return edges;
}

/// The least region around each torus that a shortest curve keeps apart from all other tori; such regions do
/// not overlap.
struct Regions
{
    std::vector<int> handleOf; // per face, kNone between the regions
    std::vector<int64_t> capacity;
};

Regions isolated(const Halfedges& he, const std::vector<HandleTorus>& tori, const ComplexOneForm& form)
{
    const int faceCount = he.count() / 3, handles = static_cast<int>(tori.size());
    std::vector<int> torusOf(static_cast<size_t>(faceCount), kNone);
    for (int i = 0; i < handles; ++i)
        for (int f : tori[i].faces) torusOf[f] = i;
    const std::vector<CapacityEdge> edges = dualEdges(he, form);
    Regions regions{torusOf, {}};
    for (int i = 0; i < handles && handles > 1; ++i) {
        // A torus is one node: this one the source, all others together the sink.
        const int source = faceCount, sink = faceCount + 1;
        const auto node = [&](int f) { return torusOf[f] == kNone ? f : torusOf[f] == i ? source : sink; };
        std::vector<CapacityEdge> joined;
        for (const CapacityEdge& e : edges)
            if (node(e.a) != node(e.b)) joined.push_back({node(e.a), node(e.b), e.capacity});
        const MinimumCut cut = minimumCut(faceCount + 2, joined, source, sink);
        regions.capacity.push_back(cut.capacity);
        for (int f = 0; f < faceCount; ++f)
            if (torusOf[f] == kNone && cut.inside[f]) regions.handleOf[f] = i;
    }
    return regions;
}

// What lies between the regions, piece by piece, goes to the neighbour with the most border, in the form's
// length: so the least border remains.
void shareRest(const Halfedges& he, const ComplexOneForm& form, int handles, std::vector<int>& handleOf)
{
    for (int start = 0; start < static_cast<int>(handleOf.size()); ++start) {
        if (handleOf[start] != kNone) continue;
        std::vector<int> piece = {start};
        std::vector<double> border(static_cast<size_t>(handles), 0.0);
        handleOf[start] = handles; // seen
        for (size_t i = 0; i < piece.size(); ++i)
            for (int h = 3 * piece[i]; h < 3 * piece[i] + 3; ++h) {
                const int next = he.twin(h) / 3;
                if (handleOf[next] == kNone) {
                    handleOf[next] = handles;
                    piece.push_back(next);
                } else if (handleOf[next] < handles)
                    border[handleOf[next]] += std::abs(form[h]);
            }
        const auto most = std::max_element(border.begin(), border.end());
        for (int f : piece) handleOf[f] = static_cast<int>(most - border.begin());
    }
}

// The border of a region as loops with the region to their left.
std::vector<Loop> borderOf(const Halfedges& he, const std::vector<int>& handleOf, int handle)
{
    const auto isBorder = [&](int h) {
        return handleOf[h / 3] == handle && handleOf[he.twin(h) / 3] != handle;
    };
    std::vector<Loop> loops;
    std::vector<bool> seen(static_cast<size_t>(he.count()), false);
    for (int start = 0; start < he.count(); ++start) {
        if (!isBorder(start) || seen[start]) continue;
        Loop loop;
        for (int h = start; !seen[h];) {
            seen[h] = true;
            loop.halfedges.push_back(h);
            h = Halfedges::next(h);
            while (!isBorder(h)) h = Halfedges::next(he.twin(h));
        }
        loops.push_back(std::move(loop));
    }
    return loops;
}

double areaInPlane(const ComplexOneForm& form, const std::vector<int>& handleOf, int handle)
{
    double area = 0;
    for (size_t f = 0; f < handleOf.size(); ++f) {
        const Eigen::Index h = 3 * static_cast<Eigen::Index>(f);
        if (handleOf[f] == handle) area += (std::conj(form[h]) * form[h + 1]).imag() / 2;
    }
    return area;
}

Status checked(const Mesh& mesh, const ComplexOneForm& form)
{
    if (form.size() != 3 * static_cast<Eigen::Index>(mesh.faceCount()))
        return Error{ErrorKind::BadArgument, std::to_string(form.size()) + " numbers of a 1-form for " +
                                                 std::to_string(mesh.faceCount()) + " faces"};
    return Done{};
}

} // namespace

Result<HandleSeparation> separateHandles(const Mesh& mesh, const ComplexOneForm& form)
{
    if (const Status status = checked(mesh, form); !status) return status.error();
    const Topology type = topology(mesh);
    if (type.boundaries > 0)
        return Error{ErrorKind::NotClosed, "only a closed surface is separated into handles"};
    if (type.genus == 0) return Error{ErrorKind::WrongGenus, "a surface of genus 0 has no handles"};

    const Halfedges he(mesh.faces, mesh.vertexCount());
    const Result<std::vector<HandleTorus>> tori = handleTori(mesh, he, form, type.genus);
    if (!tori) return tori.error();
    HandleSeparation separation;
    separation.handleOf = isolated(he, *tori, form).handleOf;
    if (type.genus == 1) std::fill(separation.handleOf.begin(), separation.handleOf.end(), 0);
    shareRest(he, form, type.genus, separation.handleOf);
    for (int i = 0; i < type.genus; ++i) {
        const HandleTorus& torus = (*tori)[i];
        Handle handle{torus.a,
                      torus.b,
                      integrate(form, torus.a.halfedges),
                      integrate(form, torus.b.halfedges),
                      borderOf(he, separation.handleOf, i),
                      areaInPlane(form, separation.handleOf, i)};
        separation.handles.push_back(std::move(handle));
    }
    return separation;
}

Result<CornerMap> modularCoordinates(const Mesh& mesh, const ComplexOneForm& form,
                                     const HandleSeparation& separation)
{
    if (const Status status = checked(mesh, form); !status) return status.error();
    std::vector<Eigen::Matrix2d> toUnits;
    for (const Handle& handle : separation.handles) {
        Eigen::Matrix2d sides;
        sides << handle.periodA.real(), handle.periodB.real(), handle.periodA.imag(), handle.periodB.imag();
        if (!(std::abs(sides.determinant()) > 1e-12 * sides.squaredNorm()))
            return Error{ErrorKind::BadArgument, "the periods of a handle are parallel"};
        toUnits.push_back(sides.inverse());
    }
    const Halfedges he(mesh.faces, mesh.vertexCount());
    CornerMap map;
    map.uv.assign(static_cast<size_t>(he.count()), Vec2::Zero());
    for (int f = 0; f < mesh.faceCount(); ++f) map.corners.push_back({3 * f, 3 * f + 1, 3 * f + 2});

    std::vector<bool> seen(mesh.faces.size(), false);
    std::vector<int> faces;
    // From its first corner, whose place is known, the others of a face.
    const auto place = [&](int corner) {
        const Eigen::Matrix2d& units = toUnits[separation.handleOf[corner / 3]];
        const auto along = [&](int h) -> Vec2 { return units * Vec2(form[h].real(), form[h].imag()); };
        const int second = Halfedges::next(corner), third = Halfedges::prev(corner);
        map.uv[second] = map.uv[corner] + along(corner);
        map.uv[third] = map.uv[second] + along(second);
        seen[corner / 3] = true;
        faces.push_back(corner / 3);
    };
    for (int start = 0; start < mesh.faceCount(); ++start) {
        if (seen[start]) continue;
        faces.clear();
        place(3 * start);
        for (size_t i = 0; i < faces.size(); ++i)
            for (int h = 3 * faces[i]; h < 3 * faces[i] + 3; ++h) {
                const int twin = he.twin(h);
                if (seen[twin / 3] || separation.handleOf[twin / 3] != separation.handleOf[faces[i]])
                    continue;
                map.uv[twin] = map.uv[Halfedges::next(h)];
                place(twin);
            }
    }
    for (size_t f = 0; f < mesh.faces.size(); ++f) {
        const Vec2 whole = (map.uv[3 * f].array() + kRounding).floor();
        for (size_t k = 0; k < 3; ++k) map.uv[3 * f + k] -= whole;
    }
    return map;
}

} // namespace gimg

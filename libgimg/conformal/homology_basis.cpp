#include "conformal/homology_basis.h"

#include "conformal/loop_finder.h"

namespace gimg {

double loopLength(const PolyhedralSurface& surface, const Loop& loop)
{
    double sum = 0;
    for (int h : loop.halfedges) sum += surface.lengths[h];
    return sum;
}

Result<std::vector<Loop>> homologyBasis(const PolyhedralSurface& surface)
{
    const Result<ClosedSurface> closed = closedSurface(surface, 0);
    if (!closed) return closed.error();
    return LoopFinder(*closed).basis();
}

Result<std::vector<Loop>> homologyBasis(const Mesh& mesh)
{
    const Result<PolyhedralSurface> surface = checkedSurface(mesh);
    if (!surface) return surface.error();
    return homologyBasis(*surface);
}

Result<CanonicalBasis> canonicalBasis(const ClosedSurface& surface)
{
    LoopFinder finder(surface);
    const std::vector<Loop> loops = finder.basis();
    const Result<Eigen::MatrixXi> congruence =
        symplecticCongruence(intersectionMatrix(surface.halfedges, loops));
    if (!congruence) return congruence.error();
    CanonicalBasis basis;
    const int g = surface.topology.genus;
    for (int i = 0; i < g; ++i) {
        basis.a.push_back(finder.joined(loops, congruence->col(i)));
        basis.b.push_back(finder.joined(loops, congruence->col(g + i)));
    }
    return basis;
}

Result<CanonicalBasis> canonicalBasis(const PolyhedralSurface& surface)
{
    const Result<ClosedSurface> closed = closedSurface(surface, 1);
    if (!closed) return closed.error();
    return canonicalBasis(*closed);
}

Result<CanonicalBasis> canonicalBasis(const Mesh& mesh)
{
    const Result<PolyhedralSurface> surface = checkedSurface(mesh);
    if (!surface) return surface.error();
    return canonicalBasis(*surface);
}

} // namespace gimg

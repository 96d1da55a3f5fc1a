#include "conformal/punctured_plane.h"

#include "conformal/dirichlet_solver.h"

#include <array>
#include <cmath>
#include <numbers>

namespace gimg {
namespace {

const Error kUnsolvable{ErrorKind::SolverFailure, "the linear system of the map could not be solved"};

// Less the curvature of each vertex: what the Laplacian of the logarithm of the scale is where the metric
// becomes flat.
Eigen::VectorXd flatSource(const IntrinsicTriangulation& surface)
{
    Eigen::VectorXd source = Eigen::VectorXd::Constant(surface.vertexCount(), -2 * std::numbers::pi);
    for (int h = 0; h < surface.halfedgeCount(); ++h) source[surface.tail(h)] += surface.angle(h);
    return source;
}

// By z -> z + k conj(z), which keeps harmonic functions and orientation (|k| < 1), to where the mean over the
// surface's area of the anti-conformal part over the conjugate of the conformal one is 0.
void makeConformal(const IntrinsicTriangulation& surface, std::vector<std::complex<double>>& z)
{
    constexpr int kRounds = 20;
    constexpr double kMost = 0.8, kSmall = 1e-6;
    for (int round = 0; round < kRounds; ++round) {
        std::complex<double> sum = 0;
        double area = 0;
        for (int h = 0; h < surface.halfedgeCount(); ++h) {
            if (h > surface.next(h) || h > surface.prev(h)) continue; // once a face
            // Corners of the face at 0, l and p in the plane.
            const double l = surface.length(h), q = surface.length(surface.prev(h)), angle = surface.angle(h);
            const std::complex<double> p = std::polar(q, angle),
                                       edge = z[surface.head(h)] - z[surface.tail(h)],
                                       other = z[surface.tail(surface.prev(h))] - z[surface.tail(h)];
            // edge = l (f_z + f_zbar), other = p f_z + conj(p) f_zbar.
            const std::complex<double> along = edge / l;
            const std::complex<double> antiConformal = (p * along - other) / (p - std::conj(p)),
                                       conformal = along - antiConformal;
            if (std::norm(conformal) <= std::norm(antiConformal)) continue; // flipped or flat by rounding
            const double faceArea = surface.area(h);
            area += faceArea;
            sum -= faceArea * antiConformal / std::conj(conformal);
        }
        if (!(area > 0)) return;
        std::complex<double> k = sum / area;
        if (std::abs(k) < kSmall) return;
        k *= std::min(1.0, kMost / std::abs(k));
        for (std::complex<double>& w : z) w += k * std::conj(w);
    }
}

} // namespace

Result<Eigen::VectorXd> logScales(const IntrinsicTriangulation& surface,
                                  const Eigen::SparseMatrix<double>& laplacian)
{
    const Eigen::VectorXd area = surface.vertexAreas();
    Eigen::MatrixXd source = area * (4 * std::numbers::pi / area.sum());
    for (int v = 0; v < surface.vertexCount(); ++v) source(v, 0) -= 2 * std::numbers::pi;
    for (int h = 0; h < surface.halfedgeCount(); ++h) source(surface.tail(h), 0) += surface.angle(h);
    std::vector<bool> fixed(static_cast<size_t>(surface.vertexCount()), false);
    fixed[0] = true;
    const DirichletSolver solver(laplacian, fixed);
    if (!solver.isSolvable()) return kUnsolvable;
    Eigen::MatrixXd u = Eigen::MatrixXd::Zero(surface.vertexCount(), 1);
    solver.solve(u, source);
    if (!u.allFinite()) return kUnsolvable;
    u.array() -= u.col(0).dot(area) / area.sum();
    return Eigen::VectorXd(u.col(0));
}

// Whatever shape the outer triangle has, the others differ by affine maps of the plane.
Result<PuncturedPlane> mapPunctured(const IntrinsicTriangulation& surface,
                                    const Eigen::SparseMatrix<double>& laplacian, int outside)
{
    const int count = surface.vertexCount();
    std::vector<bool> fixed(static_cast<size_t>(count), false);
    Eigen::MatrixXd values = Eigen::MatrixXd::Zero(count, 3), source = values; // x, y, scale
    source.col(2) = flatSource(surface);
    int h = outside;
    for (int k = 0; k < 3; ++k, h = surface.next(h)) {
        // Clockwise, since the surface lies inside and the triangle outside.
        const double turn = -2 * std::numbers::pi * k / 3;
        values.row(surface.tail(h)) << std::cos(turn), std::sin(turn), 0;
        fixed[surface.tail(h)] = true;
    }
    const DirichletSolver solver(laplacian, fixed);
    if (!solver.isSolvable()) return kUnsolvable;
    solver.solve(values, source);
    if (!values.allFinite()) return kUnsolvable;
    PuncturedPlane out;
    out.outside = outside;
    out.logScale = values.col(2);
    for (int v = 0; v < count; ++v) out.z.emplace_back(values(v, 0), values(v, 1));
    makeConformal(surface, out.z);
    return out;
}

Result<int> triangleForOutside(const IntrinsicTriangulation& surface,
                               const Eigen::SparseMatrix<double>& laplacian)
{
    const Eigen::VectorXd area = surface.vertexAreas();
    const Eigen::MatrixXd source = flatSource(surface) + area * (4 * std::numbers::pi / area.sum());
    Eigen::MatrixXd logScale = Eigen::MatrixXd::Zero(surface.vertexCount(), 1);
    std::vector<bool> fixed(static_cast<size_t>(surface.vertexCount()), false);
    fixed[0] = true;
    const DirichletSolver solver(laplacian, fixed);
    if (!solver.isSolvable()) return kUnsolvable;
    solver.solve(logScale, source);
    int best = -1;
    double most = 0;
    for (int h = 0; h < surface.halfedgeCount(); ++h) {
        const int a = surface.tail(h), b = surface.head(h), c = surface.tail(surface.prev(h));
        if (a == b || b == c || c == a) continue;
        const double scale = logScale(a, 0) + logScale(b, 0) + logScale(c, 0);
        if (best < 0 || scale > most) best = h, most = scale;
    }
    if (best < 0) return kUnsolvable;
    return best;
}

} // namespace gimg

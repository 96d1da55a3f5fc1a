#include "gimg/holomorphic.h"

#include "conformal/homology_basis.h"
#include "gimg/harmonic.h"

#include <Eigen/Dense>

namespace gimg {
namespace {

// W of Algorithm 8 for a canonical basis, by Riemann's bilinear relation: the integrals of harmonic_i ^
// harmonic_j.
Eigen::MatrixXd wedgeMatrix(Eigen::Index g)
{
    Eigen::MatrixXd w = Eigen::MatrixXd::Zero(2 * g, 2 * g);
    w.topRightCorner(g, g).setIdentity();
    w.bottomLeftCorner(g, g) = -Eigen::MatrixXd::Identity(g, g);
    return w;
}

// Algorithm 8 as it stands: W R = D, then the periods of w_j + i *w_j for the forms dual to a_1 .. a_g.
Eigen::MatrixXcd periodsAsMeasured(const Eigen::MatrixXd& star)
{
    const Eigen::Index g = star.rows() / 2;
    const std::complex<double> i(0, 1);
    const Eigen::MatrixXcd overA = Eigen::MatrixXcd::Identity(g, g) + i * star.topLeftCorner(g, g);
    const Eigen::MatrixXcd overB = i * star.bottomLeftCorner(g, g);
    return overA.transpose().fullPivLu().solve(overB.transpose()).transpose();
}

/// The star whose square is -1, and how far that of the energies as measured is from it.
struct Star
{
    Eigen::MatrixXd star;
    Eigen::MatrixXd energy; ///< W star
    double residual;
};

// R = W^-1 D is similar to the antisymmetric K = sqrt(D) W^-1 sqrt(D), of which the orthogonal polar factor is
// taken. In the norm of D, R^2 + 1 is as long as K^2 + 1.
Star nearestStar(const Eigen::MatrixXd& energy)
{
    const Eigen::Index n = energy.rows();
    const Eigen::MatrixXd w = wedgeMatrix(n / 2);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> byEnergy(energy);
    const Eigen::MatrixXd root = byEnergy.operatorSqrt();
    const Eigen::MatrixXd k = root * w.transpose() * root; // w^-1 is its transpose
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> bySquare(k.transpose() * k);
    Star result;
    result.energy = root * bySquare.operatorInverseSqrt() * root;
    result.energy = (0.5 * (result.energy + result.energy.transpose())).eval();
    result.star = w.transpose() * result.energy;
    result.residual = (bySquare.eigenvalues().array() - 1).abs().maxCoeff();
    return result;
}

// w_j + sum over k of P(k, j) w_{g+k} is holomorphic: * takes it to -i times itself.
Eigen::MatrixXcd periodsOf(const Eigen::MatrixXd& energy)
{
    const Eigen::Index g = energy.rows() / 2;
    const Eigen::MatrixXd imaginary = energy.bottomRightCorner(g, g).inverse();
    const Eigen::MatrixXd real = -imaginary * energy.bottomLeftCorner(g, g);
    Eigen::MatrixXcd periods(g, g);
    periods.real() = 0.5 * (real + real.transpose());
    periods.imag() = 0.5 * (imaginary + imaginary.transpose());
    return periods;
}

std::vector<ComplexOneForm> holomorphicForms(const std::vector<OneForm>& harmonic, const Eigen::MatrixXcd& periods)
{
    const Eigen::Index g = periods.rows();
    std::vector<ComplexOneForm> forms;
    for (Eigen::Index j = 0; j < g; ++j) {
        ComplexOneForm form = harmonic[j].cast<std::complex<double>>();
        for (Eigen::Index k = 0; k < g; ++k) form += periods(k, j) * harmonic[g + k];
        forms.push_back(std::move(form));
    }
    return forms;
}

Result<ConformalStructure> structureIn(const PolyhedralSurface& surface, const Halfedges& halfedges,
                                       const CanonicalBasis& loops, const Progress& progress)
{
    const auto report = [&](double done) {
        if (progress) progress(done);
    };
    report(0.3);
    const Result<HarmonicSolver> solver = HarmonicSolver::of(surface);
    if (!solver) return solver.error();
    report(0.6);
    Result<std::vector<OneForm>> harmonic = solver->harmonic(dualBasis(halfedges, loops));
    if (!harmonic) return harmonic.error();
    report(0.9);

    ConformalStructure structure;
    structure.genus = static_cast<int>(loops.a.size());
    structure.loops = loops;
    structure.harmonic = std::move(*harmonic);
    structure.energy = solver->energies(structure.harmonic);
    const Star star = nearestStar(structure.energy);
    const Eigen::MatrixXcd measured =
        periodsAsMeasured(wedgeMatrix(structure.genus).transpose() * structure.energy);
    structure.star = star.star;
    structure.starResidual = star.residual;
    structure.asymmetry = (measured - measured.transpose()).norm() / measured.norm();
    structure.periodMatrix = periodsOf(star.energy);
    structure.holomorphic = holomorphicForms(structure.harmonic, structure.periodMatrix);
    report(1);
    return structure;
}

bool isWalk(const Halfedges& he, const Loop& loop)
{
    for (size_t i = 0; i < loop.halfedges.size(); ++i) {
        const int h = loop.halfedges[i], next = loop.halfedges[(i + 1) % loop.halfedges.size()];
        if (h < 0 || h >= he.count() || next < 0 || next >= he.count() || he.head(h) != he.tail(next)) return false;
    }
    return true;
}

bool isCanonical(const ClosedSurface& surface, const CanonicalBasis& loops)
{
    const size_t g = static_cast<size_t>(surface.topology.genus);
    if (loops.a.size() != g || loops.b.size() != g) return false;
    std::vector<Loop> all = loops.a;
    all.insert(all.end(), loops.b.begin(), loops.b.end());
    for (const Loop& loop : all)
        if (!isWalk(surface.halfedges, loop)) return false;
    return intersectionMatrix(surface.halfedges, all).cast<double>() ==
           wedgeMatrix(static_cast<Eigen::Index>(g));
}

} // namespace

Result<ConformalStructure> conformalStructure(const PolyhedralSurface& surface, const Progress& progress)
{
    const Result<ClosedSurface> closed = closedSurface(surface, 1);
    if (!closed) return closed.error();
    const Result<CanonicalBasis> loops = canonicalBasis(*closed);
    if (!loops) return loops.error();
    return structureIn(surface, closed->halfedges, *loops, progress);
}

Result<ConformalStructure> conformalStructure(const Mesh& mesh, const Progress& progress)
{
    const Result<PolyhedralSurface> surface = checkedSurface(mesh);
    if (!surface) return surface.error();
    return conformalStructure(*surface, progress);
}

Result<ConformalStructure> conformalStructure(const PolyhedralSurface& surface, const CanonicalBasis& loops,
                                              const Progress& progress)
{
    const Result<ClosedSurface> closed = closedSurface(surface, 1);
    if (!closed) return closed.error();
    if (!isCanonical(*closed, loops))
        return Error{ErrorKind::BadArgument, "the loops are not a canonical basis of the surface"};
    return structureIn(surface, closed->halfedges, loops, progress);
}

} // namespace gimg

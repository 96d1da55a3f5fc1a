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
    Eigen::MatrixXd energy;    ///< W star
    Eigen::VectorXd residuals; ///< of 2g forms, one for each pair of equals: ascending
    Eigen::MatrixXd modes;     ///< the forms: coefficients of the basis, a column each; of energy 1
};

// R = W^-1 D is similar to the antisymmetric K = sqrt(D) W^-1 sqrt(D), of which the orthogonal polar factor
// is taken. In the norm of D, R^2 + 1 is as long as K^2 + 1.
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
    result.residuals = (bySquare.eigenvalues().array() - 1).abs();
    result.modes = byEnergy.operatorInverseSqrt() * bySquare.eigenvectors();
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

std::vector<ComplexOneForm> holomorphicForms(const std::vector<OneForm>& harmonic,
                                             const Eigen::MatrixXcd& periods)
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

OneForm combined(const std::vector<OneForm>& forms, const Eigen::VectorXd& coefficients)
{
    OneForm sum = OneForm::Zero(forms[0].size());
    for (size_t i = 0; i < forms.size(); ++i) sum += coefficients[static_cast<Eigen::Index>(i)] * forms[i];
    return sum;
}

// Into how many pieces each triangle is to be split so that every mode's residual comes down to `target`. The
// residual of a mode is a sum over triangles, and a triangle's part of it falls about as its number of pieces
// grows: by Lagrange's rule they are fewest in proportion to the roots of the parts.
Eigen::VectorXd piecesWanted(const HarmonicSolver& solver, const HarmonicForms& harmonic, const Star& star,
                             double target)
{
    Eigen::VectorXd pieces = Eigen::VectorXd::Ones(solver.triangulation().faceCount());
    for (Eigen::Index j = star.residuals.size() - 1; j >= 0; j -= 2) {
        if (star.residuals[j] <= target) break;
        const OneForm mode = combined(harmonic.onTriangulation, star.modes.col(j));
        const OneForm conjugate = combined(harmonic.onTriangulation, star.star * star.modes.col(j));
        const Eigen::VectorXd roots = solver.conjugateErrors(mode, conjugate).cwiseSqrt();
        pieces = pieces.cwiseMax(roots * (roots.sum() / (0.7 * target)));
    }
    return pieces;
}

class StructureBuilder
{
public:
    StructureBuilder(const PolyhedralSurface& surface, const Halfedges& halfedges,
                     const CanonicalBasis& loops, const ConformalOptions& options)
        : surface_(surface), loops_(loops), options_(options), dual_(dualBasis(halfedges, loops))
    {
    }

    Result<ConformalStructure> build()
    {
        constexpr int kMostRounds = 20;
        report(0.2);
        Result<HarmonicSolver> solver = HarmonicSolver::of(surface_);
        if (!solver) return solver.error();
        report(0.4);
        for (int round = 0;; ++round) {
            Result<HarmonicForms> harmonic = solver->harmonic(dual_);
            if (!harmonic) return harmonic.error();
            const Eigen::MatrixXd energy = solver->energies(harmonic->onTriangulation);
            const Star star = nearestStar(energy);
            report(1 - 0.6 / (round + 2));
            const int triangles = solver->triangulation().faceCount();
            const bool isNear = star.residuals.maxCoeff() <= options_.starResidual;
            if (!isNear && round < kMostRounds) {
                // (A step at a time: what is worst now hides how good the others are.)
                const double target = std::max(options_.starResidual, 0.25 * star.residuals.maxCoeff());
                const Eigen::VectorXd pieces = piecesWanted(*solver, *harmonic, star, target);
                if (pieces.cwiseMin(16).sum() <= options_.mostTriangles) {
                    const Status refined = solver->refine(pieces);
                    if (!refined) return refined.error();
                    continue;
                }
            }
            report(1);
            return structure(std::move(harmonic->onSurface), energy, star, triangles);
        }
    }

private:
    void report(double done) const
    {
        if (options_.progress) options_.progress(done);
    }

    ConformalStructure structure(std::vector<OneForm> harmonic, const Eigen::MatrixXd& energy,
                                 const Star& star, int triangles) const
    {
        ConformalStructure result;
        result.genus = static_cast<int>(loops_.a.size());
        result.loops = loops_;
        result.harmonic = std::move(harmonic);
        result.energy = energy;
        result.star = star.star;
        const Eigen::MatrixXcd measured = periodsAsMeasured(wedgeMatrix(result.genus).transpose() * energy);
        result.asymmetry = (measured - measured.transpose()).norm() / measured.norm();
        result.starResidual = star.residuals.maxCoeff();
        result.triangles = triangles;
        result.periodMatrix = periodsOf(star.energy);
        result.holomorphic = holomorphicForms(result.harmonic, result.periodMatrix);
        return result;
    }

    const PolyhedralSurface& surface_;
    const CanonicalBasis& loops_;
    const ConformalOptions& options_;
    std::vector<OneForm> dual_;
};

Result<ConformalStructure> structureIn(const PolyhedralSurface& surface, const Halfedges& halfedges,
                                       const CanonicalBasis& loops, const ConformalOptions& options)
{
    if (!(options.starResidual > 0))
        return Error{ErrorKind::BadArgument, "the largest residual of the star must be positive"};
    return StructureBuilder(surface, halfedges, loops, options).build();
}

bool isWalk(const Halfedges& he, const Loop& loop)
{
    for (size_t i = 0; i < loop.halfedges.size(); ++i) {
        const int h = loop.halfedges[i], next = loop.halfedges[(i + 1) % loop.halfedges.size()];
        if (h < 0 || h >= he.count() || next < 0 || next >= he.count() || he.head(h) != he.tail(next))
            return false;
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

Result<ConformalStructure> conformalStructure(const PolyhedralSurface& surface,
                                              const ConformalOptions& options)
{
    const Result<ClosedSurface> closed = closedSurface(surface, 1);
    if (!closed) return closed.error();
    const Result<CanonicalBasis> loops = canonicalBasis(*closed);
    if (!loops) return loops.error();
    return structureIn(surface, closed->halfedges, *loops, options);
}

Result<ConformalStructure> conformalStructure(const Mesh& mesh, const ConformalOptions& options)
{
    const Result<PolyhedralSurface> surface = checkedSurface(mesh);
    if (!surface) return surface.error();
    return conformalStructure(*surface, options);
}

Result<ConformalStructure> conformalStructure(const PolyhedralSurface& surface, const CanonicalBasis& loops,
                                              const ConformalOptions& options)
{
    const Result<ClosedSurface> closed = closedSurface(surface, 1);
    if (!closed) return closed.error();
    if (!isCanonical(*closed, loops))
        return Error{ErrorKind::BadArgument, "the loops are not a canonical basis of the surface"};
    return structureIn(surface, closed->halfedges, loops, options);
}

} // namespace gimg

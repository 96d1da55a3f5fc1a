#include "gimg/sphere_descent.h"

#include "conformal/dirichlet_solver.h"
#include "conformal/sphere_check.h"
#include "gimg/intrinsic.h"

#include <cmath>

namespace gimg {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;
using Points = Eigen::MatrixXd; // a row a vertex

SparseMatrix edgeLaplacian(const Mesh& mesh)
{
    std::vector<Eigen::Triplet<double>> entries;
    for (const Triangle& t : mesh.faces) // closed: every directed edge comes once
        for (int k = 0; k < 3; ++k) {
            entries.emplace_back(t[k], t[(k + 1) % 3], -1);
            entries.emplace_back(t[k], t[k], 1);
        }
    SparseMatrix laplacian(mesh.vertexCount(), mesh.vertexCount());
    laplacian.setFromTriplets(entries.begin(), entries.end());
    return laplacian;
}

Result<SparseMatrix> laplacianOf(const Mesh& mesh, SphereEnergy energy)
{
    if (energy == SphereEnergy::Barycentric) return edgeLaplacian(mesh);
    Result<IntrinsicTriangulation> surface = IntrinsicTriangulation::of(mesh);
    if (!surface) return surface.error();
    surface->makeDelaunay();
    return surface->cotangentLaplacian();
}

Points alongSphere(const Points& at, Points vectors)
{
    for (Eigen::Index v = 0; v < at.rows(); ++v) vectors.row(v) -= vectors.row(v).dot(at.row(v)) * at.row(v);
    return vectors;
}

double energyOf(const SparseMatrix& laplacian, const Points& at)
{
    return 0.5 * at.cwiseProduct(laplacian * at).sum();
}

std::vector<Vec3> listOf(const Points& points)
{
    std::vector<Vec3> list;
    for (Eigen::Index v = 0; v < points.rows(); ++v) list.push_back(points.row(v).transpose());
    return list;
}

Status centre(const std::vector<double>& mass, Points& points)
{
    const std::vector<Vec3> list = listOf(points);
    const Result<Moebius> centred = centringMass(list, mass);
    if (!centred) return centred.error();
    for (size_t v = 0; v < list.size(); ++v)
        points.row(static_cast<Eigen::Index>(v)) = (*centred)(list[v]).transpose();
    return Done{};
}

// Less the small boost that would move the mass centre as the vectors do.
Points keepingCentre(const std::vector<double>& mass, const Points& at, Points vectors)
{
    Eigen::Matrix3d boosts = Eigen::Matrix3d::Zero();
    Vec3 moved = Vec3::Zero();
    for (Eigen::Index v = 0; v < at.rows(); ++v) {
        const Vec3 p = at.row(v);
        boosts += mass[v] * (Eigen::Matrix3d::Identity() - p * p.transpose());
        moved += mass[v] * vectors.row(v).transpose();
    }
    const Vec3 boost = boosts.ldlt().solve(moved);
    for (Eigen::Index v = 0; v < at.rows(); ++v) {
        const Vec3 p = at.row(v);
        vectors.row(v) -= (boost - p.dot(boost) * p).transpose();
    }
    return vectors;
}

} // namespace

std::vector<Vec3> gaussMap(const Mesh& mesh)
{
    std::vector<Vec3> normals = vertexNormals(mesh);
    Vec3 middle = Vec3::Zero();
    for (const Vec3& p : mesh.positions) middle += p / static_cast<double>(mesh.positions.size());
    for (size_t v = 0; v < normals.size(); ++v) {
        if (normals[v].squaredNorm() > 0) continue;
        const Vec3 outward = mesh.positions[v] - middle;
        normals[v] = outward.squaredNorm() > 0 ? Vec3(outward.normalized()) : Vec3(Vec3::UnitZ());
    }
    return normals;
}

Result<SphereDescent> descendOnSphere(const Mesh& mesh, const std::vector<Vec3>& start, SphereEnergy energy,
                                      const SphereDescentOptions& options)
{
    if (const Status sphere = checkSphere(mesh); !sphere) return sphere.error();
    if (start.size() != mesh.positions.size())
        return Error{ErrorKind::BadArgument, "the start does not have one point per vertex"};
    Points at(mesh.vertexCount(), 3);
    for (int v = 0; v < mesh.vertexCount(); ++v) {
        if (!(std::abs(start[v].norm() - 1) < 1e-6))
            return Error{ErrorKind::BadArgument,
                         "the start of vertex " + std::to_string(v) + " is no unit vector"};
        at.row(v) = start[v].normalized().transpose();
    }
    const Result<SparseMatrix> laplacian = laplacianOf(mesh, energy);
    if (!laplacian) return laplacian.error();
    const std::vector<double> mass = vertexMasses(mesh);
    double total = 0;
    for (double m : mass) total += m;
    SparseMatrix preconditioner = *laplacian; // with the masses, 1 together: positive definite
    for (int v = 0; v < mesh.vertexCount(); ++v) preconditioner.coeffRef(v, v) += mass[v] / total;
    const DirichletSolver solver(preconditioner, std::vector<bool>(mesh.positions.size(), false));
    if (!solver.isSolvable())
        return Error{ErrorKind::SolverFailure, "the linear system of the map could not be solved"};

    SphereDescent out;
    if (const Status centred = centre(mass, at); !centred) return centred.error();
    double now = out.energyBefore = energyOf(*laplacian, at), step = 1;
    for (bool done = false; !done;) {
        const Points gradient = alongSphere(at, *laplacian * at);
        Points direction = Points::Zero(at.rows(), 3);
        solver.solve(direction, gradient);
        const double slope = gradient.cwiseProduct(direction).sum();
        out.residual = std::sqrt(std::max(0.0, slope) / now);
        if (out.steps == options.mostSteps) break;
        direction = keepingCentre(mass, at, alongSphere(at, direction));
        Points tried;
        double lowered = now;
        for (step = std::min(1.0, 2 * step); step > 1e-6; step *= 0.5) {
            tried = (at - step * direction).rowwise().normalized();
            if (const Status centred = centre(mass, tried); !centred) return centred.error();
            lowered = energyOf(*laplacian, tried);
            if (lowered < now) break;
        }
        if (!(lowered < now)) break;
        at = tried;
        ++out.steps;
        done = now - lowered < options.tolerance * now;
        now = lowered;
    }
    out.energy = now;
    out.map.position = listOf(at);
    out.map.massCentre = massCentre(out.map.position, mass);
    out.map.quality = conformality(mesh, out.map.position);
    out.map.flipped = flippedOnSphere(mesh.faces, out.map.position);
    return out;
}

} // namespace gimg

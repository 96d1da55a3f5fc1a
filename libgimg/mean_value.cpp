#include "gimg/mean_value.h"

#include <Eigen/SparseLU>

#include <algorithm>
#include <cmath>

namespace gimg {
namespace {

// tan(angle / 2) at p between the directions to a and b; bounded where the triangle is degenerate.
double halfAngleTangent(const Vec3& p, const Vec3& a, const Vec3& b)
{
    constexpr double kLargest = 1e4;
    const Vec3 u = a - p, v = b - p;
    const double lengths = u.norm() * v.norm();
    const double sine = u.cross(v).norm(), cosine = u.dot(v);
    // (1 - cos) / sin, and for small angles sin / (1 + cos).
    const double tangent = cosine > 0 ? sine / (lengths + cosine) : (lengths - cosine) / sine;
    return std::isfinite(tangent) ? std::clamp(tangent, 1.0 / kLargest, kLargest) : kLargest;
}

} // namespace

Status meanValueMap(const Mesh& mesh, const std::vector<bool>& fixed, std::vector<Vec2>& position)
{
    std::vector<int> unknown(mesh.positions.size(), -1);
    int unknowns = 0;
    for (const Triangle& f : mesh.faces)
        for (int v : f)
            if (!fixed[v] && unknown[v] < 0) unknown[v] = unknowns++;
    if (unknowns == 0) return Done{};

    const double shortest = 1e-7 * boundingBoxDiagonal(mesh);
    std::vector<double> rowSum(unknowns, 0.0);
    const auto forWeights = [&](auto use) {
        for (const Triangle& f : mesh.faces)
            for (int k = 0; k < 3; ++k) {
                const int v = f[k];
                if (unknown[v] < 0) continue;
                const int ends[2] = {f[(k + 1) % 3], f[(k + 2) % 3]};
                const double tangent =
                    halfAngleTangent(mesh.positions[v], mesh.positions[ends[0]], mesh.positions[ends[1]]);
                for (int w : ends)
                    use(unknown[v], w,
                        tangent / std::max(shortest, (mesh.positions[w] - mesh.positions[v]).norm()));
            }
    };
    forWeights([&](int row, int, double weight) { rowSum[row] += weight; });

    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(unknowns, 2);
    for (int row = 0; row < unknowns; ++row) entries.emplace_back(row, row, 1.0);
    forWeights([&](int row, int w, double weight) {
        if (unknown[w] >= 0)
            entries.emplace_back(row, unknown[w], -weight / rowSum[row]);
        else
            right.row(row) += weight / rowSum[row] * position[w].transpose();
    });
    Eigen::SparseMatrix<double> system(unknowns, unknowns);
    system.setFromTriplets(entries.begin(), entries.end());
    Eigen::SparseLU<Eigen::SparseMatrix<double>> solver(system);
    if (solver.info() != Eigen::Success)
        return Error{ErrorKind::FlippedTriangle, "the mean-value system could not be solved"};
    const Eigen::MatrixX2d solution = solver.solve(right);
    for (size_t v = 0; v < unknown.size(); ++v)
        if (unknown[v] >= 0) position[v] = solution.row(unknown[v]).transpose();
    return Done{};
}

} // namespace gimg

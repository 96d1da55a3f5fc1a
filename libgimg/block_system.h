#pragma once

#include "gimg/mesh.h"

#include <array>
#include <vector>

namespace gimg {

/// A symmetric 3 x 3 matrix in floats: a system of many of them is bound by memory.
struct SymmetricBlock
{
    float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

    SymmetricBlock& operator+=(const SymmetricBlock& other);
    /// Adds factor * (dyad * n n^T + identity * I).
    void add(double factor, double dyad, const Vec3& n, double identity);
    Vec3 operator*(const Vec3& v) const;
};

/// What one triangle adds to a quadratic form of its corners' vectors: blocks of the corner pairs
/// 00, 11, 22, 01, 12, 20, and a right-hand side.
struct TriangleEquations
{
    std::array<SymmetricBlock, 6> pair;
    std::array<Vec3, 3> right = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
};

/// Symmetric positive definite equations for one vector a vertex, summed over triangles.
class BlockSystem
{
public:
    /// @param own    what each vertex adds to its own block
    /// @param right  the same for the right-hand side
    /// @param fixed  vertices whose vector is zero, whatever the equations say
    BlockSystem(const std::vector<Triangle>& faces, const std::vector<TriangleEquations>& equations,
                const std::vector<SymmetricBlock>& own, const std::vector<Vec3>& right,
                const std::vector<bool>& fixed);

    /// Conjugate gradients with the inverted diagonal blocks as a preconditioner. Parallel; the numbers do
    /// not depend on the threads.
    /// @param tolerance  of the residual, relative to the right-hand side
    std::vector<Vec3> solve(double tolerance, int mostIterations) const;

private:
    struct Entry
    {
        int column;
        SymmetricBlock block;
    };

    void multiply(const std::vector<Vec3>& x, std::vector<Vec3>& y) const;

    std::vector<int> first_; ///< per row, and the end
    std::vector<Entry> entries_;
    std::vector<SymmetricBlock> diagonal_;
    std::vector<Vec3> right_;
};

} // namespace gimg

#include "block_system.h"

#include <Eigen/LU>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace gimg {
namespace {

constexpr int kGrain = 1024;

template <class Body> void forEach(size_t count, Body body)
{
    tbb::parallel_for(tbb::blocked_range<int>(0, static_cast<int>(count), kGrain),
                      [&](const tbb::blocked_range<int>& range) {
                          for (int i = range.begin(); i < range.end(); ++i) body(i);
                      });
}

// Slices are always the same and summed in order, so that the threads leave no trace.
double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    constexpr size_t kSlice = 4096;
    std::vector<double> sums((a.size() + kSlice - 1) / kSlice, 0.0);
    tbb::parallel_for(size_t{0}, sums.size(), [&](size_t s) {
        const size_t end = std::min(a.size(), (s + 1) * kSlice);
        for (size_t i = s * kSlice; i < end; ++i) sums[s] += a[i].dot(b[i]);
    });
    double sum = 0;
    for (const double part : sums) sum += part;
    return sum;
}

Eigen::Matrix3d dense(const SymmetricBlock& b)
{
    Eigen::Matrix3d m;
    m << b.xx, b.xy, b.xz, b.xy, b.yy, b.yz, b.xz, b.yz, b.zz;
    return m;
}

struct Corner
{
    int face, corner;
};

/// The corners at every vertex.
struct Fans
{
    std::vector<int> first;
    std::vector<Corner> corners;

    Fans(const std::vector<Triangle>& faces, size_t vertices) : first(vertices + 1, 0)
    {
        for (const Triangle& t : faces)
            for (const int v : t) ++first[v + 1];
        for (size_t v = 0; v < vertices; ++v) first[v + 1] += first[v];
        corners.resize(first.back());
        std::vector<int> next(first.begin(), first.end() - 1);
        for (int f = 0; f < static_cast<int>(faces.size()); ++f)
            for (int k = 0; k < 3; ++k) corners[next[faces[f][k]]++] = {f, k};
    }
};

} // namespace

SymmetricBlock& SymmetricBlock::operator+=(const SymmetricBlock& other)
{
    xx += other.xx, xy += other.xy, xz += other.xz;
    yy += other.yy, yz += other.yz, zz += other.zz;
    return *this;
}

void SymmetricBlock::add(double factor, double dyad, const Vec3& n, double identity)
{
    const double d = factor * dyad, i = factor * identity;
    xx += static_cast<float>(d * n.x() * n.x() + i);
    xy += static_cast<float>(d * n.x() * n.y());
    xz += static_cast<float>(d * n.x() * n.z());
    yy += static_cast<float>(d * n.y() * n.y() + i);
    yz += static_cast<float>(d * n.y() * n.z());
    zz += static_cast<float>(d * n.z() * n.z() + i);
}

Vec3 SymmetricBlock::operator*(const Vec3& v) const
{
    return {xx * v.x() + xy * v.y() + xz * v.z(), xy * v.x() + yy * v.y() + yz * v.z(),
            xz * v.x() + yz * v.y() + zz * v.z()};
}

BlockSystem::BlockSystem(const std::vector<Triangle>& faces, const std::vector<TriangleEquations>& equations,
                         const std::vector<SymmetricBlock>& own, const std::vector<Vec3>& right,
                         const std::vector<bool>& fixed)
    : first_(own.size() + 1, 0), diagonal_(own), right_(right)
{
    const Fans fans(faces, own.size());
    const auto forEachNeighbour = [&](int v, auto visit) {
        for (int c = fans.first[v]; c < fans.first[v + 1] && !fixed[v]; ++c)
            for (int step = 1; step < 3; ++step) {
                const int other = (fans.corners[c].corner + step) % 3;
                const int column = faces[fans.corners[c].face][other];
                if (!fixed[column]) visit(column, fans.corners[c], step);
            }
    };
    forEach(own.size(), [&](int v) {
        std::vector<int> columns;
        forEachNeighbour(v, [&](int column, const Corner&, int) { columns.push_back(column); });
        std::sort(columns.begin(), columns.end());
        first_[v + 1] = static_cast<int>(std::unique(columns.begin(), columns.end()) - columns.begin());
    });
    for (size_t v = 0; v < own.size(); ++v) first_[v + 1] += first_[v];
    entries_.resize(first_.back());
    forEach(own.size(), [&](int v) {
        if (fixed[v]) {
            diagonal_[v] = {1, 0, 0, 1, 0, 1};
            right_[v].setZero();
            return;
        }
        for (int c = fans.first[v]; c < fans.first[v + 1]; ++c) {
            const TriangleEquations& e = equations[fans.corners[c].face];
            diagonal_[v] += e.pair[fans.corners[c].corner];
            right_[v] += e.right[fans.corners[c].corner];
        }
        Entry* const begin = entries_.data() + first_[v];
        Entry* end = begin;
        forEachNeighbour(v, [&](int column, const Corner& at, int step) {
            Entry* entry = std::find_if(begin, end, [&](const Entry& e) { return e.column == column; });
            if (entry == end) *end++ = {column, {}};
            // Pair 3 + k is that of corners k and k + 1.
            entry->block += equations[at.face].pair[3 + (step == 1 ? at.corner : (at.corner + 2) % 3)];
        });
    });
}

void BlockSystem::multiply(const std::vector<Vec3>& x, std::vector<Vec3>& y) const
{
    forEach(x.size(), [&](int v) {
        Vec3 sum = diagonal_[v] * x[v];
        for (int k = first_[v]; k < first_[v + 1]; ++k) sum += entries_[k].block * x[entries_[k].column];
        y[v] = sum;
    });
}

std::vector<Vec3> BlockSystem::solve(double tolerance, int mostIterations) const
{
    const size_t n = right_.size();
    std::vector<Eigen::Matrix3d> inverse(n);
    forEach(n, [&](int v) { inverse[v] = dense(diagonal_[v]).inverse(); });
    std::vector<Vec3> x(n, Vec3::Zero()), residual = right_, z(n), direction(n), image(n);
    forEach(n, [&](int v) { z[v] = inverse[v] * residual[v]; });
    direction = z;
    double along = dot(residual, z);
    const double enough = tolerance * tolerance * along;
    for (int iteration = 0; iteration < mostIterations && along > enough; ++iteration) {
        multiply(direction, image);
        const double step = along / dot(direction, image);
        forEach(n, [&](int v) {
            x[v] += step * direction[v];
            residual[v] -= step * image[v];
            z[v] = inverse[v] * residual[v];
        });
        const double next = dot(residual, z);
        const double turn = next / along;
        forEach(n, [&](int v) { direction[v] = z[v] + turn * direction[v]; });
        along = next;
    }
    return x;
}

} // namespace gimg

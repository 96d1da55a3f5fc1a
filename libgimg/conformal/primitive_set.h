#pragma once

#include <Eigen/Core>

#include <cstdint>

namespace gimg {

/// Integer vectors of which every integer vector in their span is an integer combination: a set that can be
/// completed to a basis of all integer vectors.
class PrimitiveSet
{
public:
    explicit PrimitiveSet(int dimension) : toUnits_(Matrix::Identity(dimension, dimension)) {}

    int size() const { return size_; }

    /// Adds v if the set stays primitive. (Also refuses where numbers would grow beyond 2^40.)
    bool add(const Eigen::VectorXi& v);

private:
    using Matrix = Eigen::Matrix<int64_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

    Matrix toUnits_; // of determinant +-1; takes the set to a triangle of units
    int size_ = 0;
};

} // namespace gimg

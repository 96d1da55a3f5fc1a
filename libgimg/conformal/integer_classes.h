#pragma once

#include "conformal/tree_cotree.h"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace gimg {

/// Homology classes of loops as 2g integers: their integrals over closed integer forms that are dual to the
/// loops of a tree-cotree decomposition. Those forms are 0 on the tree and on most of the cotree, and the
/// other edges share a few values, of which a table is kept.
class IntegerClasses
{
public:
    /// @param tree  of `surface`; must outlive this like it
    IntegerClasses(const ClosedSurface& surface, const TreeCotree& decomposition);

    int size() const { return size_; } ///< 2g

    /// Adds the values of halfedge h to `sum`, `times` times.
    void add(int h, int times, Eigen::VectorXi& sum) const;
    bool isZero(int h) const { return row_[h] == 0; }

    Eigen::VectorXi of(std::span<const int> halfedges) const;

private:
    int size_;
    std::vector<int> row_; // per halfedge: 1 + its row of the table, negative for minus it, or 0
    std::vector<Eigen::VectorXi> table_; // distinct values
};

} // namespace gimg

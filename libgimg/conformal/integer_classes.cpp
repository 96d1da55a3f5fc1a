#include "conformal/integer_classes.h"

namespace gimg {

IntegerClasses::IntegerClasses(const ClosedSurface& surface, const TreeCotree& decomposition)
    : size_(static_cast<int>(decomposition.loopEdges.size())),
      row_(static_cast<size_t>(surface.halfedges.count()), 0)
{
    const Halfedges& he = surface.halfedges;
    const auto assign = [&](int h, int row) {
        row_[h] = row;
        row_[he.twin(h)] = -row;
    };
    for (int i = 0; i < size_; ++i) {
        table_.push_back(Eigen::VectorXi::Unit(size_, i));
        assign(decomposition.loopEdges[i], i + 1);
    }
    // From the leaves inwards, two of the three values of a face are known.
    for (size_t i = decomposition.faceOrder.size(); i-- > 1;) {
        const int h = decomposition.hangsBy[decomposition.faceOrder[i]];
        const int p = Halfedges::next(h), q = Halfedges::prev(h);
        if (isZero(p) || isZero(q)) {
            assign(h, -(row_[p] + row_[q]));
            continue;
        }
        Eigen::VectorXi value = Eigen::VectorXi::Zero(size_);
        add(p, -1, value);
        add(q, -1, value);
        if (value.isZero()) continue;
        table_.push_back(value);
        assign(h, static_cast<int>(table_.size()));
    }
}

void IntegerClasses::add(int h, int times, Eigen::VectorXi& sum) const
{
    const int row = row_[h];
    if (row > 0) sum += times * table_[row - 1];
    if (row < 0) sum -= times * table_[-row - 1];
}

Eigen::VectorXi IntegerClasses::of(std::span<const int> halfedges) const
{
    Eigen::VectorXi sum = Eigen::VectorXi::Zero(size_);
    for (int h : halfedges) add(h, 1, sum);
    return sum;
}

} // namespace gimg

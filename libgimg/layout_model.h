#pragma once

#include "gimg/border.h"

#include <Eigen/Dense>

#include <optional>
#include <vector>

namespace gimg {

/// How the least energy of a flattened square depends on its layout, to second order around one layout: when
/// the start or a length changes, cone points move along the border, the ties between mates shift, and all
/// free vertices follow.
///
/// With z the corners' coordinates, x the free unknowns and y = (start, lengths), z depends on x and y
/// linearly, and with x at its best for each y
///     dE/dy = g_y - H_yx H_xx^-1 g_x,    d2E/dy2 = H_yy - H_yx H_xx^-1 H_xy.
class LayoutModel
{
public:
    /// @param square  laid out as `layout` says
    /// @param st      its flattening, at or near the least energy
    /// @param importance  per surface vertex, as the flattening had it
    LayoutModel(const SquareDisk& square, const std::vector<double>& importance, const std::vector<Vec2>& st);

    /// Of the layout itself.
    double energy() const { return energy_; }

    /// The energy expected for another layout of the same lowest level. Nothing where the square's corners
    /// fall into other paths than before, or on nodes they were not on: then other vertices are held.
    std::optional<double> energy(const BorderLayout& other) const;

private:
    struct Corner // where a corner of the square falls: inside side number `side`, or at its begin
    {
        int side;
        bool atNode;
        bool operator==(const Corner&) const = default;
    };
    std::vector<Corner> corners(const BorderLayout& layout) const;

    const BorderLayout layout_;
    std::vector<int> pathOfSide_;
    std::vector<Corner> corners_;
    double energy_ = 0;
    Eigen::VectorXd gradient_; ///< by the start, then by each path's length
    Eigen::MatrixXd hessian_;
};

} // namespace gimg

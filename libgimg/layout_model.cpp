#include "layout_model.h"

#include "border_ties.h"
#include "gimg/stretch.h"
#include "stretch_element.h"

#include <Eigen/Sparse>

namespace gimg {
namespace {

// Of the convexified Hessian: that much agrees best with what flattening anew shows.
constexpr double kBending = 0.25;

using SparseMatrix = Eigen::SparseMatrix<double>;
using Pair = Eigen::Matrix<double, 2, Eigen::Dynamic>; // of a vertex: its (s,t) by (start, lengths)

// How border vertices move with the start and the lengths, free unknowns held.
class BorderMotion
{
public:
    explicit BorderMotion(const SquareDisk& square)
        : square_(square), ties(borderTies(square)),
          parameters_(1 + static_cast<int>(square.pathLength.size())), side_(square.lowest - 1)
    {
        walkSides();
        movement.assign(square.squareSides.size(), Pair());
        for (size_t i = 0; i < ties.copies.size();) {
            size_t end = i + 1;
            while (end < ties.copies.size() && ties.copies[end].parent >= 0) ++end;
            moveClass(i, end);
            i = end;
        }
    }

private:
    const SquareDisk& square_;

public:
    const BorderTies ties;
    std::vector<Pair> movement; // per disk vertex; empty inside

private:
    Vec2 direction(int position) const { return sideDirection(position / side_ % 4); }

    void walkSides()
    {
        Eigen::RowVectorXd begin = Eigen::RowVectorXd::Zero(parameters_);
        begin[0] = 1;
        mates_.assign(square_.pathLength.size(), Eigen::RowVectorXd::Zero(parameters_));
        node_.assign(square_.squareSides.size(), Pair());
        int position = square_.start;
        for (const DiskSide& s : square_.disk.sides) {
            node_[s.vertices.front()] =
                position % side_ == 0 ? Pair::Zero(2, parameters_) : Pair(direction(position) * begin);
            mates_[s.path] += begin;
            if (s.reversed) mates_[s.path][1 + s.path] += 1;
            begin[1 + s.path] += 1;
            position += square_.pathLength[s.path];
        }
    }

    Pair turned(const Pair& p, int turns) const
    {
        Eigen::Matrix2d r;
        const GridMotion motion{turns, Vec2::Zero()};
        r << motion.turned({1, 0}), motion.turned({0, 1});
        return r * p;
    }

    void moveClass(size_t first, size_t end)
    {
        const int leader = ties.copies[first].vertex;
        const bool held = !ties.free[leader][0] && !ties.free[leader][1];
        movement[leader] = Pair::Zero(2, parameters_);
        if (held && leader != ties.anchor && node_[leader].size() > 0) movement[leader] = node_[leader];
        follow(first, end);
        if (!held || node_[leader].size() > 0) return;
        // Held by a corner of the square: the copy there rests.
        for (size_t i = first; i < end; ++i) {
            const int v = ties.copies[i].vertex;
            if ((square_.squareSides[v] & (square_.squareSides[v] - 1)) == 0) continue;
            movement[leader] = -turned(movement[v], (4 - ties.motion[v].turns) % 4);
            follow(first, end);
            return;
        }
    }

    void follow(size_t first, size_t end)
    {
        for (size_t i = first + 1; i < end; ++i) {
            const BorderTies::Copy& copy = ties.copies[i];
            const int turns = (ties.motion[copy.vertex].turns + 4 - ties.motion[copy.parent].turns) % 4;
            movement[copy.vertex] =
                turned(movement[copy.parent], turns) + sideDirection(copy.edge) * mates_[copy.path];
        }
    }

    const int parameters_, side_;
    std::vector<Eigen::RowVectorXd> mates_; // per path: how far the mate's end moves past its begin
    std::vector<Pair> node_;                // per disk vertex: its movement if it is a node
};

} // namespace

LayoutModel::LayoutModel(const SquareDisk& square, const std::vector<double>& importance,
                         const std::vector<Vec2>& st)
    : layout_{square.lowest, square.start, square.pathLength}
{
    for (const DiskSide& s : square.disk.sides) pathOfSide_.push_back(s.path);
    corners_ = corners(layout_);

    const Mesh& disk = square.disk.mesh;
    const BorderMotion border(square);
    const int coordinates = 2 * disk.vertexCount(),
              parameters = 1 + static_cast<int>(square.pathLength.size());
    const double step = 1.0 / (square.lowest - 1);

    std::vector<std::array<int, 2>> row(st.size(), {-1, -1});
    std::vector<Eigen::Triplet<double>> free, moved, entries;
    int unknowns = 0;
    for (int v = 0; v < disk.vertexCount(); ++v) {
        const int leader = border.ties.leader[v];
        const GridMotion turn{border.ties.motion[v].turns, Vec2::Zero()};
        for (int c = 0; c < 2; ++c)
            if (border.ties.free[leader][c] && row[leader][c] < 0) row[leader][c] = unknowns++;
        const Vec2 of[2] = {turn.turned({1, 0}), turn.turned({0, 1})};
        for (int k = 0; k < 2; ++k)
            for (int c = 0; c < 2; ++c)
                if (row[leader][k] >= 0 && of[k][c] != 0)
                    free.emplace_back(2 * v + c, row[leader][k], of[k][c]);
        if (border.movement[v].size() == 0) continue;
        for (int c = 0; c < 2; ++c)
            for (int y = 0; y < parameters; ++y)
                if (border.movement[v](c, y) != 0)
                    moved.emplace_back(2 * v + c, y, step * border.movement[v](c, y));
    }
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(coordinates);
    for (const Triangle& f : disk.faces) {
        double weight = 0;
        for (int v : f) weight += importance[square.disk.origin[v]] / 3;
        const StretchElement element(disk.positions[f[0]], disk.positions[f[1]], disk.positions[f[2]],
                                     weight);
        const std::array<Vec2, 3> p = {st[f[0]], st[f[1]], st[f[2]]};
        const StretchElement::Derivatives d = element.derivatives(p);
        energy_ += element.energy(p);
        const auto at = [&](int i) { return 2 * f[i % 3] + i / 3; };
        for (int i = 0; i < 6; ++i) {
            gradient[at(i)] += d.gradient[i];
            for (int j = 0; j < 6; ++j) entries.emplace_back(at(i), at(j), d.hessian(i, j));
        }
    }
    SparseMatrix x(coordinates, unknowns), y(coordinates, parameters), hessian(coordinates, coordinates);
    x.setFromTriplets(free.begin(), free.end());
    y.setFromTriplets(moved.begin(), moved.end());
    hessian.setFromTriplets(entries.begin(), entries.end());
    const SparseMatrix hx = hessian * x, hy = hessian * y;
    SparseMatrix xx = x.transpose() * hx;
    for (int k = 0; k < unknowns; ++k) xx.coeffRef(k, k) *= 1 + 1e-9;
    const Eigen::MatrixXd xy = x.transpose() * hy;
    const Eigen::VectorXd gx = x.transpose() * gradient;
    const Eigen::SimplicialLDLT<SparseMatrix> solver(xx);
    const Eigen::MatrixXd follows = solver.solve(xy);
    gradient_ = y.transpose() * gradient - follows.transpose() * gx;
    hessian_ = Eigen::MatrixXd(y.transpose() * hy) - xy.transpose() * follows;
}

std::vector<LayoutModel::Corner> LayoutModel::corners(const BorderLayout& layout) const
{
    std::vector<Corner> found;
    const int side = layout.lowest - 1;
    int begin = layout.start;
    for (size_t i = 0; i < pathOfSide_.size(); ++i) {
        const int end = begin + layout.pathLength[pathOfSide_[i]];
        for (int corner = 0; corner < 8 * side; corner += side)
            if (corner >= begin && corner < end) found.push_back({static_cast<int>(i), corner == begin});
        begin = end;
    }
    return found;
}

std::optional<double> LayoutModel::energy(const BorderLayout& other) const
{
    if (corners(other) != corners_) return std::nullopt;
    Eigen::VectorXd by(gradient_.size());
    const int perimeter = 4 * (layout_.lowest - 1);
    by[0] = (other.start - layout_.start + 3 * perimeter / 2) % perimeter - perimeter / 2;
    for (size_t p = 0; p < other.pathLength.size(); ++p)
        by[1 + static_cast<Eigen::Index>(p)] = other.pathLength[p] - layout_.pathLength[p];
    return energy_ + gradient_.dot(by) + 0.5 * kBending * by.dot(hessian_ * by);
}

} // namespace gimg

#pragma once

#include "conformal/integer_classes.h"
#include "gimg/homology.h"

#include <Eigen/Core>

#include <vector>

namespace gimg {

/// Finds short loops in given homology classes of one surface.
class LoopFinder
{
public:
    /// @param surface  must outlive this
    explicit LoopFinder(const ClosedSurface& surface);

    /// See homologyBasis().
    std::vector<Loop> basis();

    /// One closed walk in the class of the sum of multiplicity[i] times loops[i], pulled tight if it is more
    /// than one of them.
    Loop joined(std::span<const Loop> loops, const Eigen::VectorXi& multiplicity);

private:
    struct Candidate
    {
        double length;
        Eigen::VectorXi homologyClass;
        Loop loop;
    };

    std::vector<Candidate> candidatesThrough(int root);
    Loop tightened(Loop loop);
    bool takeShortcut(std::vector<int>& loop);
    double lengthOf(const std::vector<int>& halfedges) const;

    const ClosedSurface& surface_;
    ShortestPaths paths_;
    TreeCotree decomposition_;
    IntegerClasses classes_;
};

} // namespace gimg

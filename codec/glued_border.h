#pragma once

#include "border.h"

#include <cstddef>

namespace gimg::codec {

/// The border of an n x n grid with what is glued to what, to be read at this grid and all coarser ones where
/// the sides of the seam begin and end on grid points.
class GluedBorder
{
public:
    static constexpr std::uint32_t kNoMate = UINT32_MAX;

    /// @param classes  borderClasses() of the grid
    /// @param mates    borderSize(grid) entries of scratch, kept
    GluedBorder(const SeamView& seam, std::uint32_t grid, const std::uint32_t* classes, std::uint32_t* mates);

    /// A border where nothing is glued, whatever the seam.
    explicit GluedBorder(std::uint32_t grid)
        : classes_(nullptr), mates_(nullptr), grid_(grid), coarsest_(UINT32_MAX)
    {
    }

    std::uint32_t grid() const { return grid_; }

    /// The coarsest grid whose points are glued to each other.
    std::uint32_t coarsest() const { return coarsest_; }
    bool isGluedAt(std::uint32_t size) const { return size >= coarsest_; }

    /// The smallest position that one is glued to, itself if none is smaller; at a grid that is glued.
    std::uint32_t classOf(std::uint32_t size, std::uint32_t position) const
    {
        const std::uint32_t stride = (grid_ - 1) / (size - 1);
        return classes_[position * stride] / stride;
    }

    /// The position that one is glued to, if that is a single other one, else kNoMate.
    std::uint32_t mateOf(std::uint32_t size, std::uint32_t position) const
    {
        const std::uint32_t stride = (grid_ - 1) / (size - 1);
        const std::uint32_t mate = mates_[position * stride];
        return mate == kNoMate ? kNoMate : mate / stride;
    }

    /// Gives all samples of a class their mean, in which each counts by the number of cells around it: one
    /// at the square's corners, two elsewhere.
    /// @param image  size x size samples
    /// @param work   2 borderSize(size) numbers
    void average(double* image, std::uint32_t size, double* work) const;

private:
    const std::uint32_t* classes_;
    const std::uint32_t* mates_;
    std::uint32_t grid_;
    std::uint32_t coarsest_;
};

} // namespace gimg::codec

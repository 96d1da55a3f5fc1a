#pragma once

#include "glued_border.h"
#include "seam.h"
#include "surface_frame.h"

#include <cstdint>
#include <span>
#include <vector>

namespace gimg::codec {

/// A surface after the forward transform along its seam, ready to be quantised at any step.
struct TransformedSurface
{
    struct Level
    {
        std::vector<double> detail[kComponents]; ///< size^2 vectors, 0 at the coarser level's places
        double largest[3] = {};                  ///< length of a detail, by orientation
    };
    std::uint32_t grid = 0;
    std::vector<Level> levels; ///< the coarsest first
    double coarse[kComponents][kCoarsest * kCoarsest] = {};
    double largest = 0;  ///< magnitude of any coefficient
    double diagonal = 0; ///< of the samples' bounding box
};

struct CodedSurface
{
    std::vector<std::uint8_t> payload;
    std::vector<float> decoded; ///< 3 grid^2 numbers, what a decoder will make of it
};

/// Codes surfaces of one seam.
class SurfaceEncoder
{
public:
    /// The seam must be without fault, and `grid` a refinement of its lowest grid.
    SurfaceEncoder(const Seam& seam, std::uint32_t grid);

    /// @param samples  3 grid^2 finite numbers; glued samples are averaged
    TransformedSurface transform(std::span<const float> samples) const;

    /// Quantises and codes. Magnitudes are chosen by what they cost and what they mend.
    /// The step must not be below smallestStep().
    /// @param withPayload  false: only what a decoder will make of it
    CodedSurface encode(const TransformedSurface& surface, const SurfaceParameters& parameters,
                        bool withPayload = true) const;

private:
    SeamView view() const;

    Seam seam_;
    std::uint32_t grid_;
    std::vector<std::uint32_t> classes_;
};

/// The step below which coefficients would not fit their coded range.
float smallestStep(const TransformedSurface& surface);

} // namespace gimg::codec

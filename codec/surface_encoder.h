#pragma once

#include "field_frame.h"
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
    unsigned smoothLevels = 0; ///< of the levels so many of the finest are not to be coded
    double prefixCare = 0;     ///< see Slides
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

/// A field's channels after the same transform, by threes.
struct TransformedField
{
    unsigned channels = 0;
    bool glued = true;
    std::vector<TransformedSurface> groups;
    std::uint32_t grid = 0;
    double largest = 0;  ///< magnitude of any coefficient
    double diagonal = 0; ///< of the values' bounding box
    float finest = 0;    ///< a step below which there is nothing to gain
};

struct CodedField
{
    std::vector<std::uint8_t> payload;
    std::vector<float> decoded; ///< `channels` numbers for each sample, before integers are rounded
};

/// Codes surfaces and fields of one seam.
class SurfaceEncoder
{
public:
    /// The seam must be without fault, and `grid` a refinement of its lowest grid.
    /// @param smoothLevels  how many of a surface's finest levels get no details
    SurfaceEncoder(const Seam& seam, std::uint32_t grid, unsigned smoothLevels = 0);

    /// @param samples  3 grid^2 finite numbers; glued samples are averaged
    TransformedSurface transform(std::span<const float> samples) const;

    /// Quantises and codes. Magnitudes are chosen by what they cost and what they mend.
    /// The step must not be below smallestStep().
    /// @param withPayload  false: only what a decoder will make of it
    CodedSurface encode(const TransformedSurface& surface, const SurfaceParameters& parameters,
                        bool withPayload = true) const;

    /// @param samples   `channels` numbers for each of grid^2 samples, finite
    /// @param channels  1 to 16
    /// @param glued     whether glued samples agree: they are averaged
    TransformedField transformField(std::span<const float> samples, unsigned channels, bool glued) const;

    /// The step must not be below smallestStep().
    CodedField encodeField(const TransformedField& field, const FieldParameters& parameters) const;

private:
    SeamView view() const;
    TransformedSurface transform(std::span<const float> samples, unsigned channels, unsigned first,
                                 const GluedBorder& border) const;

    Seam seam_;
    std::uint32_t grid_;
    unsigned smoothLevels_;
    std::vector<std::uint32_t> classes_;
};

/// The step below which coefficients would not fit their coded range.
float smallestStep(const TransformedSurface& surface);
float smallestStep(const TransformedField& field);

} // namespace gimg::codec

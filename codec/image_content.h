#pragma once

#include "forward.h"
#include "gim.h"
#include "seam.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace gimg::codec {

/// What is wrong with an image's size or samples; empty if nothing is.
std::string imageFault(const std::string& what, std::span<const float> samples, std::uint32_t grid,
                       std::uint32_t lowest, unsigned channels);

/// The kind byte, with which an image's part of its chunk begins.
std::vector<std::uint8_t> imageContent(std::uint32_t grid, gim_coding coding);

std::vector<std::uint8_t> waveletContent(const TransformedImage& image, float step);

/// @param coding  GIM_CODING_RAW12, of integers held in floats, or GIM_CODING_FLOAT
/// @param fields  of the coding
std::vector<std::uint8_t> exactContent(std::span<const float> samples, std::uint32_t grid, gim_coding coding,
                                       std::span<const float> fields, const Seam& seam);

struct IntegerContent
{
    std::vector<std::uint8_t> content; ///< empty if the samples are too far apart
    float step = 0;
};

IntegerContent integerContent(std::span<const float> samples, std::uint32_t grid, const Seam& seam);

} // namespace gimg::codec

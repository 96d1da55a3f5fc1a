#include "image_content.h"

#include "exact_encoder.h"
#include "format/writer.h"
#include "image_header.h"

#include <algorithm>
#include <cmath>

namespace gimg::codec {

namespace {

using Bytes = std::vector<std::uint8_t>;

unsigned exponentOf(std::uint32_t grid) { return log2Floor(grid - 1); }

bool isGridSize(std::uint32_t n)
{
    return n >= 3 && n <= (1u << kLargestExponent) + 1 && ((n - 1) & (n - 2)) == 0;
}

} // namespace

std::string imageFault(const std::string& what, std::span<const float> samples, std::uint32_t grid,
                       std::uint32_t lowest, unsigned channels)
{
    if (!isGridSize(grid)) return what + ": the grid is not 2^j + 1 samples a side with j in 1..12";
    if (grid < lowest) return what + ": the grid is smaller than the lowest level";
    if (samples.size() != std::size_t{grid} * grid * channels)
        return what + ": the number of samples does not fit the grid";
    const auto bad =
        std::find_if(samples.begin(), samples.end(), [](float value) { return !std::isfinite(value); });
    if (bad != samples.end())
        return what + ": sample " + std::to_string((bad - samples.begin()) / channels) + " is not finite";
    return {};
}

Bytes imageContent(std::uint32_t grid, gim_coding coding)
{
    return {static_cast<std::uint8_t>(exponentOf(grid) | static_cast<unsigned>(coding) << 4)};
}

Bytes waveletContent(const TransformedImage& image, float step)
{
    const CodedImage coded = encodeCoefficients(image, step);
    Bytes content = imageContent(image.grid, GIM_CODING_WAVELET);
    format::appendF32(content, step);
    content.push_back(coded.shifts);
    for (const std::uint8_t byte : coded.payload) content.push_back(byte);
    return content;
}

Bytes exactContent(std::span<const float> samples, std::uint32_t grid, gim_coding coding,
                   std::span<const float> fields, const Seam& seam)
{
    Bytes content = imageContent(grid, coding);
    for (const float field : fields) format::appendF32(content, field);
    const ExactFormat format = {grid, kComponents, coding == GIM_CODING_RAW12 ? kCubeBits : 0};
    for (const std::uint8_t byte : encodeExact(samples, format, borderClasses(seam, grid)))
        content.push_back(byte);
    return content;
}

IntegerContent integerContent(std::span<const float> samples, std::uint32_t grid, const Seam& seam)
{
    float least[kComponents], most[kComponents];
    for (unsigned c = 0; c < kComponents; ++c) least[c] = most[c] = samples[c];
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const std::size_t c = k % kComponents;
        least[c] = std::min(least[c], samples[k]);
        most[c] = std::max(most[c], samples[k]);
    }
    double side = 0;
    for (unsigned c = 0; c < kComponents; ++c)
        side = std::max(side, static_cast<double>(most[c]) - static_cast<double>(least[c]));
    constexpr long kMost = (1l << kCubeBits) - 1;
    const float step = std::max(static_cast<float>(side / static_cast<double>(kMost)), kSmallestStep);
    if (step > kLargestStep) return {};
    std::vector<float> integers(samples.size());
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const double offset = static_cast<double>(samples[k]) - static_cast<double>(least[k % kComponents]);
        integers[k] =
            static_cast<float>(std::clamp(std::lround(offset / static_cast<double>(step)), 0l, kMost));
    }
    const float fields[] = {least[0], least[1], least[2], step};
    return {exactContent(integers, grid, GIM_CODING_RAW12, fields, seam), step};
}

} // namespace gimg::codec

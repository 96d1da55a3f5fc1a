#include "forward.h"

#include "bit_counter.h"
#include "quantizer.h"
#include "range_encoder.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gimg::codec {

namespace {

/// What one bit is allowed to mend, in squared steps. At high rates a bit halves the error, and
/// d(step^2 / 12 * 4^-b) / db = -0.1155 step^2.
constexpr double kWorthOfBit = 0.09;
/// A band none of whose magnitudes reaches this many steps is not worth coding.
constexpr double kEmptyBelow = 0.6;

/// Mean distance of values from the magnitude they were given.
struct ShiftFit
{
    double sum = 0;
    double count = 0;

    unsigned nibble() const
    {
        if (count == 0) return Dequantizer::kShiftBias;
        const double units = -sum / count / Dequantizer::kShiftUnit;
        return static_cast<unsigned>(std::clamp(std::lround(units) + Dequantizer::kShiftBias, 0l, 15l));
    }
};

/// Chooses and codes one coefficient after the other.
class CostAwarePick
{
public:
    CostAwarePick(const TransformedImage& image, double step) : image_(image), inverseStep_(1.0 / step) {}

    std::int32_t operator()(RangeEncoder& coder, const CoefficientContext& context, unsigned component,
                            std::size_t index)
    {
        const double exact = image_.detail[component][index] * inverseStep_;
        const double size = std::abs(exact);
        const std::int32_t sign = exact < 0 ? -1 : 1;
        const std::int32_t magnitude = thriftyMagnitude(size, kWorthOfBit, [&](std::int32_t candidate) {
            BitCounter counter;
            codeDetail(counter, context, sign * candidate);
            return counter.bits();
        });
        if (magnitude != 0) {
            ShiftFit& fit = magnitude == 1 ? one_ : more_;
            fit.sum += size - magnitude;
            fit.count += 1;
        }
        return codeDetail(coder, context, sign * magnitude);
    }

    std::uint8_t shifts() const { return static_cast<std::uint8_t>(one_.nibble() | more_.nibble() << 4); }

private:
    const TransformedImage& image_;
    double inverseStep_;
    ShiftFit one_, more_;
};

std::size_t bandIndex(const Subband& band)
{
    std::size_t level = 0;
    const std::uint32_t m = std::max(band.i0, band.j0);
    for (std::uint32_t k = kCoarsest; k < m; k = 2 * k - 1) ++level;
    return 3 * level + (band.j0 == 0 ? Horizontal : band.i0 == 0 ? Vertical : Diagonal);
}

} // namespace

void forwardLifting(double* image, std::uint32_t size)
{
    for (std::uint32_t j = 0; j < size; ++j) {
        double* line = image + j * std::size_t{size};
        liftOdd(line, size, kAlpha);
        liftEven(line, size, kBeta);
        liftOdd(line, size, kGamma);
        liftEven(line, size, kDelta);
    }
    liftRows(image, size, 1, kAlpha);
    liftRows(image, size, 0, kBeta);
    liftRows(image, size, 1, kGamma);
    liftRows(image, size, 0, kDelta);
}

TransformedImage transform(std::span<const float> samples, std::uint32_t grid)
{
    TransformedImage out;
    out.grid = grid;
    const std::size_t count = std::size_t{grid} * grid;
    double squaredDiagonal = 0;
    for (unsigned c = 0; c < kComponents; ++c) {
        std::vector<double> image(count), coarse;
        for (std::size_t k = 0; k < count; ++k) image[k] = static_cast<double>(samples[kComponents * k + c]);
        const auto [least, most] = std::minmax_element(image.begin(), image.end());
        squaredDiagonal += (*most - *least) * (*most - *least);

        std::vector<double>& plane = out.detail[c];
        plane.assign(count, 0.0);
        std::vector<double> largestFineFirst;
        for (std::uint32_t size = grid; size > kCoarsest; size = size / 2 + 1) {
            forwardLifting(image.data(), size);
            const std::uint32_t m = size / 2 + 1;
            coarse.resize(std::size_t{m} * m);
            double largest[3] = {};
            for (std::uint32_t j = 0; j < size; ++j)
                for (std::uint32_t i = 0; i < size; ++i) {
                    const double value = image[j * std::size_t{size} + i];
                    if (i % 2 == 0 && j % 2 == 0) {
                        coarse[j / 2 * std::size_t{m} + i / 2] = value * kAreaScale;
                        continue;
                    }
                    const unsigned orientation = i % 2 == 0 ? Vertical : j % 2 == 0 ? Horizontal : Diagonal;
                    const Subband band = subband(m, orientation);
                    const double scaled = orientation == Diagonal ? value * kInverseAreaScale : value;
                    plane[(band.j0 + j / 2) * std::size_t{grid} + band.i0 + i / 2] = scaled;
                    largest[orientation] = std::max(largest[orientation], std::abs(scaled));
                }
            for (unsigned o = 3; o-- > 0;) largestFineFirst.push_back(largest[o]);
            image.swap(coarse);
        }
        out.largestOfBand[c].assign(largestFineFirst.rbegin(), largestFineFirst.rend());
        for (unsigned k = 0; k < kCoarsest * kCoarsest; ++k) {
            out.coarse[c][k] = image[k];
            out.largest = std::max(out.largest, std::abs(image[k]));
        }
        for (const double value : largestFineFirst) out.largest = std::max(out.largest, value);
    }
    out.diagonal = std::sqrt(squaredDiagonal);
    return out;
}

float smallestStep(double largestDetail, double largest)
{
    const double needed =
        std::max(largestDetail / (kMaxDetail - 1), largest / (static_cast<double>(kMaxCoarse) / 4));
    const float step = std::nextafter(static_cast<float>(needed), kLargestStep);
    return std::max(step, kSmallestStep);
}

float smallestStep(const TransformedImage& image)
{
    double detail = 0;
    for (const auto& bands : image.largestOfBand)
        for (const double value : bands) detail = std::max(detail, value);
    return smallestStep(detail, image.largest);
}

CodedImage encodeCoefficients(const TransformedImage& image, float step)
{
    const double exactStep = static_cast<double>(step);
    QuantizedImage quantized;
    quantized.grid = image.grid;
    std::vector<std::int32_t> planes[kComponents];
    for (unsigned c = 0; c < kComponents; ++c) {
        planes[c].assign(image.detail[c].size(), 0);
        quantized.detail[c] = planes[c].data();
        for (unsigned k = 0; k < kCoarsest * kCoarsest; ++k)
            quantized.coarse[c][k] = std::llround(image.coarse[c][k] / exactStep);
    }
    const auto isEmpty = [&](unsigned c, const Subband& band) {
        return image.largestOfBand[c][bandIndex(band)] < kEmptyBelow * exactStep;
    };
    std::vector<std::int32_t> rows(kComponents * NeighbourRows::scratchSize(image.grid / 2 + 1));
    CoefficientModels models;
    RangeEncoder encoder;
    CostAwarePick pick(image, exactStep);
    codeImage(encoder, models, quantized, pick, isEmpty, rows.data());
    return {encoder.finish(), pick.shifts()};
}

} // namespace gimg::codec

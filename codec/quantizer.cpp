#include "quantizer.h"

namespace gimg::codec {

namespace {

// Puts the coarse image (m x m) and the three bands of its level where lifting wants them.
void interleave(const double* coarse, std::uint32_t m, const std::int32_t* plane, std::size_t planePitch,
                const Dequantizer& dequantize, double* out)
{
    const std::size_t size = 2 * std::size_t{m} - 1;
    for (std::uint32_t j = 0; j < size; ++j) {
        double* line = out + j * size;
        const std::int32_t* coded = plane + (j % 2 == 0 ? j / 2 : m + j / 2) * planePitch;
        if (j % 2 == 0) {
            const double* coarseLine = coarse + j / 2 * std::size_t{m};
            for (std::uint32_t i = 0; i < m; ++i) line[2 * i] = coarseLine[i] * kInverseAreaScale;
            for (std::uint32_t i = 0; i + 1 < m; ++i) line[2 * i + 1] = dequantize(coded[m + i]);
        } else {
            for (std::uint32_t i = 0; i < m; ++i) line[2 * i] = dequantize(coded[i]);
            for (std::uint32_t i = 0; i + 1 < m; ++i) line[2 * i + 1] = dequantize(coded[m + i]) * kAreaScale;
        }
    }
}

} // namespace

void reconstructComponent(const QuantizedImage& image, unsigned component, const Dequantizer& dequantize,
                          double* workA, double* workB)
{
    unsigned levels = 0;
    for (std::uint32_t m = kCoarsest; m < image.grid; m = 2 * m - 1) ++levels;
    // The levels alternate between the two buffers so that the last one ends in workA.
    double* from = levels % 2 == 0 ? workA : workB;
    double* to = levels % 2 == 0 ? workB : workA;
    for (unsigned k = 0; k < kCoarsest * kCoarsest; ++k)
        from[k] = static_cast<double>(image.coarse[component][k]) * dequantize.step;
    for (std::uint32_t m = kCoarsest; m < image.grid; m = 2 * m - 1) {
        interleave(from, m, image.detail[component], image.grid, dequantize, to);
        inverseLifting(to, 2 * m - 1);
        double* finished = to;
        to = from;
        from = finished;
    }
}

} // namespace gimg::codec

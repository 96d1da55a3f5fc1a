#include "lifting.h"

namespace gimg::codec {

namespace {

// All odd (first = 1) or even (0) samples of all rows, then of all columns.
void step(double* image, std::uint32_t size, std::uint32_t first, double factor)
{
    liftRows(image, size, first, factor);
    for (std::uint32_t j = 0; j < size; ++j) {
        double* line = image + j * std::size_t{size};
        if (first == 0)
            liftEven(line, size, factor);
        else
            liftOdd(line, size, factor);
    }
}

} // namespace

void inverseLifting(double* image, std::uint32_t size, const GluedBorder* border, double* work)
{
    step(image, size, 0, -kDelta);
    if (border != nullptr) border->average(image, size, work);
    step(image, size, 1, -kGamma);
    step(image, size, 0, -kBeta);
    if (border != nullptr) border->average(image, size, work);
    step(image, size, 1, -kAlpha);
}

void inverseLiftingOfCoarse(const double* coarse, double factor, double* image, std::uint32_t size,
                            const GluedBorder* border, double* work)
{
    // The first step adds nothing.
    const std::size_t pitch = size, m = size / 2 + 1;
    for (std::uint32_t j = 0; j < size; j += 2) {
        double* line = image + j * pitch;
        const double* from = coarse + j / 2 * m;
        for (std::uint32_t i = 0; i + 1 < m; ++i) {
            line[2 * i] = from[i] * factor;
            line[2 * i + 1] = 0;
        }
        line[size - 1] = from[m - 1] * factor;
    }
    if (border != nullptr) {
        for (std::uint32_t j = 1; j < size; j += 2) image[j * pitch] = image[j * pitch + size - 1] = 0;
        border->average(image, size, work);
    }
    for (std::uint32_t j = 1; j < size; j += 2) {
        double* line = image + j * pitch;
        const double *above = line - pitch, *below = line + pitch;
        for (std::uint32_t i = 0; i < size; ++i) line[i] = 0.0 - kGamma * (above[i] + below[i]);
    }
    for (std::uint32_t j = 0; j < size; ++j) liftOdd(image + j * pitch, size, -kGamma);
    step(image, size, 0, -kBeta);
    if (border != nullptr) border->average(image, size, work);
    step(image, size, 1, -kAlpha);
}

void forwardLifting(double* image, std::uint32_t size, const GluedBorder* border, double* work)
{
    step(image, size, 1, kAlpha);
    step(image, size, 0, kBeta);
    if (border != nullptr) border->average(image, size, work);
    step(image, size, 1, kGamma);
    step(image, size, 0, kDelta);
    if (border != nullptr) border->average(image, size, work);
}

} // namespace gimg::codec

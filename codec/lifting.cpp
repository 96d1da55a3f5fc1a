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

#include "wavelet.h"

namespace gimg::codec {

void inverseLifting(double* image, std::uint32_t size)
{
    liftRows(image, size, 0, -kDelta);
    liftRows(image, size, 1, -kGamma);
    liftRows(image, size, 0, -kBeta);
    liftRows(image, size, 1, -kAlpha);
    for (std::uint32_t j = 0; j < size; ++j) {
        double* line = image + j * std::size_t{size};
        liftEven(line, size, -kDelta);
        liftOdd(line, size, -kGamma);
        liftEven(line, size, -kBeta);
        liftOdd(line, size, -kAlpha);
    }
}

} // namespace gimg::codec

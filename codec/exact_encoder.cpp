#include "exact_encoder.h"

#include "range_encoder.h"

#include <algorithm>

namespace gimg::codec {

std::vector<std::uint8_t> encodeExact(std::span<const float> samples, const ExactFormat& format,
                                      std::span<const std::uint32_t> classes)
{
    std::vector<float> closed(samples.begin(), samples.end());
    const auto at = [&](std::uint32_t position) {
        return closed.begin() + std::ptrdiff_t{borderSample(format.grid, position)} * format.channels;
    };
    for (std::uint32_t k = 0; k < classes.size(); ++k)
        if (classes[k] != k) std::copy_n(at(classes[k]), format.channels, at(k));

    std::vector<unsigned char> memory(ExactWork::size(format) + Arena::kAlignment);
    Arena arena(memory.data(), memory.size());
    ExactWork work;
    const std::uint32_t* glued = classes.empty() ? nullptr : classes.data();
    work.take(arena, format, glued);
    RangeEncoder encoder;
    codeExact(encoder, work, format, glued, closed.data());
    return encoder.finish();
}

} // namespace gimg::codec

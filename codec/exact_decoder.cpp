#include "exact_decoder.h"

#include "range_decoder.h"

#include <new>

namespace gimg::codec {

using format::ReadStatus;

namespace {

std::size_t samplesOf(const ExactFormat& format)
{
    return std::size_t{format.grid} * format.grid * format.channels;
}

} // namespace

std::uint64_t ExactWork::size(const ExactFormat& format)
{
    return Arena::sizeOf<std::uint16_t>(samplesOf(format)) + Arena::sizeOf<LinearFit>(3 * format.channels) +
           Arena::sizeOf<ExactModels>(1) + Arena::sizeOf<std::uint32_t>(borderSize(format.grid));
}

bool ExactWork::take(Arena& arena, const ExactFormat& format, const std::uint32_t* classes)
{
    const std::uint32_t border = borderSize(format.grid);
    sizes = arena.take<std::uint16_t>(samplesOf(format));
    fits = arena.take<LinearFit>(3 * std::size_t{format.channels});
    models = arena.take<ExactModels>(1);
    next = arena.take<std::uint32_t>(border);
    if (sizes == nullptr || fits == nullptr || models == nullptr || next == nullptr) return false;
    for (unsigned k = 0; k < 3 * format.channels; ++k) new (fits + k) LinearFit();
    new (models) ExactModels();
    if (classes == nullptr) return true;
    for (std::uint32_t k = 0; k < border; ++k) {
        next[k] = k;
        const std::uint32_t first = classes[k];
        if (first == k) continue;
        next[k] = next[first];
        next[first] = k;
    }
    return true;
}

std::uint64_t exactWorkspace(const ExactFormat& format) { return ExactWork::size(format); }

format::ReadStatus decodeExact(format::ByteSpan bytes, const ExactFormat& format,
                               const std::uint32_t* classes, Arena& arena, float* out)
{
    ExactWork work;
    if (!work.take(arena, format, classes)) return ReadStatus::Misuse;
    RangeDecoder decoder(bytes);
    codeExact(decoder, work, format, classes, out);
    return decoder.finished() ? ReadStatus::Ok : format::ReadStatus::Corrupt;
}

} // namespace gimg::codec

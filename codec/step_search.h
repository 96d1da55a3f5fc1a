#pragma once

#include "encode.h"
#include "format/writer.h"
#include "quantizer.h"

#include <algorithm>
#include <cmath>

namespace gimg::codec {

/// Steps finer than this part of the diagonal spend bytes on the noise of float32 samples.
constexpr double kFinestPart = 0x1p-21;
constexpr double kLargestCoefficient = static_cast<double>(kLargestStep) / 4;

struct Candidate
{
    std::vector<std::uint8_t> content;
    float step = 0;
};

/// @param Image  TransformedImage, TransformedSurface or TransformedField
template <class Image> std::string stepFault(const Image& image, float step, const char* name)
{
    if (image.largest > kLargestCoefficient) return "the samples are too large for wavelet coding";
    if (!(step > 0) || step > kLargestStep) return std::string(name) + " is not a positive number in range";
    if (step < smallestStep(image)) return std::string(name) + " is too small for these samples";
    return {};
}

struct StepRange
{
    float finest = 0, coarsest = 0;
};

template <class Image> StepRange sensibleSteps(const Image& image)
{
    const float least = smallestStep(image);
    const float finest = std::max(least, static_cast<float>(image.diagonal * kFinestPart));
    // A step twice as large as any coefficient leaves nothing to code.
    const float coarsest = std::clamp(static_cast<float>(2.1 * image.largest), finest, kLargestStep);
    return {finest, coarsest};
}

/// The finest coding whose chunk takes at most `target` bytes, found by closing in on the step.
/// @param contentAt  the chunk's content for a step
/// Size falls nearly linearly with the logarithm of the step over small ranges, so secants are tried
/// first, and halving where they are slow.
template <class Image, class ContentAt>
std::variant<Candidate, EncodeError> searchStep(const Image& image, const ContentAt& contentAt,
                                                std::size_t target)
{
    const auto attempt = [&](float step) { return Candidate{contentAt(step), step}; };
    const auto sizeOf = [](const Candidate& candidate) {
        return format::chunkSize(candidate.content.size());
    };
    const StepRange range = sensibleSteps(image);
    if (image.largest > kLargestCoefficient)
        return EncodeError{EncodeError::Kind::BadSettings, "the samples are too large for wavelet coding", 0};

    Candidate best = attempt(range.coarsest);
    std::size_t bestSize = sizeOf(best);
    if (bestSize > target) return EncodeError{EncodeError::Kind::TooSmall, {}, bestSize};

    // Halve from a likely step until the target is bracketed: `high` is too many bytes, `low` is not.
    double lowStep = std::log2(static_cast<double>(range.coarsest)), highStep = 0;
    std::size_t lowSize = bestSize, highSize = 0;
    double guess = std::log2(static_cast<double>(range.coarsest)) - 4;
    const double floor = std::log2(static_cast<double>(range.finest));
    for (double stride = 2; highSize == 0;) {
        const bool atFloor = guess <= floor;
        Candidate candidate = attempt(atFloor ? range.finest : static_cast<float>(std::exp2(guess)));
        const std::size_t size = sizeOf(candidate);
        if (size > target) {
            highStep = std::log2(static_cast<double>(candidate.step));
            highSize = size;
            break;
        }
        lowStep = std::log2(static_cast<double>(candidate.step));
        lowSize = size;
        best = std::move(candidate);
        bestSize = size;
        if (atFloor) return EncodeError{EncodeError::Kind::TooLarge, {}, size};
        guess -= stride;
    }

    const std::size_t close = target / 1000 + 1;
    for (int round = 0; round < 40 && target - bestSize > close; ++round) {
        double part = 0.5;
        if (round % 3 != 2) {
            const double wanted = static_cast<double>(target) - 0.4 * static_cast<double>(close);
            // In logarithms of the sizes the curve is straighter still.
            part = (std::log(wanted) - std::log(static_cast<double>(lowSize))) /
                   (std::log(static_cast<double>(highSize)) - std::log(static_cast<double>(lowSize)));
            part = std::clamp(part, 0.02, 0.98);
        }
        const auto step = static_cast<float>(std::exp2(lowStep + part * (highStep - lowStep)));
        Candidate candidate = attempt(step);
        const double exactStep = std::log2(static_cast<double>(step));
        if (exactStep >= lowStep || exactStep <= highStep) break;
        const std::size_t size = sizeOf(candidate);
        if (size > target) {
            highStep = exactStep;
            highSize = size;
            continue;
        }
        lowStep = exactStep;
        lowSize = size;
        if (size >= bestSize) {
            best = std::move(candidate);
            bestSize = size;
        }
    }
    return best;
}

} // namespace gimg::codec

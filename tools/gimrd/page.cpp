#include "page.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_easy_font.h>
#pragma GCC diagnostic pop

namespace gimg::gimrd {

namespace {

constexpr int kTextScale = 2;               // pixels a dot of the font
constexpr size_t kBytesPerCharacter = 1024; // of the font's output; it needs 270 on average

/// What the font gives four of for each rectangle.
struct Corner
{
    float x, y, z;
    unsigned char color[4];
};

} // namespace

Page::Page(int width, int height)
    : image_{width, height,
             std::vector<uint8_t>(3 * static_cast<size_t>(width) * static_cast<size_t>(height), 255)}
{
}

void Page::fill(int left, int top, int width, int height, const Color& color)
{
    for (int y = std::max(top, 0); y < std::min(top + height, image_.height); ++y)
        for (int x = std::max(left, 0); x < std::min(left + width, image_.width); ++x)
            std::copy(color.begin(), color.end(),
                      &image_.samples[3 * (static_cast<size_t>(y) * static_cast<size_t>(image_.width) +
                                           static_cast<size_t>(x))]);
}

void Page::paste(const RgbImage& image, int left, int top)
{
    const uint8_t* p = image.samples.data();
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x, p += 3) fill(left + x, top + y, 1, 1, {p[0], p[1], p[2]});
}

void Page::text(int center, int top, const std::string& line)
{
    std::string copy = line; // the font takes char*, and changes nothing
    std::vector<Corner> corners(copy.size() * kBytesPerCharacter / sizeof(Corner));
    const int left = center - kTextScale * stb_easy_font_width(copy.data()) / 2;
    const int quads = stb_easy_font_print(0, 0, copy.data(), nullptr, corners.data(),
                                          static_cast<int>(corners.size() * sizeof(Corner)));
    const auto dots = [](float x) { return kTextScale * static_cast<int>(std::lround(x)); };
    for (int i = 0; i < quads; ++i) {
        const Corner &from = corners[4 * static_cast<size_t>(i)],
                     &to = corners[4 * static_cast<size_t>(i) + 2];
        fill(left + dots(from.x), top + dots(from.y), dots(to.x) - dots(from.x), dots(to.y) - dots(from.y),
             kInk);
    }
}

} // namespace gimg::gimrd

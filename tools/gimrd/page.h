#pragma once

#include "gimg/color.h"
#include "gimg/image_io.h"

#include <string>

namespace gimg::gimrd {

inline constexpr Color kInk{60, 60, 60};

/// A white page to put pictures and words on. What lies outside the page is cut off.
class Page
{
public:
    Page(int width, int height);

    void fill(int left, int top, int width, int height, const Color& color);
    void paste(const RgbImage& image, int left, int top);
    /// One line of ASCII, its middle at `center`, 14 pixels high from `top`.
    void text(int center, int top, const std::string& line);

    const RgbImage& image() const { return image_; }

private:
    RgbImage image_;
};

} // namespace gimg::gimrd

#include "gimg/corner_map.h"

#include <cmath>
#include <memory>

namespace gimg {
namespace {

constexpr std::array<Color, 2> kSand = {Color{205, 160, 84}, Color{250, 241, 222}};
constexpr Color kMark = {206, 24, 30};

bool isMarked(const Checkerboard& board, const Vec3& point)
{
    for (const Vec3& mark : board.marks)
        if ((point - mark).squaredNorm() < board.markRadius * board.markRadius) return true;
    return false;
}

const std::array<Color, 2>& pairOf(const Checkerboard& board, int face)
{
    if (board.colors.empty()) return kSand;
    const size_t part = board.part.empty() ? 0 : static_cast<size_t>(board.part[face]);
    return board.colors[part % board.colors.size()];
}

} // namespace

std::function<Color(int face, const Vec3& barycentric, const Vec3& point)>
checkerboardColor(CornerMap map, Checkerboard board)
{
    struct Kept
    {
        CornerMap map;
        Checkerboard board;
    };
    const auto kept = std::make_shared<const Kept>(Kept{std::move(map), std::move(board)});
    return [kept](int face, const Vec3& barycentric, const Vec3& point) {
        if (isMarked(kept->board, point)) return kMark;
        Vec2 uv = Vec2::Zero();
        for (int k = 0; k < 3; ++k) uv += barycentric[k] * kept->map.at(face, k);
        // Parity of floating-point floors: maps may be larger than integers are.
        const Vec2 field = (uv / kept->board.side).array().floor();
        const bool odd = std::fmod(std::abs(field[0] + field[1]), 2) == 1;
        return pairOf(kept->board, face)[odd ? 1 : 0];
    };
}

} // namespace gimg

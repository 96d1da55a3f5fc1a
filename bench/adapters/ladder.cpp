#include "ladder.h"

#include <cmath>

namespace gimg::adapter {

Mesh referenced(const Mesh& mesh)
{
    Mesh compact;
    std::vector<int> number(mesh.positions.size(), -1);
    for (Triangle face : mesh.faces) {
        for (int& v : face) {
            if (number[v] < 0) {
                number[v] = compact.vertexCount();
                compact.positions.push_back(mesh.positions[v]);
            }
            v = number[v];
        }
        compact.faces.push_back(face);
    }
    return compact;
}

std::vector<std::size_t> rungCounts(std::size_t most)
{
    std::vector<std::size_t> counts;
    for (auto count = static_cast<double>(most); count >= kFewestTriangles; count *= Ladder::kRungRatio) {
        const auto whole = static_cast<std::size_t>(count);
        if (counts.empty() || whole < counts.back()) counts.push_back(whole);
    }
    return counts;
}

std::vector<std::size_t> countsBetween(std::size_t more, std::size_t fewer)
{
    std::vector<std::size_t> counts;
    const double step =
        (static_cast<double>(more) - static_cast<double>(fewer)) / (Ladder::kStepsBetween + 1);
    for (int i = 1; i <= Ladder::kStepsBetween && step > 0; ++i) {
        const auto count = static_cast<std::size_t>(std::lround(static_cast<double>(more) - i * step));
        if (count < (counts.empty() ? more : counts.back()) && count > fewer) counts.push_back(count);
    }
    return counts;
}

} // namespace gimg::adapter

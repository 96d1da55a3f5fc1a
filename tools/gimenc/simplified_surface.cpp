#include "simplified_surface.h"

#include <algorithm>
#include <cstdio>

namespace gimg::gimenc {
namespace {

// "loops 0.012 to 0.34 long (0.5 % to 14 % of the diagonal)"
template <class Loop> std::string lengths(const std::vector<Loop>& loops)
{
    const auto [low, high] = std::minmax_element(
        loops.begin(), loops.end(), [](const Loop& a, const Loop& b) { return a.length < b.length; });
    char text[160];
    if (loops.size() == 1)
        std::snprintf(text, sizeof text, "loop %.3g long (%.2g %% of the diagonal)", low->length,
                      100 * low->fraction);
    else
        std::snprintf(text, sizeof text, "loops %.3g to %.3g long (%.2g %% to %.2g %% of the diagonal)",
                      low->length, high->length, 100 * low->fraction, 100 * high->fraction);
    return text;
}

std::string counted(size_t count, const char* one, const char* many)
{
    return std::to_string(count) + ' ' + (count == 1 ? one : many);
}

Status close(const MeshLength& longest, SimplifiedSurface& surface)
{
    Result<HoleClosing> closing = closeHoles(surface.mesh, longest.of(boundingBoxDiagonal(surface.mesh)));
    if (!closing) return closing.error();
    surface.mesh = std::move(closing->mesh);
    surface.holes = std::move(closing->holes);
    if (surface.holes.empty()) return Done{};
    const auto cracks = static_cast<size_t>(std::count_if(surface.holes.begin(), surface.holes.end(),
                                                          [](const ClosedHole& h) { return h.zipped > 0; }));
    surface.notes.push_back(counted(surface.holes.size(), "hole closed", "holes closed") + ", " +
                            counted(cracks, "of them a crack", "of them cracks") + ": " +
                            lengths(surface.holes));
    return Done{};
}

Status cut(const HandleOptions& options, SimplifiedSurface& surface)
{
    Result<HandleRemoval> removal = removeHandles(surface.mesh, options);
    if (!removal) return removal.error();
    surface.handles = std::move(removal->handles);
    if (surface.handles.empty()) return Done{};
    const int before = topology(surface.mesh).genus;
    surface.mesh = std::move(removal->mesh);
    surface.notes.push_back(counted(surface.handles.size(), "handle", "handles") + " removed, genus " +
                            std::to_string(before) + " became " +
                            std::to_string(before - static_cast<int>(surface.handles.size())) + ": " +
                            lengths(surface.handles));
    return Done{};
}

} // namespace

bool asksForSimplifying(const Arguments& a) { return a.closeHoles || a.maxGenus || a.removeNoise; }

Result<SimplifiedSurface> simplifiedSurface(const Mesh& mesh, const Arguments& a)
{
    SimplifiedSurface surface;
    surface.mesh = mesh;
    HandleOptions handles;
    if (a.maxGenus) handles.maxGenus = *a.maxGenus;
    if (a.removeNoise) handles.maxLength = kNoiseHandle * boundingBoxDiagonal(mesh);
    if (a.closeHoles)
        if (const Status done = close(*a.closeHoles, surface); !done) return done.error();
    if (a.maxGenus || a.removeNoise)
        if (const Status done = cut(handles, surface); !done) return done.error();
    return surface;
}

} // namespace gimg::gimenc

#include "gimg/unfold.h"

#include "gimg/extrema.h"
#include "gimg/stretch.h"

#include <algorithm>
#include <span>

namespace gimg {
namespace {

constexpr double kSure = 0.5; // of the energy: below, the extended cut is taken without trying the other

Result<Unfolded> unfoldAlong(const Mesh& mesh, std::span<const int> extrema, const BorderOptions& options,
                             MapKind kind, const UnfoldProgress& progress)
{
    CutGraph cut = cutToDisk(mesh, extrema);
    Result<SquareDisk> square = layOutBorder(mesh, cut, options);
    if (!square) return square.error();
    Result<Parameterization> map = mapToSquare(*square, kind, [&](double fraction) {
        if (progress) progress("parameterize", fraction);
    });
    if (!map) return map.error();
    return Unfolded{std::move(cut), static_cast<int>(extrema.size()), std::move(*square), std::move(*map)};
}

} // namespace

Result<Unfolded> unfold(const Mesh& mesh, const BorderOptions& options, const UnfoldJudge& judge,
                        const UnfoldProgress& progress, MapKind kind)
{
    const Extrema extrema = findExtrema(mesh, {}, [&](double fraction) {
        if (progress) progress("cut", fraction);
    });
    if (extrema.vertices.empty()) return unfoldAlong(mesh, {}, options, kind, progress);
    Result<Unfolded> extended = unfoldAlong(mesh, extrema.vertices, options, kind, progress);
    if (extended && extrema.energyWith < kSure * extrema.energyWithout) return extended;
    Result<Unfolded> plain = unfoldAlong(mesh, {}, options, kind, progress);
    if (!extended) return plain;
    if (!plain) return extended;
    const auto quality = [&](const Unfolded& unfolded) {
        return judge ? judge(unfolded) : -quarticStretchEnergy(unfolded.square.disk.mesh, unfolded.map.st);
    };
    return quality(*extended) >= quality(*plain) ? std::move(extended) : std::move(plain);
}

} // namespace gimg

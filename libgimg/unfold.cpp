#include "gimg/unfold.h"

#include "gimg/decode.h"
#include "gimg/distance.h"
#include "gimg/extrema.h"
#include "gimg/sample.h"

#include <algorithm>
#include <span>

namespace gimg {
namespace {

constexpr double kSure = 0.5; // of the energy: below, the extended cut is taken without trying the other

Result<Unfolded> unfoldAlong(const Mesh& mesh, std::span<const int> extrema, const BorderOptions& options,
                             const UnfoldProgress& progress)
{
    CutGraph cut = cutToDisk(mesh, extrema);
    Result<SquareDisk> square = layOutBorder(mesh, cut, options);
    if (!square) return square.error();
    Result<Parameterization> map = flattenToSquare(*square, [&](double fraction) {
        if (progress) progress("parameterize", fraction);
    });
    if (!map) return map.error();
    return Unfolded{std::move(cut), static_cast<int>(extrema.size()), std::move(*square), std::move(*map)};
}

// How near the sampled grid comes to the surface, with its border open. -1 if it cannot be told.
double gridPsnr(const SurfaceMeasure& surface, const Unfolded& unfolded)
{
    const int n = unfolded.square.grid;
    const Result<FloatImage> image = sampleGeometry(unfolded.square, unfolded.map, n);
    if (!image) return -1;
    const Result<SurfaceDistance> distance = surface.against(gridMesh(*image));
    return distance ? distance->psnr() : -1;
}

} // namespace

Result<Unfolded> unfold(const Mesh& mesh, const BorderOptions& options, const UnfoldProgress& progress)
{
    const Extrema extrema = findExtrema(mesh, {}, [&](double fraction) {
        if (progress) progress("cut", fraction);
    });
    if (extrema.vertices.empty()) return unfoldAlong(mesh, {}, options, progress);
    Result<Unfolded> extended = unfoldAlong(mesh, extrema.vertices, options, progress);
    if (extended && extrema.energyWith < kSure * extrema.energyWithout) return extended;
    Result<Unfolded> plain = unfoldAlong(mesh, {}, options, progress);
    if (!extended) return plain;
    if (!plain) return extended;
    constexpr int kSamples = 50000;
    const SurfaceMeasure surface(mesh, {kSamples});
    return gridPsnr(surface, *extended) >= gridPsnr(surface, *plain) ? std::move(extended) : std::move(plain);
}

} // namespace gimg

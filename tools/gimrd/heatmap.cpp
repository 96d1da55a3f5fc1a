#include "heatmap.h"

#include "page.h"

#include "gimg/mesh_io.h"
#include "gimg/nearest.h"
#include "gimg/render.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>

namespace gimg::gimrd {

namespace {

constexpr int kPanel = 440; // pixels a side
constexpr int kGap = 20;
constexpr int kBarWidth = 440, kBarHeight = 16;
constexpr int kTicks = 4; // intervals of the colour bar
constexpr int kCaption = 36;
constexpr double kShade = 0.35; // enough to tell the shape, and colours stay near those of the bar

Color colorOf(double distance, double top)
{
    if (top > 0) return heatColor(distance / top);
    return heatColor(distance > 0 ? 1 : 0);
}

/// `mesh`, each point coloured by its distance to `other`.
Result<RgbImage> panel(const Mesh& mesh, const Mesh& other, const Camera& camera, const Heatmap& heatmap)
{
    const Result<NearestSurface> surface = NearestSurface::of(other);
    if (!surface) return surface.error();
    RenderOptions options;
    options.width = options.height = kPanel;
    options.camera = camera;
    options.shade = kShade;
    options.supersampling = 2;
    options.threads = heatmap.threads;
    options.inside.reset();
    options.color = [&surface, &heatmap](int, const Vec3&, const Vec3& point) {
        thread_local int near = 0; // of the pixel before; any face will do
        const NearestPoint nearest = surface->to(point, near);
        near = nearest.face;
        return colorOf(nearest.distance, heatmap.top);
    };
    return render(mesh, options);
}

void drawColorBar(Page& page, int left, int top, const Heatmap& heatmap)
{
    for (int x = 0; x < kBarWidth; ++x)
        page.fill(left + x, top, 1, kBarHeight, heatColor((x + 0.5) / kBarWidth));
    for (int i = 0; i <= kTicks; ++i) {
        const int x = left + (kBarWidth - 1) * i / kTicks;
        page.fill(x, top + kBarHeight, 1, 5, kInk);
        char label[32];
        std::snprintf(label, sizeof label, "%.3g%%", 100 * heatmap.top / heatmap.diagonal * i / kTicks);
        page.text(x, top + kBarHeight + 8, i == 0 ? "0" : label);
    }
    page.text(left + kBarWidth / 2, top + kBarHeight + 28, "distance, % of the reference's diagonal");
}

Status writePicture(const Mesh& reference, const Mesh& test, const Heatmap& heatmap)
{
    const Result<Camera> camera = cameraFor(reference);
    if (!camera) return camera.error();
    const Result<RgbImage> left = panel(reference, test, *camera, heatmap);
    if (!left) return left.error();
    const Result<RgbImage> right = panel(test, reference, *camera, heatmap);
    if (!right) return right.error();
    const int width = 2 * kPanel + kGap;
    Page page(width, kPanel + kCaption + kBarHeight + 52);
    page.paste(*left, 0, 0);
    page.paste(*right, kPanel + kGap, 0);
    page.text(kPanel / 2, kPanel + 4, "reference: distance to test");
    page.text(kPanel + kGap + kPanel / 2, kPanel + 4, "test: distance to reference");
    drawColorBar(page, (width - kBarWidth) / 2, kPanel + kCaption, heatmap);
    return writePng(page.image(), heatmap.path);
}

Status writeColors(const Mesh& reference, const Mesh& test, const Heatmap& heatmap)
{
    const Result<NearestSurface> surface = NearestSurface::of(reference);
    if (!surface) return surface.error();
    const std::vector<double> distances = surface->distances(test.positions, heatmap.threads);
    std::vector<Color> colors;
    for (double distance : distances) colors.push_back(colorOf(distance, heatmap.top));
    return writeColoredPly(test, heatmap.path, colors, distances);
}

} // namespace

std::optional<HeatmapFormat> heatmapFormat(const std::string& path)
{
    std::string extension = std::filesystem::path(path).extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (extension == ".ply") return HeatmapFormat::Ply;
    if (extension == ".png") return HeatmapFormat::Png;
    return std::nullopt;
}

Status writeHeatmap(const Mesh& reference, const Mesh& test, const Heatmap& heatmap)
{
    return heatmapFormat(heatmap.path) == HeatmapFormat::Ply ? writeColors(reference, test, heatmap)
                                                             : writePicture(reference, test, heatmap);
}

} // namespace gimg::gimrd

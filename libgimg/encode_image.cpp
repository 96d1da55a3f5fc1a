#include "gimg/image_seam.h"

#include "codec/seam.h"
#include "gimg/decode.h"
#include "prepared.h"
#include "stopwatch.h"

namespace gimg {
namespace {

// Area-weighted normals of the grid's triangles, bilinear between samples.
FloatImage normalsOf(const Mesh& mesh, const GluedGrid& grid, int n)
{
    const std::vector<Vec3> normal = vertexNormals(mesh);
    const int last = grid.side() - 1;
    const auto at = [&](int i, int j) { return normal[grid.vertexOf(j * grid.side() + i)]; };
    FloatImage out{n, n, {}};
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const double x = static_cast<double>(i) * last / (n - 1),
                         y = static_cast<double>(j) * last / (n - 1);
            const int left = std::min(static_cast<int>(x), last - 1),
                      low = std::min(static_cast<int>(y), last - 1);
            const double u = x - left, v = y - low;
            Vec3 mean = (1 - v) * ((1 - u) * at(left, low) + u * at(left + 1, low)) +
                        v * ((1 - u) * at(left, low + 1) + u * at(left + 1, low + 1));
            if (!(mean.norm() > 0)) mean = Vec3::UnitZ();
            for (const double c : mean.normalized()) out.samples.push_back(static_cast<float>(c));
        }
    return out;
}

FoundSeam reportOf(const ImageSeam& seam)
{
    const codec::Seam word{static_cast<uint32_t>(seam.seam.lowest), static_cast<uint32_t>(seam.seam.start),
                           seam.seam.sides};
    const codec::SeamTopology topology = codec::topologyOf(word);
    FoundSeam out;
    out.sides = static_cast<int>(seam.seam.sides.size());
    out.paths = static_cast<int>(topology.paths);
    out.nodes = static_cast<int>(topology.cutNodes);
    out.steps = seam.steps;
    out.glued = seam.glued;
    out.widestGap = seam.widestGap;
    out.objection = seam.objection;
    return out;
}

// What to say where the border, or a part of it, stays open that perhaps should not.
std::string openBorderWarning(const ImageSeam& seam, double tolerance)
{
    char text[200];
    if (!seam.objection.empty())
        return "no seam was found: " + seam.objection + "; the border is coded as open";
    if (seam.glued == 0) {
        std::snprintf(text, sizeof text,
                      "no border samples coincide within %g of the diagonal: the border is coded as open",
                      tolerance);
        return text;
    }
    if (seam.slits == 0) return {};
    std::snprintf(text, sizeof text,
                  "%d slits are open within what is glued, up to %.2g of the diagonal wide: --tolerance %.2g "
                  "would close them",
                  seam.slits, seam.widestSlit, 1.1 * seam.widestSlit);
    return text;
}

} // namespace

Result<MeshEncoder> MeshEncoder::prepareImage(const FloatImage& image, const EncodeOptions& options,
                                              double tolerance)
{
    if (const std::optional<Error> error = objectionTo(options)) return *error;
    if (options.grid != 0 && options.grid != image.width)
        return Error{ErrorKind::BadArgument, "a geometry image is coded at its own grid"};
    const ThreadLimit limit(options.threads);
    if (options.progress) options.progress("seam", 0);
    Stopwatch watch;
    Result<ImageSeam> found = findImageSeam(image, {tolerance, options.lowest});
    if (!found) return found.error();
    const Mesh open = gridMesh(image);
    EncodedMesh out;
    if (const Status scale = checkScale(open, out.warnings); !scale) return scale.error();
    const Result<GluedGrid> grid = GluedGrid::of(found->seam, image.width);
    if (!grid) return grid.error();
    const auto glued = std::make_shared<const Mesh>(meshOf(*grid, found->image));
    if (std::string what = openBorderWarning(*found, tolerance); !what.empty())
        out.warnings.push_back(std::move(what));
    out.topology = topology(*glued);
    out.grid = image.width;
    out.lowest = found->seam.lowest;
    out.normals = options.normals;
    out.image = reportOf(*found);
    out.cutPaths = out.image->paths;
    out.cutNodes = out.image->nodes;
    out.seconds.cut = watch.lap();

    GridSource source;
    source.surface = glued;
    source.seam = found->seam;
    source.refits = true;
    source.smoothLevels = options.smoothLevels;
    source.sample = [samples = std::move(found->image)](int n) -> Result<FloatImage> {
        if (n == samples.width) return samples;
        return Error{ErrorKind::BadArgument, "a geometry image is coded at its own grid"};
    };
    if (options.normals != 0) source.normals = normalsOf(*glued, *grid, options.normals);
    out.seconds.sample = watch.lap();
    SurfaceMeasure measure(options.reference ? *options.reference : open);
    out.seconds.code = watch.lap();
    return MeshEncoder(std::make_unique<const Prepared>(Prepared{
        std::move(out), false, false, Effort::of(options), std::make_unique<GridEncoders>(std::move(source)),
        std::move(measure), options.progress, options.threads}));
}

Result<EncodedMesh> encodeImage(const FloatImage& image, const EncodeOptions& options, double tolerance)
{
    const Result<MeshEncoder> encoder = MeshEncoder::prepareImage(image, options, tolerance);
    if (!encoder) return encoder.error();
    return encoder->encode(options);
}

} // namespace gimg

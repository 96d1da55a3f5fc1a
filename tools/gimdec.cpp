// gimdec: a .gim file becomes a mesh, and pictures of its images.
#include "cli.h"

#include "gimg/decode.h"
#include "gimg/image_io.h"
#include "gimg/mesh_io.h"

#include <CLI/App.hpp>
#include <nlohmann/json.hpp>

#include <chrono>
#include <iostream>

namespace {

using namespace gimg;

struct Arguments
{
    std::string input, output, image, normalMap, json;
    unsigned level = 0;
    bool noFuse = false, noDiffuse = false, whole = false;

    unsigned flags() const
    {
        return (noFuse ? GIM_NO_FUSE : 0u) | (noDiffuse ? GIM_NO_DIFFUSE : 0u) | (whole ? 0u : GIM_PREFIX);
    }
};

std::optional<int> parseArguments(int argc, char** argv, Arguments& a)
{
    CLI::App app{"Decodes a .gim geometry image file to a triangle mesh.", "gimdec"};
    app.footer("Exit codes: 0 done, 1 input refused, 2 usage, 3 target not reachable.");
    app.set_version_flag("--version", GIMG_VERSION);
    app.add_option("INPUT", a.input, "file to decode, .gim")->required();
    app.add_option("OUTPUT", a.output, "mesh to write: .ply, .obj, .off or .stl")->required();
    app.add_option("--level", a.level,
                   "level of detail: 0 (default) is the finest, each further one has half the grid");
    app.add_flag("--no-fuse", a.noFuse, "leave the seam open, as it was coded: shows the cracks");
    app.add_flag("--no-diffuse", a.noDiffuse, "fuse the seam without spreading the error: shows the steps");
    app.add_flag("--whole", a.whole,
                 "refuse a file that is cut short; without, it gives a coarser surface and a warning");
    app.add_option("--image", a.image,
                   "also write the geometry image: .png (16 bits a channel) or .exr (exact)");
    app.add_option("--normal-map", a.normalMap, "also write the normal image, .png");
    app.add_option("--json", a.json, "write a report to this file, or - for standard output");
    return cli::parse(app, argc, argv);
}

int refuse(const std::string& message) { return cli::fail("gimdec", cli::Refused, message); }

bool endsWith(const std::string& text, const std::string& end)
{
    return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// The normal of each vertex, where the normal image has a sample at it: if it is at least as fine as the
// mesh.
std::vector<Vec3> vertexNormals(const std::vector<uint8_t>& file, const DecodedImages& images, unsigned level,
                                unsigned flags)
{
    const uint32_t grid = images.info.grid, normalGrid = images.info.normal_grid;
    if (normalGrid == 0 || normalGrid - 1 < (grid - 1) >> level) return {};
    std::vector<unsigned char> work(gim_workspace_size(&images.info));
    gim_mesh_counts counts{sizeof counts, 0, 0, 0};
    if (gim_mesh_size(file.data(), file.size(), nullptr, flags, level, work.data(), work.size(), &counts) !=
        GIM_OK)
        return {};
    std::vector<uint32_t> samples(counts.vertices);
    if (gim_build_mesh(file.data(), file.size(), nullptr, flags, level, work.data(), work.size(), nullptr,
                       nullptr, samples.data(), nullptr) != GIM_OK)
        return {};
    std::vector<Vec3> normals;
    normals.reserve(samples.size());
    for (const uint32_t sample : samples) {
        const uint64_t i = uint64_t{sample % grid} * (normalGrid - 1) / (grid - 1);
        const uint64_t j = uint64_t{sample / grid} * (normalGrid - 1) / (grid - 1);
        const float* n = &images.normals.samples[3 * (j * normalGrid + i)];
        normals.emplace_back(n[0], n[1], n[2]);
    }
    return normals;
}

double secondsSince(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace

int main(int argc, char** argv)
{
    Arguments a;
    if (const std::optional<int> exit = parseArguments(argc, argv, a)) return *exit;
    const bool exr = endsWith(a.image, ".exr");
    if (!a.image.empty() && !exr && !endsWith(a.image, ".png"))
        return cli::fail("gimdec", cli::Usage, a.image + ": the image must be a .png or .exr file");
    if (!a.normalMap.empty() && !endsWith(a.normalMap, ".png"))
        return cli::fail("gimdec", cli::Usage, a.normalMap + ": the normal map must be a .png file");

    const auto file = cli::readFile(a.input);
    if (!file) return refuse(a.input + ": cannot be read");
    const auto start = std::chrono::steady_clock::now();
    const Result<DecodedImages> images = decodeImages(*file, a.flags());
    if (!images) return refuse(a.input + ": " + images.error().message);
    const gim_info& info = images->info;
    if (info.missing_bytes > 0)
        std::cerr << "gimdec: warning: " << a.input << " is cut short: " << info.missing_bytes << " of "
                  << info.geometry_bytes + info.missing_bytes << " bytes of the surface are missing\n";
    else if (images->isPrefix)
        std::cerr << "gimdec: warning: " << a.input << " is cut short after the surface\n";
    if (a.level >= info.levels)
        return refuse(a.input + ": there is no level " + std::to_string(a.level) + ", the coarsest is " +
                      std::to_string(info.levels - 1));
    if (!a.normalMap.empty() && info.normal_grid == 0) return refuse(a.input + ": has no normal image");
    const Result<Mesh> mesh = levelMesh(*file, *images, a.level, a.flags());
    if (!mesh) return refuse(a.input + ": " + mesh.error().message);
    const double decodeSeconds = secondsSince(start);

    const Result<std::vector<VertexAttribute>> attributes =
        levelAttributes(*file, *images, a.level, a.flags());
    if (!attributes) return refuse(a.input + ": " + attributes.error().message);
    const Status written = writeMesh(*mesh, a.output, vertexNormals(*file, *images, a.level, a.flags()),
                                     Encoding::Binary, *attributes);
    if (!written) {
        const bool usage = written.error().kind == ErrorKind::FormatUnknown;
        return cli::fail("gimdec", usage ? cli::Usage : cli::Refused, written.error().message);
    }
    for (const VertexAttribute& attribute : *attributes)
        if (!takesAttribute(a.output, attribute))
            std::cerr << "gimdec: " << a.output << " cannot hold the attribute " << attribute.name
                      << ": it is left out\n";
    if (!a.image.empty()) {
        const Status status =
            exr ? writeExr(images->geometry, a.image) : writePng16(images->geometry, a.image);
        if (!status) return refuse(status.error().message);
    }
    if (!a.normalMap.empty()) {
        const Status status = writeNormalPng(images->normals, a.normalMap);
        if (!status) return refuse(status.error().message);
    }
    if (!a.json.empty()) {
        nlohmann::ordered_json json;
        json["bytes"] = file->size();
        json["cut_short"] = images->isPrefix;
        json["missing_bytes"] = info.missing_bytes;
        json["level"] = a.level;
        json["grid"] = ((info.grid - 1) >> a.level) + 1;
        json["vertices"] = mesh->vertexCount();
        json["faces"] = mesh->faceCount();
        json["fused"] = !a.noFuse;
        json["diffused"] = !a.noFuse && !a.noDiffuse;
        json["normals"] = info.normal_grid;
        json["attributes"] = nlohmann::ordered_json::array();
        for (const VertexAttribute& attribute : *attributes) json["attributes"].push_back(attribute.name);
        json["seconds"] = {{"decode", decodeSeconds}, {"total", secondsSince(start)}};
        if (!cli::writeJson(a.json, json)) return refuse(a.json + ": cannot be written");
    }
    return cli::Done;
}

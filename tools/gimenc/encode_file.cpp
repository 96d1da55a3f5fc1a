#include "encode_file.h"

#include "../whole_file.h"
#include "encode_against.h"
#include "record.h"
#include "simplified_surface.h"
#include "status_line.h"

#include <gim.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>

namespace gimg::gimenc {
namespace {

struct Failure
{
    cli::Exit exit = cli::Done;
    std::string message;
};

struct Made
{
    EncodedMesh encoded;
    nlohmann::ordered_json report;
};

cli::Exit exitFor(ErrorKind kind)
{
    if (kind == ErrorKind::TargetUnreachable) return cli::Unreachable;
    return kind == ErrorKind::BadArgument ? cli::Usage : cli::Refused;
}

double secondsSince(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Where surfaces agree there is no finite PSNR.
nlohmann::ordered_json finite(double psnr)
{
    return std::isfinite(psnr) ? nlohmann::ordered_json(psnr) : nlohmann::ordered_json();
}

nlohmann::ordered_json loop(double length, double fraction, int edges, const Vec3& at)
{
    return {{"length", length}, {"fraction", fraction}, {"edges", edges}, {"at", {at[0], at[1], at[2]}}};
}

void addLoops(nlohmann::ordered_json& json, const SimplifiedSurface& surface)
{
    auto& holes = json["closed_holes"] = nlohmann::ordered_json::array();
    for (const ClosedHole& hole : surface.holes) {
        holes.push_back(loop(hole.length, hole.fraction, hole.edges, hole.at));
        holes.back()["zipped"] = hole.zipped;
    }
    auto& handles = json["removed_handles"] = nlohmann::ordered_json::array();
    for (const RemovedHandle& handle : surface.handles)
        handles.push_back(loop(handle.length, handle.fraction, handle.edges, handle.at));
}

struct Seconds
{
    double read = 0, topology = 0, total = 0; ///< the others are EncodedMesh's
};

nlohmann::ordered_json features(const FeatureReport& found)
{
    return {{"length", found.length},
            {"creases", found.creases},
            {"corners", found.corners},
            {"on_creases", found.onCreases},
            {"on_corners", found.onCorners},
            {"crossings_left", found.crossings},
            {"kept", found.kept},
            {"db_before", finite(found.psnrBefore)},
            {"db_after", finite(found.psnrAfter)},
            {"max_before", found.maxBefore},
            {"max_after", found.maxAfter}};
}

nlohmann::ordered_json seam(const FoundSeam& found)
{
    return {{"sides", found.sides},
            {"border_steps", found.steps},
            {"glued_steps", found.glued},
            {"widest_gap", found.widestGap},
            {"objection",
             found.objection.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(found.objection)}};
}

nlohmann::ordered_json report(const EncodedMesh& encoded, const SimplifiedSurface& simplified,
                              const Seconds& seconds)
{
    gim_info info{};
    info.size = sizeof info;
    gim_probe(encoded.file.data(), encoded.file.size(), nullptr, &info);
    nlohmann::ordered_json json;
    json["vertices"] = encoded.topology.vertices;
    json["faces"] = encoded.topology.faces;
    json["genus"] = encoded.topology.genus;
    json["boundaries"] = encoded.topology.boundaries;
    json["grid"] = encoded.grid;
    json["lowest"] = encoded.lowest;
    json["layout"] = encoded.image                                ? "image"
                     : encoded.layout == SquareLayout::Octahedral ? "octahedral"
                                                                  : "cut";
    json["bytes"] = {{"total", encoded.file.size()}, {"container", info.container_bytes},
                     {"sideband", info.seam_bytes},  {"geometry", info.geometry_bytes},
                     {"normals", info.normal_bytes}, {"attributes", info.attribute_bytes}};
    json["psnr"] = finite(encoded.psnr);
    json["max_error"] = encoded.maxError;
    json["image"] = nullptr;
    if (encoded.image) json["image"] = seam(*encoded.image);
    json["param"] = encoded.image ? nlohmann::ordered_json() : mapName(encoded.param);
    json["fit"] = nullptr;
    if (encoded.fit)
        json["fit"] = {{"db_before", finite(encoded.fit->psnrBefore)},
                       {"db_after", finite(encoded.fit->psnrAfter)}};
    json["features"] = nullptr;
    if (encoded.features) json["features"] = features(*encoded.features);
    json["stretch_efficiency"] =
        encoded.image ? nlohmann::ordered_json() : nlohmann::ordered_json(encoded.stretchEfficiency);
    json["cut"] = {{"nodes", encoded.cutNodes},
                   {"paths", encoded.cutPaths},
                   {"extrema", encoded.cutExtrema},
                   {"length", encoded.cutLength}};
    json["seconds"] = {{"read", seconds.read},
                       {"topology", seconds.topology},
                       {"cut", encoded.seconds.cut},
                       {"parameterize", encoded.seconds.parameterize},
                       {"sample", encoded.seconds.sample},
                       {"fit", encoded.seconds.fit},
                       {"code", encoded.seconds.code},
                       {"total", seconds.total}};
    json["warnings"] = encoded.warnings;
    addLoops(json, simplified);
    return json;
}

class Maker
{
public:
    Maker(const Arguments& a, Made& made) : a_(a), made_(made), progress_(!a.quiet) {}

    Failure make()
    {
        show("read", 0);
        EncodeOptions options = encodeOptions(a_);
        options.progress = [this](const char* stage, double fraction) { show(stage, fraction); };
        Failure failure = a_.fromImage ? fromImage(options) : fromMesh(options);
        if (failure.exit != cli::Done) return failure;
        seconds_.total = secondsSince(start_);
        made_.report = report(made_.encoded, simplified_, seconds_);
        return {};
    }

private:
    void show(const char* stage, double fraction) const
    {
        char text[64];
        std::snprintf(text, sizeof text, "%-14s %3.0f %%", stage, 100 * fraction);
        progress_.show(text);
    }

    Failure fromImage(const EncodeOptions& options)
    {
        const Result<FloatImage> image = readGeometryImage(a_.input);
        if (!image) return {cli::Refused, image.error().message};
        seconds_.read = secondsSince(start_);
        return take(encodeImage(*image, options, a_.tolerance.value_or(kSeamTolerance)), {});
    }

    Failure fromMesh(EncodeOptions options)
    {
        Result<MeshFile> read = readMesh(a_.input, readOptions(a_));
        if (!read) {
            const bool several = read.error().kind == ErrorKind::SeveralComponents;
            return {cli::Refused,
                    read.error().message + (several ? "; --component largest takes the largest" : "")};
        }
        seconds_.read = secondsSince(start_);
        if (asksForSimplifying(a_)) {
            show("topology", 0);
            Result<SimplifiedSurface> result = simplifiedSurface(read->mesh, a_);
            if (!result) return {exitFor(result.error().kind), a_.input + ": " + result.error().message};
            simplified_ = std::move(*result);
            seconds_.topology = secondsSince(start_) - seconds_.read;
        }
        options.attributed = &read->attributed;
        return take(simplified_.changed() ? encodeAgainst(read->mesh, simplified_.mesh, options)
                                          : encodeMesh(read->mesh, options),
                    warnings(read->report));
    }

    Failure take(Result<EncodedMesh> encoded, std::vector<std::string> notes)
    {
        if (!encoded) return {exitFor(encoded.error().kind), a_.input + ": " + encoded.error().message};
        for (const auto* more : {&simplified_.notes, &encoded->warnings})
            notes.insert(notes.end(), more->begin(), more->end());
        encoded->warnings = std::move(notes);
        made_.encoded = std::move(*encoded);
        return {};
    }

    const Arguments& a_;
    Made& made_;
    const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    StatusLine progress_;
    Seconds seconds_;
    SimplifiedSurface simplified_;
};

void tell(const Arguments& a, const EncodedMesh& encoded)
{
    for (const std::string& warning : encoded.warnings) std::cerr << "gimenc: " << warning << '\n';
    if (a.json == "-") return;
    std::printf("%s: %d faces, genus %d, %d boundaries -> %s: %zu bytes, %d x %d samples, PSNR %.2f dB\n",
                a.input.c_str(), encoded.topology.faces, encoded.topology.genus, encoded.topology.boundaries,
                a.output.c_str(), encoded.file.size(), encoded.grid, encoded.grid, encoded.psnr);
}

Failure writeMade(const Arguments& a, const Made& made, const std::optional<cli::Contents>& input)
{
    const std::vector<std::uint8_t>& file = made.encoded.file;
    if (a.resume) {
        if (const auto what = recordDone(a, *input, file, made.report)) return {cli::Refused, *what};
    } else if (!cli::writeWhole(a.output, file.data(), file.size())) {
        return {cli::Refused, a.output + ": cannot be written"};
    }
    if (!a.json.empty() && !cli::writeJson(a.json, made.report))
        return {cli::Refused, a.json + ": cannot be written"};
    return {};
}

// `input` tells an input that changes while it is read from what is encoded: it was identified before.
Failure makeAndWrite(const Arguments& a, const std::optional<cli::Contents>& input)
{
    std::error_code error;
    if (a.resume && !input) return {cli::Refused, a.input + ": cannot be read"};
    const std::filesystem::path folder = std::filesystem::path(a.output).parent_path();
    if (a.resume && !folder.empty() && !std::filesystem::is_directory(folder) &&
        !std::filesystem::create_directories(folder, error) && error)
        return {cli::Refused, folder.string() + ": cannot be created"};

    Made made;
    if (Failure failure = Maker(a, made).make(); failure.exit != cli::Done) return failure;
    if (Failure failure = writeMade(a, made, input); failure.exit != cli::Done) return failure;
    if (!a.quiet) tell(a, made.encoded);
    return {};
}

} // namespace

int encodeFile(const Arguments& a)
{
    std::error_code ignored;
    if (std::filesystem::equivalent(a.input, a.output, ignored))
        return cli::fail("gimenc", cli::Usage, a.output + ": is the input itself");
    std::optional<cli::Contents> input;
    if (a.resume) input = cli::contentsOf(a.input);
    if (input && isFinished(a, *input)) {
        if (!a.quiet) std::printf("%s: already there\n", a.output.c_str());
        return cli::Done;
    }
    const Failure failure = makeAndWrite(a, input);
    if (failure.exit == cli::Done) return cli::Done;
    if (a.resume) recordFailure(a, input, failure.message);
    return cli::fail("gimenc", failure.exit, failure.message);
}

} // namespace gimg::gimenc

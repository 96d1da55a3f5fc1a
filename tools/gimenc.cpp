// gimenc: a mesh becomes a .gim file.
#include "cli.h"

#include "gimg/encode.h"

#include "gimg/mesh_io.h"

#include <gim.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>

namespace {

using namespace gimg;

struct Arguments
{
    std::string input, output;
    int grid = 0, lowest = 0, normals = 0, threads = 0;
    std::optional<size_t> bytes;
    std::optional<double> psnr;
    std::string raw, component, json;
    std::string weld = "auto";
    bool quiet = false;
};

std::optional<int> parseArguments(int argc, char** argv, Arguments& a)
{
    const CLI::Validator positive(
        [](const std::string& text) {
            double number = 0;
            const bool good = CLI::detail::lexical_cast(text, number) && number > 0 && std::isfinite(number);
            return good ? std::string() : text + " is not a positive number";
        },
        "");
    CLI::App app{"Encodes a triangle mesh (OBJ, PLY, OFF, STL) as a .gim geometry image file.", "gimenc"};
    app.footer("Exit codes: 0 done, 1 input refused, 2 usage, 3 target not reachable.");
    app.set_version_flag("--version", GIMG_VERSION);
    app.add_option("INPUT", a.input, "mesh to encode")->required();
    app.add_option("OUTPUT", a.output, "file to write, .gim")->required();
    app.add_option("--grid", a.grid, "samples a side, 2^j + 1 (default: 257, more if the cut needs it)");
    app.add_option("--lowest", a.lowest,
                   "samples a side of the lowest level of detail, 2^l + 1 (default: 33, or as needed)");
    auto* target = app.add_option_group("target", "what the file is made for; exactly one");
    target->add_option("--bytes", a.bytes, "size of the whole file, never exceeded")->check(positive);
    target->add_option("--psnr", a.psnr, "surface PSNR in dB, met within 0.5 dB above")->check(positive);
    target->add_option("--raw", a.raw, "no compression loss but 12-bit integers, or none at all with float")
        ->check(CLI::IsMember({"12", "float"}));
    target->require_option(1);
    app.add_option("--normals", a.normals, "add a normal image of this many samples a side, 2^k + 1");
    app.add_option("--component", a.component, "of several components take the largest")
        ->check(CLI::IsMember({"largest"}));
    app.add_option("--weld", a.weld,
                   "merge vertices at equal positions: auto (where that harms nothing), always, never")
        ->check(CLI::IsMember({"auto", "always", "never"}));
    app.add_option("--threads", a.threads,
                   "threads to use (default: one a core); the file does not depend on it")
        ->check(positive);
    app.add_option("--json", a.json, "write a report to this file, or - for standard output");
    app.add_flag("--quiet", a.quiet, "print nothing but errors");
    return cli::parse(app, argc, argv);
}

ReadOptions readOptions(const Arguments& a)
{
    const Weld weld = a.weld == "always" ? Weld::Always : a.weld == "never" ? Weld::Never : Weld::Auto;
    return {weld, !a.component.empty()};
}

EncodeOptions encodeOptions(const Arguments& a)
{
    EncodeOptions options;
    options.grid = a.grid;
    options.lowest = a.lowest;
    options.normals = a.normals;
    options.threads = a.threads;
    if (a.bytes) {
        options.target = EncodeTarget::Bytes;
        options.bytes = *a.bytes;
    } else if (a.psnr) {
        options.target = EncodeTarget::Psnr;
        options.psnr = *a.psnr;
    } else {
        options.target = a.raw == "12" ? EncodeTarget::Raw12 : EncodeTarget::RawFloat;
    }
    return options;
}

cli::Exit exitFor(ErrorKind kind)
{
    if (kind == ErrorKind::TargetUnreachable) return cli::Unreachable;
    return kind == ErrorKind::BadArgument ? cli::Usage : cli::Refused;
}

double secondsSince(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

nlohmann::ordered_json report(const EncodedMesh& encoded, const gim_info& info, double read, double total)
{
    nlohmann::ordered_json json;
    json["vertices"] = encoded.topology.vertices;
    json["faces"] = encoded.topology.faces;
    json["genus"] = encoded.topology.genus;
    json["boundaries"] = encoded.topology.boundaries;
    json["grid"] = encoded.grid;
    json["lowest"] = encoded.lowest;
    json["bytes"] = {{"total", encoded.file.size()},
                     {"container", info.container_bytes},
                     {"sideband", info.seam_bytes},
                     {"geometry", info.geometry_bytes},
                     {"normals", info.normal_bytes}};
    json["psnr"] = nullptr; // where the surfaces agree there is no finite value
    if (std::isfinite(encoded.psnr)) json["psnr"] = encoded.psnr;
    json["stretch_efficiency"] = encoded.stretchEfficiency;
    json["cut"] = {{"nodes", encoded.cutNodes},
                   {"paths", encoded.cutPaths},
                   {"extrema", encoded.cutExtrema},
                   {"length", encoded.cutLength}};
    json["seconds"] = {{"read", read},
                       {"cut", encoded.seconds.cut},
                       {"parameterize", encoded.seconds.parameterize},
                       {"sample", encoded.seconds.sample},
                       {"code", encoded.seconds.code},
                       {"total", total}};
    json["warnings"] = encoded.warnings;
    return json;
}

// One line on a terminal that shows the stage at work; wiped when done.
class ProgressLine
{
public:
    explicit ProgressLine(bool quiet) : shown_(!quiet && isatty(STDERR_FILENO) == 1) {}
    ~ProgressLine() { wipe(); }

    void show(const char* stage, double fraction) const
    {
        if (shown_) std::fprintf(stderr, "\r\033[K%-14s %3.0f %%", stage, 100 * fraction);
    }
    void wipe() const
    {
        if (shown_) std::fputs("\r\033[K", stderr);
    }

private:
    bool shown_;
};

} // namespace

int main(int argc, char** argv)
{
    Arguments a;
    if (const std::optional<int> code = parseArguments(argc, argv, a)) return *code;
    std::error_code ignored;
    if (std::filesystem::equivalent(a.input, a.output, ignored))
        return cli::fail("gimenc", cli::Usage, a.output + ": is the input itself");
    const auto start = std::chrono::steady_clock::now();
    const ProgressLine progress(a.quiet);

    progress.show("read", 0);
    Result<MeshFile> read = readMesh(a.input, readOptions(a));
    progress.wipe();
    if (!read) {
        const bool several = read.error().kind == ErrorKind::SeveralComponents;
        return cli::fail("gimenc", cli::Refused,
                         read.error().message + (several ? "; --component largest takes the largest" : ""));
    }
    const double readSeconds = secondsSince(start);

    EncodeOptions options = encodeOptions(a);
    options.progress = [&](const char* stage, double fraction) { progress.show(stage, fraction); };
    Result<EncodedMesh> encoded = encodeMesh(read->mesh, options);
    progress.wipe();
    if (!encoded)
        return cli::fail("gimenc", exitFor(encoded.error().kind), a.input + ": " + encoded.error().message);

    std::vector<std::string> notes = warnings(read->report);
    notes.insert(notes.end(), encoded->warnings.begin(), encoded->warnings.end());
    encoded->warnings = std::move(notes);
    if (!cli::writeFile(a.output, encoded->file.data(), encoded->file.size()))
        return cli::fail("gimenc", cli::Refused, a.output + ": cannot be written");

    gim_info info{};
    info.size = sizeof info;
    gim_probe(encoded->file.data(), encoded->file.size(), nullptr, &info);
    if (!a.json.empty() && !cli::writeJson(a.json, report(*encoded, info, readSeconds, secondsSince(start))))
        return cli::fail("gimenc", cli::Refused, a.json + ": cannot be written");
    if (!a.quiet) {
        for (const std::string& warning : encoded->warnings) std::cerr << "gimenc: " << warning << '\n';
        if (a.json != "-")
            std::printf(
                "%s: %d faces, genus %d, %d boundaries -> %s: %zu bytes, %d x %d samples, PSNR %.2f dB\n",
                a.input.c_str(), encoded->topology.faces, encoded->topology.genus,
                encoded->topology.boundaries, a.output.c_str(), encoded->file.size(), encoded->grid,
                encoded->grid, encoded->psnr);
    }
    return cli::Done;
}

#include "arguments.h"

#include <CLI/App.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace gimg::gimenc {
namespace {

std::string shortest(double number)
{
    char text[64];
    return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

std::vector<std::string> mapNames()
{
    std::vector<std::string> names;
    for (MapKind kind : kMapKinds) names.push_back(mapName(kind));
    names.push_back(mapName(MapKind::Conformal));
    return names;
}

// "auto" or a number.
bool parseMaxGenus(const std::string& text, Arguments& a)
{
    a.maxGenus.reset();
    a.removeNoise = text == "auto";
    if (a.removeNoise) return true;
    int genus = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), genus);
    if (error != std::errc() || end != text.data() + text.size() || genus < 0) return false;
    a.maxGenus = genus;
    return true;
}

void addTopologyOptions(CLI::App& app, Arguments& a)
{
    app.add_option_function<std::string>(
           "--max-genus",
           [&a](const std::string& text) {
               if (!parseMaxGenus(text, a))
                   throw CLI::ValidationError("--max-genus", text + " is neither a number >= 0 nor auto");
           },
           "remove handles, smallest first, down to this genus; auto: those that are noise")
        ->type_name("G|auto");
    cli::addMeshLength(
        app, "--close-holes", a.closeHoles,
        "close boundary loops up to this long, in the mesh's unit or % of the bounding box's diagonal");
}

} // namespace

void addOptions(CLI::App& app, Arguments& a)
{
    const CLI::Validator positive(
        [](const std::string& text) {
            double number = 0;
            const bool good = CLI::detail::lexical_cast(text, number) && number > 0 && std::isfinite(number);
            return good ? std::string() : text + " is not a positive number";
        },
        "");
    const CLI::Validator fraction(
        [](const std::string& text) {
            double number = 0;
            const bool good = CLI::detail::lexical_cast(text, number) && number > 0 && number < 1;
            return good ? std::string() : text + " is not between 0 and 1";
        },
        "");
    app.add_option("--grid", a.grid,
                   "samples a side, 2^j + 1 (default: what suits the target, 129 to 1025; 257 for --raw)");
    app.add_option("--lowest", a.lowest,
                   "samples a side of the lowest level of detail, 2^l + 1 (default: 33, or as needed)");
    app.add_option("--layout", a.layout,
                   "cut, octahedral (a closed surface of genus 0 folds up from the four sides), auto")
        ->check(CLI::IsMember({"auto", "cut", "octahedral"}));
    auto* target = app.add_option_group("target", "what the file is made for; exactly one");
    target->add_option("--bytes", a.bytes, "size of the whole file, never exceeded")->check(positive);
    target->add_option("--psnr", a.psnr, "surface PSNR in dB, met within 0.2 dB above")->check(positive);
    target
        ->add_option(
            "--max-error", a.maxError,
            "largest distance between the surfaces, as a fraction of the diagonal; met within 2 % below")
        ->check(fraction);
    auto* raw =
        target
            ->add_option("--raw", a.raw, "no compression loss but 12-bit integers, or none at all with float")
            ->check(CLI::IsMember({"12", "float"}));
    target->require_option(0, 1);
    app.add_option("--normals", a.normals, "add a normal image of this many samples a side, 2^k + 1");
    app.add_option(
           "--attribute", a.attributes,
           "add an image of the vertices' color, uv or other attribute; may be repeated; GRID: samples "
           "a side, 2^k + 1 (default: as the geometry)")
        ->type_name("NAME[:GRID][:lossless]")
        ->allow_extra_args(false)
        ->check(CLI::Validator(
            [](const std::string& text) {
                return parseAttribute(text) ? std::string() : text + " is not NAME[:GRID][:lossless]";
            },
            ""));
    auto* noFit = app.add_flag(
        "--no-fit", a.noFit,
        "keep samples on the mesh; else they move to where the triangles between them fit it best");
    app.add_flag("--features", a.features,
                 "lay grid lines along the sharp edges of machine parts and the like")
        ->excludes(noFit);
    app.add_option("--smooth-levels", a.smoothLevels,
                   "keep this many of the finest levels free of details: a smooth fine mesh of few bytes")
        ->check(CLI::Range(0, 11))
        ->excludes(raw);
    app.add_flag("--progressive", a.progressive,
                 "let beginnings of the file serve too: better prefixes, a worse whole");
    app.add_option("--effort", a.effort, "time for quality: 1 (fast) to 9 (small files; minutes)")
        ->check(CLI::Range(EncodeOptions::kLeastEffort, EncodeOptions::kMostEffort))
        ->capture_default_str();
    app.add_flag(
        "--from-image", a.fromImage,
        "INPUT is a geometry image, .exr or .f32: code it as it is, glued where its border samples coincide");
    app.add_option(
           "--tolerance", a.tolerance,
           "with --from-image: how far apart samples may be to coincide, as a fraction of the diagonal "
           "(default: 0.0001)")
        ->check(fraction);
    app.add_option("--component", a.component, "of several components take the largest")
        ->check(CLI::IsMember({"largest"}));
    app.add_option("--weld", a.weld,
                   "merge vertices at equal positions: auto (where that harms nothing), always, never")
        ->check(CLI::IsMember({"auto", "always", "never"}));
    app.add_option(
           "--coding", a.coding,
           "surface (along normals and tangents, across the seam), or wavelet (x, y, z on their own, both "
           "sides of the seam)")
        ->check(CLI::IsMember({"surface", "wavelet"}))
        ->excludes(raw);
    app.add_option("--density", a.density, "samples: closer where the surface bends (curvature), or even")
        ->check(CLI::IsMember({"curvature", "even"}));
    app.add_option("--param", a.param,
                   "map to the square: stretch (even samples), or linear and fast, but shrinking what sticks "
                   "out: mvc (mean values), tutte, harmonic; or conformal, for closed surfaces of genus 0 "
                   "(by way of the sphere) and 1")
        ->check(CLI::IsMember(mapNames()));
    addTopologyOptions(app, a);
    app.add_option("--threads", a.threads,
                   "threads to use (default: one a core); the file does not depend on it")
        ->check(positive);
    app.add_option("--json", a.json, "write a report to this file, or - for standard output");
    app.add_flag("--resume", a.resume,
                 "keep a record in OUTPUT.json and do nothing if it says that OUTPUT is made already");
    app.add_flag("--quiet", a.quiet, "print nothing but errors");
}

void addFiles(CLI::App& app, Arguments& a)
{
    app.add_option("INPUT", a.input, "mesh to encode, or geometry image with --from-image");
    app.add_option("OUTPUT", a.output, "file to write, .gim");
}

bool hasTarget(const Arguments& a) { return a.bytes || a.psnr || a.maxError || !a.raw.empty(); }

namespace {

// Options of the road from a mesh to an image.
std::optional<std::string> clash(const Arguments& a)
{
    const Arguments defaults;
    const std::pair<const char*, bool> given[] = {{"--grid", a.grid != defaults.grid},
                                                  {"--layout", a.layout != defaults.layout},
                                                  {"--density", a.density != defaults.density},
                                                  {"--weld", a.weld != defaults.weld},
                                                  {"--param", a.param != defaults.param},
                                                  {"--component", !a.component.empty()},
                                                  {"--no-fit", a.noFit},
                                                  {"--features", a.features},
                                                  {"--close-holes", a.closeHoles.has_value()},
                                                  {"--attribute", !a.attributes.empty()},
                                                  {"--max-genus", a.maxGenus || a.removeNoise}};
    for (const auto& [name, isGiven] : given)
        if (isGiven) return std::string(name) + " is for meshes: --from-image takes the image as it is";
    return std::nullopt;
}

} // namespace

std::optional<std::string> missing(const Arguments& a)
{
    if (a.input.empty()) return "INPUT is required";
    if (a.output.empty()) return "OUTPUT is required";
    if (!hasTarget(a)) return "one of --bytes, --psnr, --max-error and --raw is required";
    if (a.tolerance && !a.fromImage) return "--tolerance needs --from-image";
    if (a.fromImage) return clash(a);
    return std::nullopt;
}

Result<Arguments> parseLine(const std::vector<std::string>& words, const Arguments& defaults)
{
    Arguments a = defaults;
    a.bytes.reset(), a.psnr.reset(), a.maxError.reset(), a.raw.clear();
    CLI::App app("", "gimenc");
    app.set_help_flag(); // a line that asks for help is a mistake
    addOptions(app, a);
    addFiles(app, a);
    try {
        app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
    } catch (const CLI::ParseError& error) {
        return Error{ErrorKind::BadArgument, error.what()};
    }
    if (!hasTarget(a)) {
        a.bytes = defaults.bytes, a.psnr = defaults.psnr;
        a.maxError = defaults.maxError, a.raw = defaults.raw;
    }
    if (!a.json.empty()) return Error{ErrorKind::BadArgument, "--json: the report of a line is OUTPUT.json"};
    if (const auto what = missing(a)) return Error{ErrorKind::BadArgument, *what};
    return a;
}

std::vector<std::string> fileOptions(const Arguments& a)
{
    std::vector<std::string> words;
    const auto add = [&](const char* name, const std::string& value) {
        words.push_back(name);
        words.push_back(value);
    };
    if (a.bytes) add("--bytes", std::to_string(*a.bytes));
    if (a.psnr) add("--psnr", shortest(*a.psnr));
    if (a.maxError) add("--max-error", shortest(*a.maxError));
    if (!a.raw.empty()) add("--raw", a.raw);
    if (a.fromImage) words.push_back("--from-image");
    if (a.tolerance) add("--tolerance", shortest(*a.tolerance));
    if (a.smoothLevels != 0) add("--smooth-levels", std::to_string(a.smoothLevels));
    if (a.progressive) words.push_back("--progressive");
    if (a.effort != EncodeOptions().effort) add("--effort", std::to_string(a.effort));
    if (a.grid != 0) add("--grid", std::to_string(a.grid));
    if (a.lowest != 0) add("--lowest", std::to_string(a.lowest));
    if (a.layout != "auto") add("--layout", a.layout);
    if (a.normals != 0) add("--normals", std::to_string(a.normals));
    for (const std::string& attribute : a.attributes) add("--attribute", attribute);
    if (a.noFit) words.push_back("--no-fit");
    if (a.features) words.push_back("--features");
    if (!a.component.empty()) add("--component", a.component);
    if (a.weld != "auto") add("--weld", a.weld);
    if (a.coding != "surface") add("--coding", a.coding);
    if (a.density != "curvature") add("--density", a.density);
    if (a.param != "stretch") add("--param", a.param);
    if (a.closeHoles) add("--close-holes", a.closeHoles->text());
    if (a.maxGenus) add("--max-genus", std::to_string(*a.maxGenus));
    if (a.removeNoise) add("--max-genus", "auto");
    return words;
}

std::optional<AttributeRequest> parseAttribute(const std::string& text)
{
    AttributeRequest request;
    std::string_view rest = text;
    constexpr std::string_view kLossless = ":lossless";
    if (rest.ends_with(kLossless)) {
        request.lossless = true;
        rest.remove_suffix(kLossless.size());
    }
    if (const size_t colon = rest.rfind(':'); colon != rest.npos) {
        const char* last = rest.data() + rest.size();
        const auto [end, error] = std::from_chars(rest.data() + colon + 1, last, request.grid);
        if (error != std::errc() || end != last || request.grid < 3) return std::nullopt;
        rest = rest.substr(0, colon);
    }
    request.name = rest;
    return rest.empty() ? std::nullopt : std::optional(request);
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
    options.layout = a.layout == "cut"          ? SquareLayout::Cut
                     : a.layout == "octahedral" ? SquareLayout::Octahedral
                                                : SquareLayout::Auto;
    options.normals = a.normals;
    for (const std::string& text : a.attributes)
        if (std::optional<AttributeRequest> request = parseAttribute(text))
            options.attributes.push_back(std::move(*request));
    options.fit = !a.noFit;
    options.features = a.features;
    options.threads = a.threads;
    options.effort = a.effort;
    options.smoothLevels = a.smoothLevels;
    options.progressive = a.progressive;
    options.coding = a.coding == "wavelet" ? LossyCoding::Wavelet : LossyCoding::Surface;
    options.density = a.density == "even" ? Density::Even : Density::Curvature;
    if (a.param == mapName(MapKind::Conformal)) options.param = MapKind::Conformal;
    for (MapKind kind : kMapKinds)
        if (a.param == mapName(kind)) options.param = kind;
    if (a.bytes) {
        options.target = EncodeTarget::Bytes;
        options.bytes = *a.bytes;
    } else if (a.psnr) {
        options.target = EncodeTarget::Psnr;
        options.psnr = *a.psnr;
    } else if (a.maxError) {
        options.target = EncodeTarget::MaxError;
        options.maxError = *a.maxError;
    } else {
        options.target = a.raw == "12" ? EncodeTarget::Raw12 : EncodeTarget::RawFloat;
    }
    return options;
}

} // namespace gimg::gimenc

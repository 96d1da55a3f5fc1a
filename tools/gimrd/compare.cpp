#include "command.h"
#include "heatmap.h"

#include "../cli.h"

#include "gimg/distance.h"
#include "gimg/mesh_io.h"

#include <CLI/App.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

namespace gimg::gimrd {
namespace {

struct CompareOptions
{
    std::string reference;
    std::string test;
    DistanceOptions distance;
    bool json = false;
    std::string heatmap;           ///< file; none if empty
    std::optional<double> percent; ///< of the diagonal, the top of the heatmap's scale
};

/// Left out of the scale: a few outliers should not paint all the rest in one colour.
constexpr double kTopQuantile = 0.999;

/// The next number that reads well on a scale with four intervals.
double roundedUp(double x)
{
    if (!(x > 0)) return 0;
    const double unit = std::pow(10, std::floor(std::log10(x)));
    for (double step : {1.0, 1.2, 1.6, 2.0, 2.4, 3.2, 4.0, 5.0, 6.0, 8.0})
        if (x <= step * unit) return step * unit;
    return 10 * unit;
}

/// Zero where no heatmap was asked for.
double topOfScale(const CompareOptions& options, const SurfaceDistance& d)
{
    if (options.heatmap.empty()) return 0;
    if (options.percent) return *options.percent / 100 * d.diagonal;
    const double top = std::max(d.quantileRefToTest, d.quantileTestToRef);
    return roundedUp(100 * (top > 0 ? top : d.hausdorff()) / d.diagonal) / 100 * d.diagonal;
}

bool printJson(const SurfaceDistance& d, const CompareOptions& options)
{
    const auto point = [](const Vec3& p) { return nlohmann::ordered_json{p[0], p[1], p[2]}; };
    nlohmann::ordered_json object;
    object["diagonal"] = d.diagonal;
    object["rms_ref_to_test"] = d.rmsRefToTest;
    object["rms_test_to_ref"] = d.rmsTestToRef;
    object["max_ref_to_test"] = d.maxRefToTest;
    object["max_ref_to_test_at"] = point(d.maxRefToTestAt);
    object["max_test_to_ref"] = d.maxTestToRef;
    object["max_test_to_ref_at"] = point(d.maxTestToRefAt);
    object["hausdorff"] = d.hausdorff();
    object["psnr"] = d.psnr(); // null where infinite: JSON has no such number
    const auto angle = [&object](const std::string& name, const std::optional<double>& degrees) {
        object[name] = degrees ? nlohmann::ordered_json(*degrees) : nlohmann::ordered_json(nullptr);
    };
    const auto rms = [](const std::optional<NormalError>& e) {
        return e ? std::optional(e->rms) : std::nullopt;
    };
    const auto mean = [](const std::optional<NormalError>& e) {
        return e ? std::optional(e->mean) : std::nullopt;
    };
    angle("normal_rms_ref_to_test", rms(d.normalsRefToTest));
    angle("normal_rms_test_to_ref", rms(d.normalsTestToRef));
    angle("normal_mean_ref_to_test", mean(d.normalsRefToTest));
    angle("normal_mean_test_to_ref", mean(d.normalsTestToRef));
    angle("normal_error_degrees", d.normalRms());
    if (!options.heatmap.empty()) object["heatmap_max"] = topOfScale(options, d);
    return cli::writeJson("-", object);
}

void printNormals(const char* direction, const std::optional<NormalError>& error)
{
    if (error)
        std::printf("normals %s  %.4g degrees rms, mean %.4g\n", direction, error->rms, error->mean);
    else
        std::printf("normals %s  none\n", direction);
}

bool printText(const SurfaceDistance& d, const CompareOptions& options)
{
    const auto at = [](const Vec3& p) { std::printf("   at (%.6g, %.6g, %.6g)\n", p[0], p[1], p[2]); };
    std::printf("diagonal          %.6g\n", d.diagonal);
    std::printf("rms ref to test   %.6g\n", d.rmsRefToTest);
    std::printf("rms test to ref   %.6g\n", d.rmsTestToRef);
    std::printf("max ref to test   %.6g", d.maxRefToTest);
    at(d.maxRefToTestAt);
    std::printf("max test to ref   %.6g", d.maxTestToRef);
    at(d.maxTestToRefAt);
    std::printf("hausdorff         %.6g\n", d.hausdorff());
    if (std::isinf(d.psnr()))
        std::printf("psnr              inf\n");
    else
        std::printf("psnr              %.2f dB\n", d.psnr());
    printNormals("ref to test", d.normalsRefToTest);
    printNormals("test to ref", d.normalsTestToRef);
    if (!options.heatmap.empty()) {
        const double top = topOfScale(options, d);
        std::printf("heatmap           0 to %.6g, %.4g %% of the diagonal\n", top, 100 * top / d.diagonal);
    }
    return std::fflush(stdout) == 0;
}

int compare(const CompareOptions& options)
{
    const Result<Mesh> reference = readTriangles(options.reference);
    if (!reference) return cli::fail("gimrd", cli::Refused, reference.error().message);
    const Result<Mesh> test = readTriangles(options.test);
    if (!test) return cli::fail("gimrd", cli::Refused, test.error().message);
    std::error_code ignored;
    for (const std::string& input : {options.reference, options.test})
        if (std::filesystem::equivalent(input, options.heatmap, ignored))
            return cli::fail("gimrd", cli::Usage, options.heatmap + ": is an input itself");
    DistanceOptions distance = options.distance;
    distance.normals = true;
    if (!options.heatmap.empty()) distance.quantile = kTopQuantile;
    const Result<SurfaceDistance> d = compareSurfaces(*reference, *test, distance);
    if (!d) return cli::fail("gimrd", cli::Refused, d.error().message);
    const bool printed = options.json ? printJson(*d, options) : printText(*d, options);
    if (!printed) return cli::fail("gimrd", cli::Refused, "cannot write the result");
    if (options.heatmap.empty()) return cli::Done;
    const Heatmap heatmap{options.heatmap, topOfScale(options, *d), d->diagonal, distance.threads};
    const Status written = writeHeatmap(*reference, *test, heatmap);
    return written ? int{cli::Done} : cli::fail("gimrd", cli::Refused, written.error().message);
}

} // namespace

Command addCompare(CLI::App& app)
{
    const auto options = std::make_shared<CompareOptions>();
    CLI::App* sub =
        app.add_subcommand("compare", "Distance and angle between two surfaces, both ways, and PSNR");
    sub->add_option("REF", options->reference, "Reference mesh (.obj, .ply, .off, .stl)")->required();
    sub->add_option("TEST", options->test, "Mesh to compare with it; its topology does not matter")
        ->required();
    sub->add_option("--samples", options->distance.samples, "Samples on each surface")
        ->check(CLI::Range(1, 100000000))
        ->capture_default_str();
    sub->add_option("--seed", options->distance.seed, "Seed of the samples")->capture_default_str();
    sub->add_option("--threads", options->distance.threads, "Threads; 0 for one a core")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    sub->add_flag("--json", options->json, "Print JSON; psnr is null where the surfaces agree");
    const auto knownFormat = [](const std::string& path) {
        return heatmapFormat(path) ? std::string() : path + ": a heatmap is written to .ply or .png";
    };
    CLI::Option* heatmap =
        sub->add_option("--heatmap", options->heatmap,
                        "Write distances as colours: .ply, the test mesh; .png, a picture of both surfaces")
            ->check(CLI::Validator(knownFormat, "FILE"));
    sub->add_option(
           "--heatmap-max", options->percent,
           "Distance of the brightest colour, in % of the diagonal; by default 99.9 % of the samples "
           "are nearer")
        ->needs(heatmap)
        ->check(CLI::PositiveNumber);
    return {sub, [options] { return compare(*options); }};
}

} // namespace gimg::gimrd

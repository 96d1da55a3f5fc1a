#include "command.h"

#include "../cli.h"

#include "gimg/distance.h"
#include "gimg/mesh_io.h"

#include <cmath>
#include <memory>

namespace gimg::gimrd {
namespace {

struct CompareOptions
{
    std::string reference;
    std::string test;
    DistanceOptions distance;
    bool json = false;
};

bool printJson(const SurfaceDistance& d)
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
    return cli::writeJson("-", object);
}

bool printText(const SurfaceDistance& d)
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
    return std::fflush(stdout) == 0;
}

int compare(const CompareOptions& options)
{
    const Result<Mesh> reference = readTriangles(options.reference);
    if (!reference) return cli::fail("gimrd", cli::Refused, reference.error().message);
    const Result<Mesh> test = readTriangles(options.test);
    if (!test) return cli::fail("gimrd", cli::Refused, test.error().message);
    const Result<SurfaceDistance> d = compareSurfaces(*reference, *test, options.distance);
    if (!d) return cli::fail("gimrd", cli::Refused, d.error().message);
    const bool printed = options.json ? printJson(*d) : printText(*d);
    return printed ? int{cli::Done} : cli::fail("gimrd", cli::Refused, "cannot write the result");
}

} // namespace

Command addCompare(CLI::App& app)
{
    const auto options = std::make_shared<CompareOptions>();
    CLI::App* sub = app.add_subcommand("compare", "Distance between two surfaces, both ways, and PSNR");
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
    return {sub, [options] { return compare(*options); }};
}

} // namespace gimg::gimrd

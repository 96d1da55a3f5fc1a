#include "encode_against.h"

#include "gimg/distance.h"

#include <cstdio>

namespace gimg::gimenc {
namespace {

// What no file of the surface can be expected to go below.
Status checkSurface(const SurfaceDistance& off, const EncodeGoal& goal)
{
    const auto refuse = [](const char* format, double asked, double reached) {
        char text[200];
        std::snprintf(text, sizeof text, format, asked, reached);
        return Error{ErrorKind::TargetUnreachable, text};
    };
    const double maxError = off.hausdorff() / off.diagonal;
    if (goal.target == EncodeTarget::Psnr && off.psnr() <= goal.psnr)
        return refuse("%.2f dB cannot be reached: without its holes and handles the surface is %.2f dB from "
                      "what was read",
                      goal.psnr, off.psnr());
    if (goal.target == EncodeTarget::MaxError && maxError >= goal.maxError)
        return refuse("a largest error of %.4g cannot be reached: without its holes and handles the surface "
                      "is up to %.4g from what was read",
                      goal.maxError, maxError);
    return Done{};
}

} // namespace

Result<EncodedMesh> encodeAgainst(const Mesh& reference, const Mesh& surface, EncodeOptions options)
{
    if (options.target == EncodeTarget::Psnr || options.target == EncodeTarget::MaxError) {
        DistanceOptions distance;
        distance.threads = options.threads;
        const Result<SurfaceDistance> off = compareSurfaces(reference, surface, distance);
        if (!off) return off.error();
        if (const Status possible = checkSurface(*off, options); !possible) return possible.error();
    }
    options.reference = &reference;
    return encodeMesh(surface, options);
}

} // namespace gimg::gimenc

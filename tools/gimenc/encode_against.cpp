#include "encode_against.h"

#include "gimg/decode.h"
#include "gimg/distance.h"

#include <cmath>
#include <cstdio>

namespace gimg::gimenc {
namespace {

// As encodeMesh counts: where hardly any surface is left the PSNR is 0.
Result<double> psnrOf(const Mesh& mesh, const SurfaceMeasure& measure)
{
    if (!(surfaceArea(mesh) > 0)) return 0.0;
    const Result<SurfaceDistance> distance = measure.against(mesh);
    if (!distance && distance.error().kind == ErrorKind::EmptyMesh) return 0.0;
    if (!distance) return distance.error();
    return distance->psnr();
}

Result<EncodedMesh> encodeOnce(const MeshEncoder& encoder, const EncodeGoal& goal,
                               const SurfaceMeasure& measure)
{
    Result<EncodedMesh> encoded = encoder.encode(goal);
    if (!encoded) return encoded;
    const Result<DecodedImages> images = decodeImages(encoded->file);
    if (!images) return images.error();
    const Result<Mesh> mesh = levelMesh(encoded->file, *images, 0);
    if (!mesh) return mesh.error();
    const Result<double> psnr = psnrOf(*mesh, measure);
    if (!psnr) return psnr.error();
    encoded->psnr = *psnr;
    return encoded;
}

std::string decibels(double psnr)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.2f dB", psnr);
    return text;
}

// The encoder knows the surface only. Its errors and those of the surface, at `limit` dB from the reference,
// add up in squares; where that is not quite so the next round makes up for it.
Result<EncodedMesh> encodeToPsnr(const MeshEncoder& encoder, EncodeGoal goal, double limit,
                                 const SurfaceMeasure& measure)
{
    constexpr double kWindow = 0.5, kAim = 0.2; // dB above the target, as encodeMesh promises
    constexpr int kMostRounds = 6;
    const double asked = goal.psnr;
    goal.psnr = -10 * std::log10(std::pow(10, -asked / 10) - std::pow(10, -limit / 10));
    for (int round = 1;; ++round) {
        Result<EncodedMesh> encoded = encodeOnce(encoder, goal, measure);
        if (!encoded && encoded.error().kind == ErrorKind::TargetUnreachable)
            return Error{ErrorKind::TargetUnreachable,
                         decibels(asked) +
                             " from the surface as read is not met: " + encoded.error().message};
        if (!encoded || (encoded->psnr >= asked && encoded->psnr <= asked + kWindow)) return encoded;
        if (round == kMostRounds)
            return Error{ErrorKind::TargetUnreachable, "no file is found within 0.5 dB of " +
                                                           decibels(asked) + "; the last has " +
                                                           decibels(encoded->psnr)};
        goal.psnr += asked + kAim - encoded->psnr;
    }
}

} // namespace

Result<EncodedMesh> encodeAgainst(const Mesh& reference, const Mesh& surface, const EncodeOptions& options)
{
    DistanceOptions distance;
    distance.threads = options.threads;
    const SurfaceMeasure measure(reference, distance);
    const bool toPsnr = options.target == EncodeTarget::Psnr;
    double limit = 0;
    if (toPsnr) {
        const Result<double> best = psnrOf(surface, measure);
        if (!best) return best.error();
        limit = *best;
        if (limit <= options.psnr)
            return Error{ErrorKind::TargetUnreachable,
                         decibels(options.psnr) +
                             " cannot be reached: without its holes and handles the surface is " +
                             decibels(limit) + " from what was read"};
    }
    const Result<MeshEncoder> encoder = MeshEncoder::prepare(surface, options);
    if (!encoder) return encoder.error();
    return toPsnr ? encodeToPsnr(*encoder, options, limit, measure) : encodeOnce(*encoder, options, measure);
}

} // namespace gimg::gimenc

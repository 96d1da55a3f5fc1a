#pragma once

#include "coded_file.h"
#include "gimg/encode.h"

namespace gimg {

/// How near to its target a search has to come. Looser ones are for files that only tell a step.
enum class Precision
{
    Step, ///< within a decibel
    File, ///< as EncodeTarget promises
};

/// The quality that a goal is about, in dB: the PSNR, or that of the largest error, -20 log10.
double quality(const CodedFile& file, EncodeTarget target);
/// What the goal asks for, in the same unit. Psnr and MaxError only.
double askedQuality(const EncodeGoal& goal);
/// The step of a file that just meets the goal, guessed from one that is better.
float stepToMeet(const EncodeGoal& goal, const CodedFile& file);
/// "70.00 dB", "a largest error of 0.001"
std::string describeQuality(double quality, EncodeTarget target);

/// How normals and attributes are coded where the goal is not a number of bytes.
codec::Settings fieldSettings(const EncodeGoal& goal);

/// The smallest file found that meets a goal of a lossy target.
/// Errors: TargetUnreachable, says what can be reached.
Result<CodedFile> codeFor(const EncodeGoal& goal, Precision precision, const codec::Encoder& encoder,
                          const SurfaceMeasure& measure, const EncodeProgress& progress);

/// Raw12 and RawFloat.
Result<CodedFile> codeRaw(EncodeTarget target, const codec::Encoder& encoder, const SurfaceMeasure& measure);

} // namespace gimg

#pragma once

#include "coded_file.h"
#include "effort.h"
#include "grid_encoders.h"

#include "gimg/encode.h"

namespace gimg {

/// Codes the samples of one grid for a goal, and lets them slide along the surface for it.
/// @param sampled  of `encoders`
/// Where prefixes count too, it keeps the file that is nearest to those made for its bytes, for half of them
/// and for a quarter, where it is farthest from them.
Result<CodedFile> codeSliding(const Effort& effort, GridEncoders& encoders,
                              const GridEncoders::Sampled& sampled, const SurfaceMeasure& measure,
                              const EncodeGoal& goal, const EncodeProgress& progress);

} // namespace gimg

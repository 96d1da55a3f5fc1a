#pragma once

#include "bench_run.h"

namespace gimg::gimrd {

/// The mesh after repair, as adapters read it.
Status writeInput(const Bench& bench);

/// gimg from the mesh to the file; mesh coders on the same mesh, whole.
Status measureEncoding(Bench& bench);

Status measureDecoderMemory(Bench& bench);

/// gimg and mesh coders on the mesh that the file decodes to, image coders on its geometry image.
Status measureDecoding(Bench& bench);

/// Meshes of more faces; what fails is recorded.
void measureScaling(Bench& bench);

/// Files of other grids; what fails is recorded.
void measureDecodeScaling(Bench& bench);

} // namespace gimg::gimrd

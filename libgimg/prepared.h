#pragma once

#include "effort.h"
#include "grid_encoders.h"

#include "gimg/encode.h"

#include <tbb/global_control.h>

#include <optional>

namespace gimg {

struct MeshEncoder::Prepared
{
    EncodedMesh report; ///< all but what coding adds
    bool features;      ///< EncodeOptions::features
    bool anyGrid;       ///< whether the goal may choose the grid
    Effort effort;
    std::unique_ptr<GridEncoders> encoders;
    SurfaceMeasure measure;
    EncodeProgress progress;
    int threads;
};

/// As many threads as asked for while it lives.
class ThreadLimit
{
public:
    explicit ThreadLimit(int threads)
    {
        if (threads > 0)
            limit_.emplace(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
    }

private:
    std::optional<tbb::global_control> limit_;
};

/// What is wrong with the options that do not depend on the surface.
std::optional<Error> objectionTo(const EncodeOptions& options);

/// Samples are float32: what they cannot hold is refused, what they hold badly is said.
Status checkScale(const Mesh& mesh, std::vector<std::string>& warnings);

} // namespace gimg

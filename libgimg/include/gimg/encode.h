#pragma once

#include "gimg/border.h"
#include "gimg/features.h"
#include "gimg/linear_maps.h"
#include "gimg/mesh.h"
#include "gimg/result.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gimg {

/// What a file is made for.
enum class EncodeTarget
{
    Bytes,    ///< lossy, at most EncodeOptions::bytes
    Psnr,     ///< lossy, at least EncodeOptions::psnr and at most 0.5 dB more
    Raw12,    ///< 12-bit integers
    RawFloat, ///< float32 samples without loss
};

/// Called with the name of the stage and the fraction of it that is done.
using EncodeProgress = std::function<void(const char* stage, double fraction)>;

/// How Bytes and Psnr are coded.
enum class LossyCoding
{
    Surface, ///< along normals and tangents, across the seam; samples slide
    Wavelet, ///< x, y and z on their own, both sides of the seam, which the decoder fuses (thesis, 3.2)
};

struct EncodeGoal
{
    EncodeTarget target = EncodeTarget::Bytes;
    size_t bytes = 12000; ///< size of the whole file
    double psnr = 70;     ///< surface PSNR in dB, see SurfaceDistance::psnr
    LossyCoding coding = LossyCoding::Surface;
};

struct EncodeOptions : EncodeGoal
{
    static constexpr int kLargestFit = 1025; ///< larger grids are not fitted: it would take gigabytes

    /// Samples a side, 2^j + 1. 0 chooses: for a number of bytes the grid grows from 129 to 513 as long as a
    /// finer one is worth half a decibel, for a PSNR it is the smallest whose samples hold 6 dB more (1025
    /// where 513 does not reach it), and raw grids have 257. It is never smaller than what the cut needs.
    int grid = 0;
    int lowest = 0; ///< lowest level of detail; 0 chooses
    SquareLayout layout = SquareLayout::Auto;
    int normals = 0; ///< samples a side of the normal image, 2^j + 1; 0: none
    int threads = 0; ///< 0: one a core. The file does not depend on it.
    EncodeProgress progress;
    MapKind param = MapKind::Stretch; ///< how the surface is mapped to the square
    Density density = Density::Curvature;
    bool fit = true; ///< move the samples to where the triangles between them fit the mesh, see fitGeometry
    bool features = false; ///< lay grid lines along sharp edges, see followFeatures; needs `fit`.
                           ///< For bytes or a PSNR without FeatureOptions::ease
};

/// What the fit is worth: PSNR of the triangles between the samples, before anything is lost in coding.
struct FitGain
{
    double psnrBefore = 0, psnrAfter = 0;
};

struct EncodeSeconds
{
    double cut = 0, parameterize = 0, sample = 0, fit = 0, code = 0;
};

struct EncodedMesh
{
    std::vector<uint8_t> file;
    Topology topology; ///< of the input
    int grid = 0;
    int lowest = 0;
    int normals = 0;
    double psnr =
        0; ///< of the decoded finest level against the input; infinite if they agree, 0 if nothing is left
    double stretchEfficiency = 0; ///< see stretchEfficiency()
    MapKind param = MapKind::Stretch;
    SquareLayout layout = SquareLayout::Cut; ///< Cut or Octahedral
    int cutNodes = 0;
    int cutPaths = 0;
    int cutExtrema = 0;         ///< tips that the cut was extended to
    std::optional<FitGain> fit; ///< none: not asked for, or a grid above EncodeOptions::kLargestFit
    std::optional<FeatureReport> features; ///< none: not asked for, or a grid that is not fitted
    double cutLength = 0;                  ///< of the seam and the boundary as sampled, in the mesh's unit
    EncodeSeconds seconds;
    std::vector<std::string> warnings;
};

/// The whole road: cut, layout, flattening, sampling, coding.
/// @param mesh  connected, manifold, oriented (see readMesh)
/// Errors: BadArgument; TargetUnreachable (says what can be reached); those of the stages.
Result<EncodedMesh> encodeMesh(const Mesh& mesh, const EncodeOptions& options);

/// A mesh that is cut, flattened and sampled once, for as many goals as are asked for.
class MeshEncoder
{
public:
    /// @param mesh  as for encodeMesh; not needed any more afterwards
    /// The goal in `options` does not matter here. Errors: BadArgument; those of the stages.
    static Result<MeshEncoder> prepare(const Mesh& mesh, const EncodeOptions& options);
    ~MeshEncoder();
    MeshEncoder(MeshEncoder&&) noexcept;
    MeshEncoder& operator=(MeshEncoder&&) noexcept;

    /// The same file that encodeMesh makes. Errors: BadArgument, TargetUnreachable.
    Result<EncodedMesh> encode(const EncodeGoal& goal) const;

private:
    Result<EncodedMesh> encodeAt(int grid, const EncodeGoal& goal, bool lossy) const;
    Result<EncodedMesh> encodeAtBestGrid(const EncodeGoal& goal) const;
    Result<EncodedMesh> encodeAtAmpleGrid(const EncodeGoal& goal) const;
    struct Prepared;
    explicit MeshEncoder(std::unique_ptr<const Prepared> prepared);
    std::unique_ptr<const Prepared> prepared_;
};

} // namespace gimg

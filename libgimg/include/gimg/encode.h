#pragma once

#include "gimg/border.h"
#include "gimg/features.h"
#include "gimg/image_io.h"
#include "gimg/image_seam.h"
#include "gimg/linear_maps.h"
#include "gimg/mesh.h"
#include "gimg/result.h"
#include "gimg/vertex_attribute.h"

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
    Bytes,    ///< lossy, at most EncodeGoal::bytes
    Psnr,     ///< lossy, at least EncodeGoal::psnr and at most 0.2 dB more
    MaxError, ///< lossy, no part of either surface farther from the other than EncodeGoal::maxError, and more
              ///< than 0.98 of that where the step decides it (a warning says where it does not)
    Raw12,    ///< 12-bit integers
    RawFloat, ///< float32 samples without loss
};

/// Called with the name of the stage and the fraction of it that is done.
using EncodeProgress = std::function<void(const char* stage, double fraction)>;

/// How lossy files are coded.
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
    double maxError = 0.001; ///< fraction of the diagonal, see SurfaceDistance::hausdorff
};

/// An attribute that is to go into the file.
///
/// Of the bytes that are neither container nor seam normals get a quarter and each attribute that is not
/// lossless an eighth, all of them together at most a half; lossless ones take what they need first. Where
/// the goal is a quality, normals have a step of 1/32 and attributes of 1/64 of the span of their values. In
/// raw files attributes are lossless.
struct AttributeRequest
{
    std::string name;
    int grid = 0;          ///< samples a side, 2^k + 1; 0: as many as the geometry has
    bool lossless = false; ///< the samples come back as they are
};

struct EncodeOptions : EncodeGoal
{
    static constexpr int kLeastEffort = 1, kMostEffort = 9;
    static constexpr int kLargestFit = 1025; ///< larger grids are not fitted: it would take gigabytes

    /// Samples a side, 2^j + 1. 0 chooses: for a number of bytes the grid grows from 129 to 513 as long as a
    /// finer one is worth a quarter of a decibel (see docs/effort.md), for a PSNR or largest error it is the
    /// smallest whose samples hold 6 dB more, half as much (1025 where 513 does not reach it), and raw grids
    /// have 257. It is never smaller than what the cut needs.
    int grid = 0;
    int lowest = 0; ///< lowest level of detail; 0 chooses
    SquareLayout layout = SquareLayout::Auto;
    int normals = 0; ///< samples a side of the normal image, 2^j + 1; 0: none
    std::vector<AttributeRequest> attributes;
    const AttributedSurface* attributed = nullptr; ///< what has them, see MeshFile; for encodeMesh alone. Not
                                                   ///< needed any more when the encoder is prepared.
    int threads = 0;                               ///< 0: one a core. The file does not depend on it.
    EncodeProgress progress;
    /// How the surface is mapped to the square. Conformal needs a closed surface of genus 0, comes in the
    /// octahedral layout, and knows no density.
    MapKind param = MapKind::Stretch;
    Density density = Density::Curvature;
    bool fit = true; ///< move the samples to where the triangles between them fit the mesh, see fitGeometry
    bool features = false; ///< lay grid lines along sharp edges, see followFeatures; needs `fit`.
                           ///< For lossy files without FeatureOptions::ease
    /// So many of the finest levels hold no details, but lie smoothly between the samples of the coarser
    /// ones: a fine mesh of few bytes. Without, details are left out where they are not worth their bytes.
    int smoothLevels = 0;
    int effort = 7; ///< 1 to 9: time for quality, see docs/effort.md
    /// Files are chosen by what half and a quarter of them are worth, too, and samples slide for those:
    /// prefixes come within about a decibel of files made for their bytes, and so does the whole
    /// (docs/codec.md). For numbers of bytes; takes ten times as long, with an effort of 6 or less three
    /// times. Any file of the surface coding can be cut short.
    bool progressive = false;
    /// What PSNR and errors are against, while the encoder is prepared; null: the mesh itself.
    const Mesh* reference = nullptr;
};

/// What the fit is worth: PSNR of the triangles between the samples, before anything is lost in coding.
struct FitGain
{
    double psnrBefore = 0, psnrAfter = 0;
};

/// How the border of a geometry image is glued, see findImageSeam.
struct FoundSeam
{
    int sides = 0, paths = 0, nodes = 0; ///< of the seam's word
    int steps = 0, glued = 0;            ///< of the border, and how many of them have a mate
    double widestGap = 0;                ///< that was closed, as a fraction of the diagonal
    std::string objection;               ///< why samples that coincide are not glued; else empty
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
    double maxError = 0; ///< of the same, as a fraction of the diagonal, see SurfaceDistance::hausdorff
    double stretchEfficiency = 0; ///< see stretchEfficiency()
    MapKind param = MapKind::Stretch;
    SquareLayout layout = SquareLayout::Cut; ///< Cut or Octahedral
    int cutNodes = 0;
    int cutPaths = 0;
    int cutExtrema = 0;         ///< tips that the cut was extended to
    std::optional<FitGain> fit; ///< none: not asked for, or a grid above EncodeOptions::kLargestFit
    std::optional<FeatureReport> features; ///< none: not asked for, or a grid that is not fitted
    std::optional<FoundSeam> image;        ///< none: of a mesh, whose cut is known
    double cutLength = 0;                  ///< of the seam and the boundary as sampled, in the mesh's unit
    EncodeSeconds seconds;
    std::vector<std::string> warnings;
};

/// The whole road: cut, layout, flattening, sampling, coding.
/// @param mesh  connected, manifold, oriented (see readMesh)
/// Errors: BadArgument; TargetUnreachable (says what can be reached); those of the stages.
Result<EncodedMesh> encodeMesh(const Mesh& mesh, const EncodeOptions& options);

/// The same for a surface that comes as a geometry image: its seam is found, see findImageSeam, and its
/// grid's triangles, open and as they are, are what PSNR and errors are against.
/// @param options    `grid` is 0 or the image's; layout, param, density, fit and features do not apply
/// @param tolerance  see ImageSeamOptions
/// Errors: as findImageSeam and encodeMesh. A border that is coded as open is among the warnings.
Result<EncodedMesh> encodeImage(const FloatImage& image, const EncodeOptions& options,
                                double tolerance = kSeamTolerance);

/// A surface that is cut, flattened and sampled once, for as many goals as are asked for.
class MeshEncoder
{
public:
    /// @param mesh  as for encodeMesh; not needed any more afterwards
    /// The goal in `options` does not matter here. Errors: BadArgument; those of the stages.
    static Result<MeshEncoder> prepare(const Mesh& mesh, const EncodeOptions& options);
    /// The same of encodeImage.
    static Result<MeshEncoder> prepareImage(const FloatImage& image, const EncodeOptions& options,
                                            double tolerance = kSeamTolerance);
    ~MeshEncoder();
    MeshEncoder(MeshEncoder&&) noexcept;
    MeshEncoder& operator=(MeshEncoder&&) noexcept;

    /// The same file that encodeMesh makes. Errors: BadArgument, TargetUnreachable.
    Result<EncodedMesh> encode(const EncodeGoal& goal) const;

private:
    Result<EncodedMesh> encodeAt(int grid, const EncodeGoal& goal, bool lossy) const;
    Result<EncodedMesh> encodeAt(int grid, const EncodeGoal& goal, bool lossy, bool isTrial) const;
    Result<EncodedMesh> encodeAtBestGrid(const EncodeGoal& goal) const;
    Result<EncodedMesh> encodeAtAmpleGrid(const EncodeGoal& goal) const;
    struct Prepared;
    explicit MeshEncoder(std::unique_ptr<const Prepared> prepared);
    std::unique_ptr<const Prepared> prepared_;
};

} // namespace gimg

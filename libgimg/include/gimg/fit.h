#pragma once

#include "gimg/distance.h"
#include "gimg/image_io.h"
#include "gimg/mesh.h"
#include "gimg/result.h"

#include <gim.h>

#include <vector>

namespace gimg {

/// How the border of a geometry image is glued: SquareDisk::lowest, start and seam().
struct GridSeam
{
    int lowest = 0; ///< samples a side of the lowest level, 2^l + 1
    int start = 0;  ///< border position where the first side begins, in steps of that grid
    std::vector<gim_side> sides;
};

struct FitOptions
{
    int rounds = 3;         ///< 1 to 100
    double smoothing = 0.7; ///< 0 to 1: how far samples follow the middle of their neighbours along the mesh
    int threads = 0;        ///< at most one a core; 0: as many
};

struct FittedGeometry
{
    FloatImage image;
    double psnrBefore = 0; ///< of the decoder's triangles against the mesh, see SurfaceDistance::psnr
    double psnrAfter = 0;  ///< not below psnrBefore; the same where the image came back unchanged
};

/// Moves the samples of a geometry image so that the triangles that the decoder spans between them lie as
/// close to the mesh as possible, in the mean of the squared distances both ways. Samples then lie a little
/// off the mesh: on the outer side where it bulges. They may slide along it, and come to lie on sharp edges.
/// Glued samples stay equal, samples on the surface's own boundary stay where they are, and no cell folds
/// over. The numbers do not depend on the threads.
/// @param image  square, one side 2^j + 1 samples, close to the mesh; glued samples equal
/// Errors: BadArgument (options, the seam, a size that does not fit it, glued samples that differ),
/// NotFinite, EmptyMesh.
/// Source: H. Pottmann, M. Hofer, Geometry of the squared distance function to curves and surfaces,
/// Visualization and Mathematics III, 2003 (the distance to the tangent plane, with a little of that to the
/// point, as a model of the squared distance).
Result<FittedGeometry> fitGeometry(const Mesh& mesh, const FloatImage& image, const GridSeam& seam,
                                   const FitOptions& options = {});

/// The same where a measure of the mesh is at hand.
Result<FittedGeometry> fitGeometry(const Mesh& mesh, const SurfaceMeasure& measure, const FloatImage& image,
                                   const GridSeam& seam, const FitOptions& options = {});

/// The normals that belong to fitted samples: of the mesh at its point nearest to where a sample of the
/// normal image lies on the decoder's triangles, area-weighted at the vertices and interpolated. Where that
/// faces away from the normal that the image has, the latter stays.
/// @param geometry  fitted, of any size that fits the seam
/// @param normals   as sampled before the fit, see sampleNormals; its size fits the seam too
/// Errors: as fitGeometry.
Result<FloatImage> fitNormals(const Mesh& mesh, const FloatImage& geometry, const GridSeam& seam,
                              const FloatImage& normals);

} // namespace gimg

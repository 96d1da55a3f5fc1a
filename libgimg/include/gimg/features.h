#pragma once

#include "gimg/fit.h"

namespace gimg {

struct FeatureOptions
{
    double angle = 40; ///< degrees between the normals of two faces from which on their edge is sharp
    double shortest =
        4; ///< loose ends and pieces below this length, in mean spacings of the grid, do not count
    /// At last move single samples where grid and mesh are farthest apart. The grid is much closer for it,
    /// but less even: what is to be coded with loss is better off without.
    bool ease = true;
    int rounds = 4;         ///< 1 to 100
    double smoothing = 0.7; ///< as FitOptions::smoothing
    int threads = 0;        ///< at most one a core; 0: as many
};

/// What was found on the mesh and done to the grid. Lengths are in the unit of the mesh.
struct FeatureReport
{
    double length = 0; ///< of all creases; 0: there is none, and the image came back unchanged
    int creases = 0;   ///< chains of sharp edges from corner to corner
    int corners = 0;   ///< where three creases or more meet, or one turns by more than 40 degrees
    bool kept = false; ///< false: no grid was found that is closer, and the image came back unchanged
    int onCreases = 0; ///< vertices of the grid that were laid on creases, and could slide along them
    int onCorners = 0; ///< those on corners
    int crossings = 0; ///< edges of the decoder's triangles that still cross a crease
    double psnrBefore = 0, psnrAfter = 0; ///< of the decoder's triangles, see SurfaceDistance::psnr
    double maxBefore = 0, maxAfter = 0;   ///< see SurfaceDistance::hausdorff
};

struct FeatureGeometry
{
    FloatImage image;
    FeatureReport report;
};

/// Lays grid lines along the sharp edges of a mesh: where an edge of the decoder's triangles crosses a
/// crease, one of its ends moves to the crossing, and every corner of the creases gets a sample. Then all
/// samples are fitted as by fitGeometry, those on creases moving along them only; and so on in rounds. Of
/// these the one with the smallest maximal distance is returned, or the image as it was if no other has one
/// as small and a PSNR as high. Glued samples stay equal, samples on the surface's own boundary stay where
/// they are. The numbers do not depend on the threads.
/// @param mesh   edge-manifold, oriented
/// @param image  square, one side 2^j + 1 samples, close to the mesh (best fitted); glued samples equal
/// Errors: BadArgument (options, the seam, a size that does not fit it, glued samples that differ),
/// NotFinite, EmptyMesh.
/// Source: thesis, section 3.4, asks for such a pass. J. Vorsatz, C. Roessl, L. Kobbelt, H.-P. Seidel,
/// Feature sensitive remeshing, Eurographics 2001 (vertices snapped to features, relaxed in between).
Result<FeatureGeometry> followFeatures(const Mesh& mesh, const FloatImage& image, const GridSeam& seam,
                                       const FeatureOptions& options = {});

/// The same where a measure of the mesh is at hand.
Result<FeatureGeometry> followFeatures(const Mesh& mesh, const SurfaceMeasure& measure,
                                       const FloatImage& image, const GridSeam& seam,
                                       const FeatureOptions& options = {});

} // namespace gimg

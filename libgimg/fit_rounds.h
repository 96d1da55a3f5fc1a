#pragma once

#include "grid_surface.h"

namespace gimg {

/// Rounds of the fit of grids to one mesh. What is made of the mesh is kept from run to run.
class FitRounds
{
public:
    /// @param mesh    its triangles must be without objection (see objectionToTriangles)
    /// @param pixels  of the images to come, about
    /// May throw what Embree does.
    FitRounds(const Mesh& mesh, int pixels);

    /// @param smoothing  see FitOptions
    FloatImage run(const GluedGrid& grid, const FloatImage& image, int rounds, double smoothing);

private:
    UnitFrame frame_;
    SurfacePull pull_;
};

} // namespace gimg

#pragma once

#include "results.h"
#include "sweep_folder.h"

#include "gimg/result.h"

#include <string>
#include <vector>

namespace gimg::gimrd {

/// How a series looks in every plot and table of a sweep.
struct LineStyle
{
    std::string color; ///< "#d55e00"
    double width = 1;  ///< ours are wider
    int point = 7;     ///< gnuplot's point type
};
std::vector<LineStyle> lineStyles(const SweepResults& results);

/// Draws curves/MESH.svg and .png for each mesh, PSNR over bytes on a log2 axis, and mean.svg and .png where
/// there are several meshes. A mesh without a finite point has no curves.
/// Errors: CodecFailure if gnuplot fails; FileNotWritable.
Status drawCurves(const SweepResults& results, SweepFolder& folder);

/// The Debian package that drawCurves() needs and that is not there; empty if all is well.
std::string missingForCurves();

} // namespace gimg::gimrd

#pragma once

#include "results.h"
#include "sweep_folder.h"

#include <string>

namespace gimg::gimrd {

/// The report as one HTML file that needs no other: tables, the curves that drawCurves() left in the folder,
/// Bjontegaard deltas, and the thumbnails.
std::string reportHtml(const SweepResults& results, const SweepFolder& folder);

} // namespace gimg::gimrd

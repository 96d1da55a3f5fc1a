#pragma once

#include "point.h"
#include "sweep_folder.h"
#include "sweep_plan.h"

#include "gimg/result.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace gimg::gimrd {

struct RunOptions
{
    int jobs = 1; ///< at a time; each coder gets its share of the cores
    int samples = 200000;
    bool keep = false; ///< the decoded meshes too
};

/// The SHA-256 of each mesh's file; empty where it cannot be read, and of a mesh that `wanted` leaves out.
std::vector<std::string> hashMeshes(const SweepPlan& plan, const std::vector<bool>& wanted);

/// The point of a job at a size that stands in the folder, if it is of this mesh file and these samples. A
/// failed one counts, so that tables can show it.
std::optional<Point> storedPoint(const SweepFolder& folder, const SweepPlan& plan, const Job& job,
                                 size_t size, const std::string& sha256, int samples);

/// Makes the points of these jobs that are not there yet, or failed, and writes each as soon as it is known.
/// Says on standard error how far it is. A job whose coder is not installed is left out.
/// @param hashes  as hashMeshes
/// @return whether every coder ended as it should; points that failed say so themselves
/// Errors: FileNotWritable.
Result<bool> runJobs(const SweepPlan& plan, const std::vector<size_t>& jobs,
                     const std::vector<std::string>& hashes, SweepFolder& folder, const RunOptions& options);

} // namespace gimg::gimrd

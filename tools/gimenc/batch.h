#pragma once

#include "arguments.h"

#include <string>

namespace gimg::gimenc {

struct BatchOptions
{
    std::string list; ///< empty: one file is made, not a list
    int jobs = 1;     ///< at a time
    cli::Part part;
    std::string summary; ///< table to write when the jobs have ended
    std::string merge;   ///< table to write instead of running jobs
};

void addBatchOptions(CLI::App& app, BatchOptions& batch);

/// Runs the jobs of a list, or of one part of it, that are not finished. Returns the exit status: Done if all
/// are, Refused if one failed, Usage if nothing was begun because the list cannot be run.
int runBatch(const Arguments& defaults, const BatchOptions& batch);

} // namespace gimg::gimenc

#pragma once

#include "list.h"

#include <vector>

namespace gimg::gimenc {

struct Counts
{
    int done = 0, failed = 0, pending = 0;
};

/// Whether a summary can be written under this name: .csv or .json.
bool isSummaryName(const std::string& path);

/// Writes a table of what the records of all jobs say, one row a job in the order of the list. Reads records
/// only, so that it can be made anywhere and at any time. Errors: FileNotWritable.
Result<Counts> writeSummary(const std::string& path, const std::vector<Job>& jobs);

} // namespace gimg::gimenc

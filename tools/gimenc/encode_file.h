#pragma once

#include "arguments.h"

namespace gimg::gimenc {

/// Makes one file, as the command line asks, and says on the terminal what was made or what is wrong.
/// Returns the exit status.
int encodeFile(const Arguments& a);

} // namespace gimg::gimenc

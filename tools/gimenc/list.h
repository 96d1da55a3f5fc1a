#pragma once

#include "arguments.h"

#include <string>
#include <string_view>
#include <vector>

namespace gimg::gimenc {

struct ListLine
{
    int number = 0; ///< from 1
    std::vector<std::string> words;
};

/// Splits a list into words as a shell does: blanks separate; between single quotes all is kept, between
/// double quotes all but a backslash before a double quote, backslash, dollar or backquote; a backslash
/// elsewhere keeps the character after it; # at the start of a word begins a comment. Nothing is expanded.
/// Lines without a word are left out. Errors: BadArgument, names the line.
Result<std::vector<ListLine>> splitList(std::string_view text);

/// A line of a list.
struct Job
{
    int line = 0;
    Arguments arguments;
};

/// The jobs of a list, a file or - for standard input, ready to be run in any order: no OUTPUT and no record
/// is another one's, or an INPUT. Errors: FileNotReadable; BadArgument, names the line.
Result<std::vector<Job>> readJobs(const std::string& list, const Arguments& defaults);

} // namespace gimg::gimenc

#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace gimg::gimrd {

/// A subcommand and what it does; the result is the exit status of the program.
struct Command
{
    CLI::App* parser;
    std::function<int()> run;
};

Command addBench(CLI::App& app);
Command addCompare(CLI::App& app);
Command addSweep(CLI::App& app);

} // namespace gimg::gimrd

#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace gimg::gimparam {

/// A subcommand and what it does; the result is the exit status of the program.
struct Command
{
    CLI::App* parser;
    std::function<int()> run;
};

Command addSquare(CLI::App& app);

} // namespace gimg::gimparam

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

Command addHolomorphic(CLI::App& app);
Command addHomology(CLI::App& app);
Command addPeriods(CLI::App& app);
Command addSphere(CLI::App& app);
Command addSquare(CLI::App& app);
Command addUv(CLI::App& app);

} // namespace gimg::gimparam

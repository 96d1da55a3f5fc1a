// gimrd: measures how far surfaces are apart, and rate against distortion.
#include "command.h"

#include "../cli.h"

#include <CLI/App.hpp>

#include <vector>

int main(int argc, char** argv)
{
    using namespace gimg::gimrd;
    CLI::App app("Measures surfaces against each other, and rate against distortion.", "gimrd");
    app.set_version_flag("--version", GIMG_VERSION);
    app.require_subcommand(1);
    std::vector<Command> commands = {addCompare(app)};
#ifdef GIMG_WITH_ADAPTERS
    commands.push_back(addSweep(app));
    commands.push_back(addBench(app));
#endif

    if (const std::optional<int> exit = gimg::cli::parse(app, argc, argv)) return *exit;
    for (const Command& command : commands)
        if (command.parser->parsed()) return command.run();
    return gimg::cli::Usage;
}

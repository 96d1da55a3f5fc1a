// gimparam: maps of a surface to the plane, the square and the sphere, and what its conformal structure
// tells.
#include "command.h"

#include "../cli.h"

#include <CLI/App.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace {

// `gimparam INPUT OUTPUT` means `gimparam square INPUT OUTPUT`.
bool namesCommand(const CLI::App& app, const std::string& word)
{
    if (word == "-h" || word == "--help" || word == "--version") return true;
    const std::vector<const CLI::App*> commands = app.get_subcommands([](const CLI::App*) { return true; });
    return std::any_of(commands.begin(), commands.end(),
                       [&word](const CLI::App* command) { return command->get_name() == word; });
}

} // namespace

int main(int argc, char** argv)
{
    using namespace gimg::gimparam;
    CLI::App app("Maps triangle meshes (OBJ, PLY, OFF, STL) to the plane, the square and the sphere, and "
                 "computes their conformal structure.",
                 "gimparam");
    app.footer("gimparam INPUT OUTPUT is short for gimparam square INPUT OUTPUT.\n"
               "Exit codes: 0 done, 1 input refused, 2 usage, 3 target not reachable.");
    app.set_version_flag("--version", GIMG_VERSION);
    app.require_subcommand(1);
    const std::vector<Command> commands = {addSphere(app),  addHomology(app), addHolomorphic(app),
                                           addPeriods(app), addUv(app),       addSquare(app)};

    std::vector<char*> words(argv, argv + argc);
    std::string square = "square";
    if (argc > 1 && !namesCommand(app, argv[1])) words.insert(words.begin() + 1, square.data());
    if (const std::optional<int> exit = gimg::cli::parse(app, static_cast<int>(words.size()), words.data()))
        return *exit;
    for (const Command& command : commands)
        if (command.parser->parsed()) return command.run();
    return gimg::cli::Usage;
}

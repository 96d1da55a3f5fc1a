#include "input.h"

#include <nlohmann/json.hpp>

#include <iostream>

namespace gimg::gimparam {

void addInput(CLI::App& command, Input& input)
{
    command.add_option("INPUT", input.path, "mesh (OBJ, PLY, OFF, STL)")->required();
    command.add_option("--component", "of several components take the largest")
        ->check(CLI::IsMember({"largest"}))
        ->each([&input](const std::string&) { input.read.largestComponent = true; });
    addChoice<Weld>(command, "--weld",
                    {{"auto", Weld::Auto}, {"always", Weld::Always}, {"never", Weld::Never}}, input.read.weld,
                    "merge vertices at equal positions: auto (where that harms nothing), always, never");
    command.add_option("--json", input.json, "write a report to this file, or - for standard output");
    command.add_flag("--quiet", input.quiet, "print nothing but errors");
}

Result<MeshFile> readInput(const Input& input)
{
    Result<MeshFile> file = readMesh(input.path, input.read);
    if (file || file.error().kind != ErrorKind::SeveralComponents) return file;
    return Error{file.error().kind, file.error().message + "; --component largest takes the largest"};
}

void printWarnings(const Input& input, const MeshFile& file)
{
    if (input.quiet) return;
    for (const std::string& warning : warnings(file.report)) std::cerr << "gimparam: " << warning << '\n';
}

int finish(const Input& input, const MeshFile& file, const nlohmann::ordered_json& report)
{
    printWarnings(input, file);
    if (!input.json.empty() && !cli::writeJson(input.json, report))
        return cli::fail("gimparam", cli::Refused, input.json + ": cannot be written");
    return cli::Done;
}

int failWith(const Error& error, const std::string& path)
{
    const auto code = [&error] {
        if (error.kind == ErrorKind::TargetUnreachable) return cli::Unreachable;
        const bool usage = error.kind == ErrorKind::BadArgument || error.kind == ErrorKind::FormatUnknown;
        return usage ? cli::Usage : cli::Refused;
    };
    return cli::fail("gimparam", code(), path.empty() ? error.message : path + ": " + error.message);
}

} // namespace gimg::gimparam

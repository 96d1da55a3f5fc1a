// gimenc: a mesh becomes a .gim file, or a list of meshes many.
#include "arguments.h"
#include "batch.h"
#include "encode_file.h"

#include <CLI/App.hpp>

namespace {

using namespace gimg;
using namespace gimg::gimenc;

// What the parser cannot see: a list stands in place of INPUT and OUTPUT.
std::optional<std::string> wrong(const Arguments& a, const BatchOptions& batch)
{
    if (batch.list.empty()) return missing(a);
    if (!a.input.empty()) return a.input + ": with --batch files are named in the list";
    if (!a.json.empty()) return "--json: with --batch each line's report is its OUTPUT.json";
    return std::nullopt;
}

} // namespace

int main(int argc, char** argv)
{
    Arguments a;
    BatchOptions batch;
    CLI::App app{"Encodes a triangle mesh (OBJ, PLY, OFF, STL) as a .gim geometry image file.\n"
                 "With --batch LIST, which takes the place of INPUT and OUTPUT, many of them.",
                 "gimenc"};
    app.footer("Exit codes: 0 done, 1 input refused or a line failed, 2 usage, 3 target not reachable.");
    app.set_version_flag("--version", GIMG_VERSION);
    addFiles(app, a);
    addOptions(app, a);
    addBatchOptions(app, batch);
    if (const std::optional<int> code = cli::parse(app, argc, argv)) return *code;
    if (const auto what = wrong(a, batch)) return cli::fail("gimenc", cli::Usage, *what + " (try --help)");
    return batch.list.empty() ? encodeFile(a) : runBatch(a, batch);
}

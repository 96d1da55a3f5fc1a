// gimg_baseline: bytes and decibels of meshes and settings, beside those of bench/baseline.csv.
#include "tools/cli.h"

#include "corpus/shapes.h"
#include "gimg/encode.h"
#include "gimg/mesh_io.h"

#include <CLI/App.hpp>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

namespace {

using namespace gimg;

constexpr double kMostDecibels = 0.1;
constexpr double kMostBytes = 0.005;

// One line of the table: "mesh,grid,goal,bytes,psnr", the goal "bytes 3000", "psnr 60", or "raw 12".
struct Row
{
    std::string mesh;
    int grid = 0; // 0: automatic
    std::string goal;
    size_t bytes = 0;
    double psnr = 0;
};

std::string csv(const Row& row)
{
    char numbers[64];
    std::snprintf(numbers, sizeof numbers, "%zu,%.3f", row.bytes, row.psnr);
    return row.mesh + ',' + std::to_string(row.grid) + ',' + row.goal + ',' + numbers;
}

std::optional<Row> parseRow(const std::string& line)
{
    std::istringstream in(line);
    Row row;
    std::string grid, bytes, psnr;
    if (!std::getline(in, row.mesh, ',') || !std::getline(in, grid, ',') ||
        !std::getline(in, row.goal, ',') || !std::getline(in, bytes, ',') || !std::getline(in, psnr))
        return std::nullopt;
    if (!CLI::detail::lexical_cast(grid, row.grid) || !CLI::detail::lexical_cast(bytes, row.bytes) ||
        !CLI::detail::lexical_cast(psnr, row.psnr))
        return std::nullopt;
    return row;
}

std::optional<EncodeGoal> parseGoal(const std::string& text)
{
    std::istringstream in(text);
    std::string kind;
    EncodeGoal goal;
    in >> kind;
    if (kind == "bytes") {
        goal.target = EncodeTarget::Bytes;
        in >> goal.bytes;
    } else if (kind == "psnr") {
        goal.target = EncodeTarget::Psnr;
        in >> goal.psnr;
    } else if (kind == "raw") {
        int bits = 0;
        in >> bits;
        if (bits != 12) return std::nullopt;
        goal.target = EncodeTarget::Raw12;
    } else {
        return std::nullopt;
    }
    return in ? std::optional(goal) : std::nullopt;
}

// A mesh of the corpus, or one of our own shapes, "shape:torus".
Result<Mesh> meshNamed(const std::string& name, const std::string& cache)
{
    if (name == "shape:torus") return shapes::torus(3, 1, 96, 48);
    if (name == "shape:wavy-sphere") return shapes::wavySphere(1, 0.3, 5, 32);
    for (const char* kind : {".off", ".obj", ".ply", ".stl"}) {
        const std::string path = cache + '/' + name + kind;
        if (!std::filesystem::exists(path)) continue;
        Result<MeshFile> read = readMesh(path);
        if (!read) return read.error();
        return std::move(read->mesh);
    }
    return Error{ErrorKind::FileNotReadable,
                 name + " is not in " + cache + " (corpus/fetch " + name + " brings it)"};
}

Result<std::vector<Row>> readTable(const std::string& path)
{
    std::ifstream in(path);
    std::vector<Row> rows;
    std::string line;
    std::getline(in, line); // the titles
    while (std::getline(in, line)) {
        const std::optional<Row> row = parseRow(line);
        if (!row || !parseGoal(row->goal))
            return Error{ErrorKind::FileCorrupt, path + ": cannot make sense of: " + line};
        rows.push_back(*row);
    }
    if (rows.empty()) return Error{ErrorKind::FileNotReadable, path + ": no rows"};
    return rows;
}

// The row as it comes out now. Consecutive rows of one mesh and grid share the preparation.
class Runner
{
public:
    explicit Runner(std::string cache) : cache_(std::move(cache)) {}

    Result<Row> now(const Row& row)
    {
        if (!encoder_ || row.mesh != mesh_ || row.grid != grid_) {
            const Result<Mesh> mesh = meshNamed(row.mesh, cache_);
            if (!mesh) return mesh.error();
            EncodeOptions options;
            options.grid = row.grid;
            options.effort = 6; // refits cost most of the time, and would even out what a change does
            Result<MeshEncoder> encoder = MeshEncoder::prepare(*mesh, options);
            if (!encoder) return Error{encoder.error().kind, row.mesh + ": " + encoder.error().message};
            encoder_.emplace(std::move(*encoder));
            mesh_ = row.mesh;
            grid_ = row.grid;
        }
        const Result<EncodedMesh> encoded = encoder_->encode(*parseGoal(row.goal));
        if (!encoded) return Error{encoded.error().kind, row.mesh + ": " + encoded.error().message};
        Row out = row;
        out.bytes = encoded->file.size();
        out.psnr = encoded->psnr;
        return out;
    }

private:
    std::string cache_, mesh_;
    int grid_ = 0;
    std::optional<MeshEncoder> encoder_;
};

// Prints one line of the comparison; returns whether the row moved too far.
bool moved(const Row& before, const Row& after)
{
    const double bytes = static_cast<double>(after.bytes) / static_cast<double>(before.bytes) - 1;
    const double decibels = after.psnr - before.psnr;
    const bool far = !(std::abs(bytes) <= kMostBytes) || !(std::abs(decibels) <= kMostDecibels);
    std::printf("%-18s %5d  %-12s %8zu %8zu %+7.2f %%  %8.3f %8.3f %+7.3f dB%s\n", before.mesh.c_str(),
                before.grid, before.goal.c_str(), before.bytes, after.bytes, 100 * bytes, before.psnr,
                after.psnr, decibels, far ? "  <--" : "");
    std::fflush(stdout);
    return far;
}

bool writeTable(const std::string& path, const std::vector<Row>& rows)
{
    std::string text = "mesh,grid,goal,bytes,psnr\n";
    for (const Row& row : rows) text += csv(row) + '\n';
    return cli::writeFile(path, text.data(), text.size());
}

// OpenBLAS picks its kernels by the processor, and their last bits can move a small file by 0.08 dB. The
// table is made with kernels that every x86-64 machine of the last fifteen years has; the choice is read when
// the library loads.
void useTheSameKernelsEverywhere(char** argv)
{
    if (std::getenv("OPENBLAS_CORETYPE") != nullptr) return;
    setenv("OPENBLAS_CORETYPE", "NEHALEM", 0);
    execv("/proc/self/exe", argv);
}

} // namespace

int main(int argc, char** argv)
{
    useTheSameKernelsEverywhere(argv);
    const char* folder = std::getenv("GIMG_CORPUS_DIR");
    std::string table = GIMG_BASELINE;
    const std::string cache = folder != nullptr ? folder : GIMG_SOURCE_CORPUS "/cache";
    bool write = false;
    CLI::App app("Compares bytes and decibels with a table; ends with 1 where a row moved by more than 0.1 "
                 "dB or 0.5 %.",
                 "gimg_baseline");
    app.add_option("TABLE", table, "rows to encode")->capture_default_str();
    app.add_flag("--write", write,
                 "write what comes out into the table: after a change that moves it on purpose");
    if (const std::optional<int> exit = cli::parse(app, argc, argv)) return *exit;

    const Result<std::vector<Row>> before = readTable(table);
    if (!before) return cli::fail("gimg_baseline", cli::Refused, before.error().message);
    std::printf("mesh                grid  goal            bytes      now              dB      now\n");
    Runner runner(cache);
    std::vector<Row> after;
    int far = 0;
    for (const Row& row : *before) {
        const Result<Row> now = runner.now(row);
        if (!now) return cli::fail("gimg_baseline", cli::Refused, now.error().message);
        after.push_back(*now);
        far += moved(row, *now) ? 1 : 0;
    }
    if (write) {
        if (!writeTable(table, after))
            return cli::fail("gimg_baseline", cli::Refused, table + ": cannot be written");
        return cli::Done;
    }
    if (far > 0)
        return cli::fail(
            "gimg_baseline", cli::Refused,
            std::to_string(far) + " of " + std::to_string(after.size()) +
                " rows moved by more than 0.1 dB or 0.5 %. If that is meant, review them and run "
                "gimg_baseline --write.");
    return cli::Done;
}

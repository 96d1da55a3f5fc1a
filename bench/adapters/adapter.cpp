// The program around an adapter: the protocol of README.md.
#include "adapter.h"

#include "gimg/mesh_io.h"
#include "tools/cli.h"

#include <CLI/App.hpp>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <sstream>

namespace gimg::adapter {

bool onPath(const std::string& program)
{
    const char* path = std::getenv("PATH");
    std::istringstream folders(path != nullptr ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (::access((folder + '/' + program).c_str(), X_OK) == 0) return true;
    return false;
}

namespace {

using Json = nlohmann::ordered_json;

struct Request
{
    std::string input, out;
    std::vector<size_t> sizes;
    size_t size = 12000;
    int grid = 0, threads = 0, runs = 5;
};

void say(const Json& line) { std::cout << line.dump() << std::endl; }

Json toJson(const Description& d)
{
    return {{"name", d.name},
            {"title", d.title},
            {"input", d.input == Input::Mesh ? "mesh" : "image"},
            {"side", d.side == Side::Ours ? "ours" : "peer"},
            {"codec", d.codec},
            {"packages", d.packages},
            {"missing", d.missing},
            {"uses_grid", d.usesGrid}};
}

Result<Subject> readSubject(const Description& description, const Request& request)
{
    Subject subject;
    subject.grid = request.grid;
    subject.threads = request.threads;
    if (description.input == Input::Image) {
        Result<FloatImage> image = readF32(request.input);
        if (!image) return image.error();
        subject.image = std::move(*image);
    } else {
        Result<Mesh> mesh = readTriangles(request.input);
        if (!mesh) return mesh.error();
        subject.mesh = std::move(*mesh);
    }
    return subject;
}

// Writes the files of one size and says so.
Status deliver(const Coded& coded, size_t target, const std::string& folder)
{
    const std::string stem = std::to_string(target);
    const std::string file = stem + '.' + coded.extension;
    const bool image = !coded.image.samples.empty();
    const std::string decoded = stem + (image ? ".f32" : ".ply");
    if (!cli::writeFile(folder + '/' + file, coded.file.data(), coded.file.size()))
        return Error{ErrorKind::FileNotWritable, folder + '/' + file + ": cannot be written"};
    const std::string path = folder + '/' + decoded;
    const Status written = image ? writeF32(coded.image, path) : writeMesh(coded.mesh, path);
    if (!written) return written;
    say({{"target", target},
         {"bytes", coded.file.size()},
         {"file", file},
         {"decoded", decoded},
         {"settings", coded.settings}});
    return Done{};
}

Status encode(Adapter& adapter, const Request& request)
{
    const Result<Subject> subject = readSubject(adapter.describe(), request);
    if (!subject) return subject.error();
    std::error_code failed;
    std::filesystem::create_directories(request.out, failed);
    Status delivered = Done{};
    const Status coded =
        adapter.encode(*subject, request.sizes, [&](size_t target, const Result<Coded>& result) {
            if (!delivered) return;
            if (result)
                delivered = deliver(*result, target, request.out);
            else
                say({{"target", target}, {"unreachable", result.error().message}});
        });
    return delivered ? coded : delivered;
}

Status time(Adapter& adapter, const Request& request)
{
    const Result<Subject> subject = readSubject(adapter.describe(), request);
    if (!subject) return subject.error();
    const Result<Times> times = adapter.time(*subject, request.size, request.runs);
    if (!times) return times.error();
    say({{"bytes", times->bytes},
         {"encode_ms", times->encode},
         {"decode_ms", times->decode},
         {"note", times->note}});
    return Done{};
}

} // namespace

int run(int argc, char** argv)
{
    const std::unique_ptr<Adapter> adapter = makeAdapter();
    const Description description = adapter->describe();
    CLI::App app("gimrd's adapter of " + description.title + ".", description.name);
    app.require_subcommand(1);
    Request request;
    CLI::App* describe = app.add_subcommand("describe", "What this adapter is and needs");
    CLI::App* encoding = app.add_subcommand("encode", "Best file and its decoded surface for each size");
    encoding->add_option("INPUT", request.input)->required();
    encoding->add_option("OUT", request.out)->required();
    encoding->add_option("--bytes", request.sizes)->delimiter(',')->required()->check(CLI::PositiveNumber);
    encoding->add_option("--grid", request.grid);
    encoding->add_option("--threads", request.threads);
    CLI::App* timing = app.add_subcommand("time", "Times of coding and decoding the input whole");
    timing->add_option("INPUT", request.input)->required();
    timing->add_option("--bytes", request.size)->check(CLI::PositiveNumber);
    timing->add_option("--runs", request.runs)->check(CLI::PositiveNumber);
    timing->add_option("--grid", request.grid);
    timing->add_option("--threads", request.threads);
    if (const std::optional<int> exit = cli::parse(app, argc, argv)) return *exit;

    if (describe->parsed()) {
        say(toJson(description));
        return cli::Done;
    }
    if (!description.missing.empty()) {
        std::string names;
        for (const std::string& package : description.missing) names += ' ' + package;
        return cli::fail(description.name, cli::Refused, "not installed:" + names);
    }
    const Status status = encoding->parsed() ? encode(*adapter, request) : time(*adapter, request);
    if (!status) return cli::fail(description.name, cli::Refused, status.error().message);
    return cli::Done;
}

} // namespace gimg::adapter

int main(int argc, char** argv) { return gimg::adapter::run(argc, argv); }

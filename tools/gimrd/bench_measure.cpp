#include "bench_measure.h"

#include "subdivide.h"

#include "../cli.h"

#include "gimg/decode.h"
#include "gimg/mesh_io.h"

#include <algorithm>
#include <cmath>

namespace gimg::gimrd {

namespace {

// Runs of round `round` when `runs` are spread over all rounds.
int runsOf(int runs, int round) { return runs / kRounds + (round < runs % kRounds ? 1 : 0); }

// The geometry image before compression, planar little-endian floats, as image coders take it.
Status writeImage(const Bench& bench, const Path& out)
{
    EncodeRequest request = encodeRequest(bench, "image.gim");
    request.target = {"--raw", "float"};
    request.normals = 0;
    request.threads = 0;
    const Result<ToolRun> run = gimenc(request);
    if (!run) return run.error();
    const std::optional<std::vector<std::uint8_t>> bytes = cli::readFile(request.out.string());
    if (!bytes) return Error{ErrorKind::FileNotReadable, request.out.string() + ": cannot be read"};
    const Result<DecodedImages> images = decodeImages(*bytes);
    if (!images) return images.error();
    return writeF32(images->geometry, out.string());
}

bool anyPeer(const Bench& bench, bool takesImage)
{
    return std::any_of(bench.peers.begin(), bench.peers.end(),
                       [&](const CoderProgram& peer) { return peer.takesImage == takesImage; });
}

// gimg and mesh coders on the mesh that the file decodes to.
Status decodeSideBySide(Bench& bench, GimDecoder& decoder, const Path& mesh, int allRuns,
                        const std::string& section)
{
    for (int round = 0; round < kRounds; ++round) {
        const int runs = runsOf(allRuns, round);
        if (runs == 0) break;
        progress(section + ": gimg");
        if (const Status timed = timeGim(bench, decoder, runs, section); !timed) return timed;
        for (const CoderProgram& peer : bench.peers) {
            if (peer.takesImage) continue;
            const auto run = timePeer(bench, peer, mesh, runs, section);
            if (!run) continue;
            recordAll(bench, section, peer.codec + "_ms", run->times.decode);
            if (section == "decode") describeFile(bench, peer, "equal_mesh_bytes", run->times);
        }
    }
    return Done{};
}

// Image coders, on the geometry image that gimg compressed.
Status timeImageCoders(Bench& bench)
{
    if (!anyPeer(bench, true)) return Done{};
    const Path image = bench.folder / "image.f32";
    progress("decode: geometry image");
    if (const Status written = writeImage(bench, image); !written) return written;
    for (int round = 0; round < kRounds; ++round) {
        const int runs = runsOf(bench.options.runs, round);
        if (runs == 0) break;
        for (const CoderProgram& peer : bench.peers) {
            if (!peer.takesImage) continue;
            const auto run = timePeer(bench, peer, image, runs, "decode");
            if (!run) continue;
            recordAll(bench, "decode", peer.codec + "_ms", run->times.decode);
            recordAll(bench, "encode", peer.codec + "_ms", run->times.encode);
            describeFile(bench, peer, "image_bytes", run->times);
        }
    }
    return Done{};
}

Status writeDecoded(GimDecoder& decoder, const Path& out)
{
    if (const Result<DecodeTimes> decoded = decoder.run(); !decoded) return decoded.error();
    return writeMesh(decoder.mesh(), out.string());
}

// The mesh itself was measured already.
void takeScalingOfMesh(Bench& bench, Json& step)
{
    const Json encode = medians(bench, "encode"), decodeMesh = medians(bench, "decode_mesh");
    step["faces"] = bench.json["mesh"]["faces"];
    step["encode_ms"] = encode.at("gim_ms");
    step["encode_peak_bytes"] = bench.json["memory"]["gim_encode_bytes"];
    step["decode_ms"] = medians(bench, "decode").at("gim_ms");
    for (const auto& [key, value] : decodeMesh.items()) {
        const std::string codec = key.substr(0, key.size() - 3);
        step[codec + "_encode_ms"] = encode.at(key);
        step[codec + "_decode_ms"] = value;
    }
}

Status writeSubdivided(const std::string& mesh, int factor, const Path& out)
{
    Result<MeshFile> file = readMesh(mesh);
    if (!file) return file.error();
    for (int f = factor; f > 1; f /= 4) file->mesh = subdivide(file->mesh);
    return writeMesh(file->mesh, out.string());
}

Status measureSubdivided(Bench& bench, int factor, Json& step)
{
    const std::string section = "scaling x" + std::to_string(factor);
    const Path mesh = bench.folder / "scaled.ply";
    progress(section + ": gimg");
    if (const Status written = writeSubdivided(bench.options.mesh, factor, mesh); !written) return written;
    EncodeRequest request = encodeRequest(bench, "scaled.gim");
    request.mesh = mesh;
    const Result<ToolRun> run = gimenc(request);
    if (!run) return run.error();
    step["faces"] = run->report.at("faces");
    step["encode_ms"] = encodeMilliseconds(*run);
    step["encode_peak_bytes"] = run->peak;
    Result<GimDecoder> decoder = openFile(request.out);
    if (!decoder) return decoder.error();
    const Status timed = timeGim(bench, *decoder, std::min(bench.options.runs, kLargeRuns), section);
    if (!timed) return timed;
    step["decode_ms"] = medians(bench, section).at("gim_ms");
    for (const CoderProgram& peer : bench.peers) {
        if (peer.takesImage) continue;
        const auto peerRun = timePeer(bench, peer, mesh, 1, section);
        if (!peerRun) continue;
        step[peer.codec + "_encode_ms"] = peerRun->times.encode[0];
        step[peer.codec + "_decode_ms"] = peerRun->times.decode[0];
    }
    return Done{};
}

// The same bits a sample at every size.
size_t bytesAt(const BenchOptions& options, int grid)
{
    const double cells = std::pow(double(grid - 1) / (options.grid - 1), 2);
    return static_cast<size_t>(std::lround(static_cast<double>(options.bytes) * cells));
}

Status measureGrid(Bench& bench, int grid, const std::string& section, Json& step)
{
    progress(section + ": gimg");
    EncodeRequest request = encodeRequest(bench, "grid.gim");
    request.grid = grid;
    request.threads = 0;
    request.target = {"--bytes", std::to_string(bytesAt(bench.options, grid))};
    const Result<ToolRun> run = gimenc(request);
    if (!run) return run.error();
    Result<GimDecoder> decoder = openFile(request.out);
    if (!decoder) return decoder.error();
    const Path mesh = bench.folder / "grid.ply";
    if (const Status written = writeDecoded(*decoder, mesh); !written) return written;
    step["triangles"] = decoder->counts().triangles;
    step["bytes"] = run->report.at("bytes").at("total");
    const bool large = decoder->counts().triangles > kLarge;
    const int runs = large ? std::min(bench.options.runs, kLargeRuns) : bench.options.runs;
    return decodeSideBySide(bench, *decoder, mesh, runs, section);
}

} // namespace

Status writeInput(const Bench& bench)
{
    const Result<MeshFile> file = readMesh(bench.options.mesh);
    if (!file) return file.error();
    return writeMesh(file->mesh, (bench.folder / "input.ply").string());
}

Status measureEncoding(Bench& bench)
{
    Json& memory = bench.json["memory"];
    for (int round = 0; round < kRounds; ++round) {
        const int runs = runsOf(bench.options.runs, round);
        if (runs == 0) break;
        progress("encode: gimg");
        EncodeRequest request = encodeRequest(bench, "mesh.gim");
        const Result<ToolRun> single = gimenc(request);
        if (!single) return single.error();
        record(bench, "encode", "gim_ms", encodeMilliseconds(*single));
        for (const char* stage : {"cut", "parameterize", "sample", "code"})
            record(bench, "gim_stages_ms", stage, 1000 * single->report["seconds"][stage].get<double>());
        bench.json["mesh"]["faces"] = single->report["faces"];
        bench.json["gim"]["psnr"] = single->report["psnr"];

        request.threads = 0;
        const Result<ToolRun> every = gimenc(request);
        if (!every) return every.error();
        record(bench, "encode", "gim_all_cores_ms", encodeMilliseconds(*every));
        raise(memory["gim_encode_bytes"], every->peak);

        for (const CoderProgram& peer : bench.peers) {
            if (peer.takesImage) continue;
            const auto run = timePeer(bench, peer, bench.folder / "input.ply", runs, "encode");
            if (!run) continue;
            recordAll(bench, "encode", peer.codec + "_ms", run->times.encode);
            recordAll(bench, "decode_mesh", peer.codec + "_ms", run->times.decode);
            raise(memory[peer.codec + "_process_bytes"], run->peak);
            describeFile(bench, peer, "mesh_bytes", run->times);
        }
    }
    return Done{};
}

Status measureDecoderMemory(Bench& bench)
{
    const Result<ToolRun> run =
        runTool("gimdec", {(bench.folder / "mesh.gim").string(), (bench.folder / "mesh.ply").string()});
    if (!run) return run.error();
    bench.json["memory"]["gim_decode_bytes"] = run->peak;
    return Done{};
}

Status measureDecoding(Bench& bench)
{
    Result<GimDecoder> decoder = openFile(bench.folder / "mesh.gim");
    if (!decoder) return decoder.error();
    const Path mesh = bench.folder / "equal.ply";
    if (const Status written = writeDecoded(*decoder, mesh); !written) return written;
    Json& gim = bench.json["gim"];
    gim["bytes"] = std::filesystem::file_size(bench.folder / "mesh.gim");
    gim["grid"] = decoder->info().grid;
    gim["normal_grid"] = decoder->info().normal_grid;
    gim["vertices"] = decoder->counts().vertices;
    gim["triangles"] = decoder->counts().triangles;
    bench.json["memory"]["gim_decode_output_bytes"] = decoder->outputBytes();
    bench.json["memory"]["gim_workspace_bytes"] = gim_workspace_size(&decoder->info());
    const Status timed = decodeSideBySide(bench, *decoder, mesh, bench.options.runs, "decode");
    return timed ? timeImageCoders(bench) : timed;
}

void measureScaling(Bench& bench)
{
    for (const int factor : bench.factors) {
        Json step = {{"factor", factor}};
        if (factor == 1) {
            takeScalingOfMesh(bench, step);
        } else if (const Status measured = measureSubdivided(bench, factor, step); !measured) {
            step["failed"] = measured.error().message;
            recordFailure(bench, "scaling x" + std::to_string(factor), measured.error().message);
        }
        bench.json["scaling"].push_back(step);
    }
}

void measureDecodeScaling(Bench& bench)
{
    for (const int grid : bench.grids) {
        std::string section = "decode scaling " + std::to_string(grid);
        Json step = {{"grid", grid}};
        Status measured = Done{};
        if (grid == bench.options.grid) { // measured already
            section = "decode";
            step["triangles"] = bench.json["gim"]["triangles"];
            step["bytes"] = bench.json["gim"]["bytes"];
        } else {
            measured = measureGrid(bench, grid, section, step);
        }
        const Json times = medians(bench, section);
        for (const auto& [key, value] : times.items()) {
            const bool image = std::any_of(bench.peers.begin(), bench.peers.end(), [&](const auto& peer) {
                return peer.takesImage && peer.codec + "_ms" == key;
            });
            if (!image) step[key] = value;
        }
        if (!measured) {
            step["failed"] = measured.error().message;
            recordFailure(bench, section, measured.error().message);
        }
        bench.json["decode_scaling"].push_back(step);
    }
}

} // namespace gimg::gimrd

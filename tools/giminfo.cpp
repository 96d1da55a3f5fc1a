// giminfo: what a .gim file holds.
#include "cli.h"

#include <CLI/App.hpp>
#include <gim.h>
#include <nlohmann/json.hpp>

#include <charconv>
#include <iomanip>
#include <iostream>
#include <sstream>

namespace {

using namespace gimg;

const char* nameOf(gim_coding coding)
{
    switch (coding) {
    case GIM_CODING_WAVELET:
        return "wavelet";
    case GIM_CODING_RAW12:
        return "12-bit";
    case GIM_CODING_FLOAT:
        return "float";
    case GIM_CODING_SURFACE:
        return "surface";
    case GIM_CODING_FIELD:
        return "field";
    }
    return "unknown";
}

const char* nameOf(gim_sample_type type) { return type == GIM_U8 ? "u8" : type == GIM_U16 ? "u16" : "f32"; }

bool isLossless(const gim_attribute& attribute) { return attribute.coding == GIM_CODING_FLOAT; }

const char* contentOf(char type)
{
    switch (type) {
    case 'S':
        return "seam";
    case 'G':
        return "geometry";
    case 'n':
        return "normals";
    case 'a':
        return "attribute";
    default:
        return "unknown, skipped";
    }
}

// a, b, .. z, aa, ab ..; a piece of the surface's own boundary gets capitals.
std::string labelOf(const gim_side& side)
{
    std::string label;
    const char base = side.kind == GIM_SIDE_BOUNDARY ? 'A' : 'a';
    for (uint32_t k = side.path + 1; k > 0; k = (k - 1) / 26)
        label.insert(label.begin(), static_cast<char>(base + static_cast<char>((k - 1) % 26)));
    return label;
}

struct Summary
{
    gim_info info{};
    gim_seam seam{};
    std::vector<gim_side> sides;
    std::vector<gim_chunk> chunks;
    std::vector<gim_attribute> attributes;

    std::string word() const
    {
        std::string text;
        for (const gim_side& side : sides) {
            if (!text.empty()) text += ' ';
            text += labelOf(side) + (side.kind == GIM_SIDE_MATE ? "'" : "");
        }
        return text;
    }
};

gim_status summarize(const std::vector<uint8_t>& file, Summary& summary)
{
    summary.info.size = sizeof summary.info;
    gim_status status = gim_probe(file.data(), file.size(), nullptr, &summary.info);
    if (status != GIM_OK) return status;
    for (uint32_t k = 0; k < summary.info.chunks; ++k) {
        gim_chunk chunk{};
        chunk.size = sizeof chunk;
        status = gim_read_chunk(file.data(), file.size(), k, &chunk);
        if (status != GIM_OK) return status;
        summary.chunks.push_back(chunk);
    }
    for (uint32_t k = 0; k < summary.info.attributes; ++k) {
        gim_attribute attribute{};
        attribute.size = sizeof attribute;
        status = gim_read_attribute(file.data(), file.size(), nullptr, k, &attribute);
        if (status != GIM_OK) return status;
        summary.attributes.push_back(attribute);
    }
    std::vector<unsigned char> work(gim_workspace_size(&summary.info));
    summary.seam.size = sizeof summary.seam;
    summary.sides.resize(4 * (std::size_t{summary.info.lowest} - 1));
    status = gim_read_seam(file.data(), file.size(), nullptr, work.data(), work.size(), &summary.seam,
                           summary.sides.data(), static_cast<uint32_t>(summary.sides.size()));
    if (status != GIM_OK) return status;
    summary.sides.resize(summary.seam.sides);
    return GIM_OK;
}

// The float's value with no more digits than it needs, where its exact value would print as 0.0099999998.
double shortest(float value)
{
    char text[32];
    const char* end = std::to_chars(text, text + sizeof text, value).ptr;
    double rounded = 0;
    std::from_chars(text, end, rounded);
    return rounded;
}

nlohmann::ordered_json imageJson(uint32_t grid, gim_coding coding, float step, uint64_t bytes)
{
    nlohmann::ordered_json json;
    json["grid"] = grid;
    json["coding"] = nameOf(coding);
    if (coding != GIM_CODING_FLOAT) json["step"] = shortest(step);
    json["bytes"] = bytes;
    return json;
}

nlohmann::ordered_json jsonOf(const Summary& s, std::size_t bytes)
{
    nlohmann::ordered_json json;
    json["version"] = s.info.version;
    json["grid"] = s.info.grid;
    json["lowest"] = s.info.lowest;
    json["levels"] = s.info.levels;
    json["genus"] = s.seam.genus;
    json["boundaries"] = s.seam.boundary_loops;
    json["bytes"] = {{"total", bytes},
                     {"container", s.info.container_bytes},
                     {"sideband", s.info.seam_bytes},
                     {"geometry", s.info.geometry_bytes},
                     {"normals", s.info.normal_bytes},
                     {"attributes", s.info.attribute_bytes},
                     {"other", s.info.other_bytes}};
    json["geometry"] = imageJson(s.info.grid, s.info.coding, s.info.step, s.info.geometry_bytes);
    json["normals"] = nullptr;
    if (s.info.normal_grid != 0)
        json["normals"] =
            imageJson(s.info.normal_grid, s.info.normal_coding, s.info.normal_step, s.info.normal_bytes);
    json["attributes"] = nlohmann::ordered_json::array();
    for (const gim_attribute& a : s.attributes) {
        nlohmann::ordered_json attribute = {{"name", a.name}};
        attribute.update(imageJson(a.grid, a.coding, a.step, a.coded_bytes));
        if (isLossless(a)) attribute["coding"] = "lossless";
        attribute["channels"] = a.channels;
        attribute["type"] = nameOf(a.type);
        attribute["glued"] = a.glued != 0;
        attribute["normalized"] = a.normalized != 0;
        json["attributes"].push_back(attribute);
    }
    nlohmann::ordered_json seam;
    seam["start"] = s.seam.start;
    seam["paths"] = s.seam.paths;
    seam["nodes"] = s.seam.cut_nodes;
    seam["word"] = s.word();
    seam["sides"] = nlohmann::ordered_json::array();
    for (const gim_side& side : s.sides)
        seam["sides"].push_back({{"path", labelOf(side)},
                                 {"kind", side.kind == GIM_SIDE_BOUNDARY ? "boundary"
                                          : side.kind == GIM_SIDE_FIRST  ? "first"
                                                                         : "mate"},
                                 {"length", side.length}});
    json["seam"] = seam;
    json["chunks"] = nlohmann::ordered_json::array();
    for (const gim_chunk& chunk : s.chunks)
        json["chunks"].push_back({{"type", std::string(1, chunk.type)},
                                  {"offset", chunk.offset},
                                  {"length", chunk.length},
                                  {"total", chunk.total}});
    return json;
}

void printImage(const char* name, uint32_t grid, gim_coding coding, float step)
{
    std::cout << std::left << std::setw(11) << name << grid << " x " << grid << ", " << nameOf(coding);
    if (coding != GIM_CODING_FLOAT) std::cout << ", step " << step;
    std::cout << '\n';
}

void print(const Summary& s, std::size_t bytes)
{
    std::cout << "file       " << bytes << " bytes, format version " << s.info.version << '\n';
    printImage("geometry", s.info.grid, s.info.coding, s.info.step);
    if (s.info.normal_grid != 0)
        printImage("normals", s.info.normal_grid, s.info.normal_coding, s.info.normal_step);
    for (const gim_attribute& a : s.attributes) {
        std::cout << "attribute  " << a.name << ": " << a.grid << " x " << a.grid << ", " << a.channels
                  << " x " << nameOf(a.type) << ", ";
        if (isLossless(a))
            std::cout << "lossless";
        else
            std::cout << nameOf(a.coding) << ", step " << a.step;
        std::cout << (a.glued != 0 ? "" : ", open border") << ", " << a.coded_bytes << " bytes\n";
    }
    std::cout << "levels     " << s.info.levels << ", the coarsest " << s.info.lowest << " x "
              << s.info.lowest << '\n'
              << "surface    genus " << s.seam.genus << ", " << s.seam.boundary_loops << " boundary loop"
              << (s.seam.boundary_loops == 1 ? "" : "s") << '\n'
              << "seam       " << s.word() << '\n'
              << "           " << s.seam.paths << (s.seam.paths == 1 ? " path, " : " paths, ")
              << s.seam.cut_nodes << (s.seam.cut_nodes == 1 ? " node" : " nodes") << ", starts at "
              << s.seam.start << " of " << 4 * (s.info.lowest - 1) << '\n'
              << "lengths   ";
    for (const gim_side& side : s.sides)
        if (side.kind != GIM_SIDE_MATE) std::cout << ' ' << labelOf(side) << '=' << side.length;
    std::cout << "\nbytes      container " << s.info.container_bytes << ", seam " << s.info.seam_bytes
              << ", geometry " << s.info.geometry_bytes << ", normals " << s.info.normal_bytes
              << ", attributes " << s.info.attribute_bytes << ", other " << s.info.other_bytes << '\n';
    for (const gim_chunk& chunk : s.chunks)
        std::cout << "chunk      " << chunk.type << " (" << contentOf(chunk.type) << "): " << chunk.length
                  << " bytes at " << chunk.offset << ", " << chunk.total << " in all\n";
}

} // namespace

int main(int argc, char** argv)
{
    CLI::App app{"Shows what a .gim geometry image file holds.", "giminfo"};
    app.footer("Exit codes: 0 done, 1 input refused, 2 usage.");
    app.set_version_flag("--version", GIMG_VERSION);
    std::string input;
    bool json = false;
    app.add_option("FILE", input, "file to look into, .gim")->required();
    app.add_flag("--json", json, "print a JSON object instead of text");
    if (const std::optional<int> exit = cli::parse(app, argc, argv)) return *exit;

    const auto file = cli::readFile(input);
    if (!file) return cli::fail("giminfo", cli::Refused, input + ": cannot be read");
    Summary summary;
    const gim_status status = summarize(*file, summary);
    if (status != GIM_OK) return cli::fail("giminfo", cli::Refused, input + ": " + gim_status_text(status));
    if (json) return cli::writeJson("-", jsonOf(summary, file->size())) ? cli::Done : cli::Refused;
    print(summary, file->size());
    return cli::Done;
}

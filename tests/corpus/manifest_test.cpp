#include "gimg/mesh_io.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <set>

using namespace gimg;
namespace fs = std::filesystem;

namespace {

using Entry = std::map<std::string, std::string>;

// Blocks of "key: value" lines, one block a mesh; # starts a comment line.
std::vector<Entry> manifest()
{
    std::ifstream in(fs::path(GIMG_SOURCE_CORPUS) / "manifest");
    std::vector<Entry> entries;
    for (std::string line; std::getline(in, line);) {
        const size_t colon = line.find(": ");
        if (line.empty() || line[0] == '#' || colon == std::string::npos) continue;
        const std::string key = line.substr(0, colon);
        if (key == "mesh") entries.emplace_back();
        entries.at(entries.size() - 1)[key] = line.substr(colon + 2);
    }
    return entries;
}

// The mesh as corpus/fetch left it; empty if it was not fetched.
fs::path cached(const std::string& name)
{
    const char* dir = std::getenv("GIMG_CORPUS_DIR");
    const fs::path cache = dir ? fs::path(dir) : fs::path(GIMG_SOURCE_CORPUS) / "cache";
    for (const char* extension : {".obj", ".off", ".ply", ".stl"})
        if (const fs::path path = cache / (name + extension); fs::exists(path)) return path;
    return {};
}

} // namespace

TEST(Manifest, EveryEntryIsComplete)
{
    std::set<std::string> names;
    for (const Entry& entry : manifest()) {
        SCOPED_TRACE(entry.at("mesh"));
        EXPECT_TRUE(names.insert(entry.at("mesh")).second) << "named twice";
        for (const char* key : {"origin", "path", "credit", "sha256", "vertices", "faces", "genus", "loops"})
            EXPECT_EQ(entry.count(key), 1u) << key;
        EXPECT_EQ(entry.at("sha256").size(), 64u);
        EXPECT_EQ(entry.at("sha256").find_first_not_of("0123456789abcdef"), std::string::npos);
    }
    EXPECT_EQ(names.count("bunny"), 1u);
}

TEST(Manifest, FetchedMeshesHaveTheStatedTopology)
{
    ASSERT_FALSE(cached("bunny").empty()) << "run corpus/fetch bunny first";
    for (const Entry& entry : manifest()) {
        const fs::path path = cached(entry.at("mesh"));
        if (path.empty() || entry.count("defects") || entry.count("components")) continue;
        SCOPED_TRACE(path);
        const Result<MeshFile> file = readMesh(path.string());
        ASSERT_TRUE(file) << file.error().message;
        const Topology t = topology(file->mesh);
        EXPECT_EQ(std::to_string(t.vertices), entry.at("vertices"));
        EXPECT_EQ(std::to_string(t.faces), entry.at("faces"));
        EXPECT_EQ(std::to_string(t.genus), entry.at("genus"));
        EXPECT_EQ(std::to_string(t.boundaries), entry.at("loops"));
    }
}

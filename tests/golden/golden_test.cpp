#include "gim.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <map>
#include <string>
#include <vector>

// The decoder's sources are built into this test several times, with different optimisation; every build
// must give the samples that hashes.txt tells, to the bit.
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes readFile(const std::filesystem::path& path)
{
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// FNV-1a of 32-bit words, byte by byte from the lowest.
class Hash
{
public:
    template <class T> void add(const std::vector<T>& words)
    {
        static_assert(sizeof(T) == 4);
        for (const T& word : words) {
            std::uint32_t bits;
            std::copy_n(reinterpret_cast<const unsigned char*>(&word), 4,
                        reinterpret_cast<unsigned char*>(&bits));
            for (unsigned k = 0; k < 32; k += 8) value_ = (value_ ^ (bits >> k & 0xFFu)) * 1099511628211u;
        }
    }
    std::string text() const
    {
        char buffer[17];
        std::snprintf(buffer, sizeof buffer, "%016llx", static_cast<unsigned long long>(value_));
        return buffer;
    }

private:
    std::uint64_t value_ = 14695981039346656037u;
};

std::string hashOf(const Bytes& bytes)
{
    gim_info info{};
    info.size = sizeof info;
    const gim_status probe = gim_probe(bytes.data(), bytes.size(), nullptr, &info);
    const std::uint32_t prefix = probe == GIM_MORE_INPUT && info.grid != 0 ? GIM_PREFIX : 0;
    if (probe != GIM_OK && prefix == 0) return "refused";
    std::vector<unsigned char> work(gim_workspace_size(&info));
    std::vector<float> xyz(3 * std::size_t{info.grid} * info.grid);
    Hash hash;
    for (const std::uint32_t flags : {0u, GIM_NO_FUSE, GIM_NO_DIFFUSE}) {
        if (gim_decode_geometry(bytes.data(), bytes.size(), nullptr, flags | prefix, work.data(), work.size(),
                                xyz.data()) != GIM_OK)
            return "refused";
        hash.add(xyz);
    }
    if (info.normal_grid != 0) {
        std::vector<float> normals(3 * std::size_t{info.normal_grid} * info.normal_grid);
        if (gim_decode_normals(bytes.data(), bytes.size(), nullptr, 0, work.data(), work.size(),
                               normals.data()) != GIM_OK)
            return "refused";
        hash.add(normals);
    }
    for (std::uint32_t k = 0; k < info.attributes; ++k) {
        gim_attribute attribute{};
        attribute.size = sizeof attribute;
        if (gim_read_attribute(bytes.data(), bytes.size(), nullptr, k, &attribute) != GIM_OK)
            return "refused";
        const auto addAs = [&](auto zero, auto word) {
            std::vector<decltype(zero)> samples(attribute.decoded_bytes / sizeof zero);
            if (gim_decode_attribute(bytes.data(), bytes.size(), nullptr, k, work.data(), work.size(),
                                     samples.data()) != GIM_OK)
                return false;
            hash.add(std::vector<decltype(word)>(samples.begin(), samples.end()));
            return true;
        };
        if (!(attribute.type == GIM_U8    ? addAs(std::uint8_t{}, std::uint32_t{})
              : attribute.type == GIM_U16 ? addAs(std::uint16_t{}, std::uint32_t{})
                                          : addAs(0.0f, 0.0f)))
            return "refused";
    }
    gim_mesh_counts counts{sizeof counts, 0, 0, 0};
    if (gim_mesh_size(bytes.data(), bytes.size(), nullptr, prefix, 0, work.data(), work.size(), &counts) !=
        GIM_OK)
        return "refused";
    std::vector<std::uint32_t> triangles(3 * std::size_t{counts.triangles});
    if (gim_build_mesh(bytes.data(), bytes.size(), nullptr, prefix, 0, work.data(), work.size(), xyz.data(),
                       nullptr, nullptr, triangles.data()) != GIM_OK)
        return "refused";
    hash.add(triangles);
    return hash.text();
}

TEST(Golden, FilesDecodeToTheirHashes)
{
    std::map<std::string, std::string> expected;
    std::ifstream list(std::filesystem::path(GIMG_GOLDEN_DIR) / "hashes.txt");
    for (std::string name, hash; list >> name >> hash;) expected[name] = hash;
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(GIMG_GOLDEN_DIR)) {
        if (entry.path().extension() != ".gim") continue;
        ++files;
        const std::string name = entry.path().stem().string();
        EXPECT_EQ(hashOf(readFile(entry.path())), expected[name]) << name;
    }
    EXPECT_GE(files, 20);
    EXPECT_EQ(static_cast<std::size_t>(files), expected.size());
}

} // namespace

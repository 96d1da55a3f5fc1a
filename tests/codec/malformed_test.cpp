#include "exercise.h"
#include "format/container.h"
#include "sample_images.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <map>

namespace gimg::codec {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Makes the checksums of a file right again, as far as its chunks can be told apart.
void repairChecksums(Bytes& file)
{
    const auto put = [&](std::size_t at, std::uint32_t value) {
        for (unsigned k = 0; k < 4; ++k) file[at + k] = static_cast<std::uint8_t>(value >> 8 * k);
    };
    if (file.size() < format::kHeaderSize) return;
    put(6, format::crc({file.data(), 6}));
    for (std::size_t at = format::kHeaderSize; at + 2 <= file.size();) {
        const std::size_t begin = at++;
        std::size_t length = 0;
        for (unsigned shift = 0; at < file.size() && shift < 35; shift += 7) {
            const std::uint8_t byte = file[at++];
            length |= std::size_t{byte & 0x7Fu} << shift;
            if (byte < 0x80) break;
        }
        if (length > file.size() || at + length + 4 > file.size()) return;
        at += length;
        put(at, format::crc({file.data() + begin, at - begin}));
        at += 4;
    }
}

Bytes validFile(gim_coding coding)
{
    const std::vector<float> xyz = samples::torusImage(33), normals = samples::torusNormals(17);
    Source source;
    source.grid = 33;
    source.seam = samples::closedSeam(2, 17, 9);
    source.xyz = xyz;
    source.normalGrid = 17;
    source.normals = normals;
    const std::vector<float> colors(4 * 17 * 17, 100), uv(2 * 33 * 33, 0.5f);
    source.attributes.push_back({"color", 17, 4, GIM_U8, true, true, false, colors});
    source.attributes.push_back({"uv", 33, 2, GIM_F32, false, false, false, uv});
    return samples::encoded(source, {coding, 0.02f, 0.1f});
}

TEST(Mutations, AreDecodedOrRefusedButNeverHarmful)
{
    std::map<gim_status, int> seen;
    for (int coding = 0; coding < 4; ++coding) {
        const Bytes valid = validFile(static_cast<gim_coding>(coding));
        samples::Dice dice(static_cast<std::uint64_t>(coding));
        for (int round = 0; round < 1500; ++round) {
            Bytes mutant = valid;
            const std::uint32_t changes = 1 + dice.below(4);
            for (std::uint32_t k = 0; k < changes; ++k) {
                // The fields that steer decoding are at the front; half of the changes go there.
                const std::uint32_t range =
                    dice.below(2) == 0 ? 60 : static_cast<std::uint32_t>(mutant.size());
                mutant[dice.below(
                    std::min<std::uint32_t>(range, static_cast<std::uint32_t>(mutant.size())))] =
                    static_cast<std::uint8_t>(dice.next());
            }
            if (dice.below(8) == 0) mutant.resize(dice.below(static_cast<std::uint32_t>(mutant.size())));
            if (dice.below(8) != 0) repairChecksums(mutant);
            ++seen[exerciseDecoder(mutant.data(), mutant.size(), 129)];
        }
    }
    EXPECT_GT(seen[GIM_OK], 200); // damage inside the payload may well decode
    EXPECT_GT(seen[GIM_CORRUPT], 200);
    EXPECT_GT(seen[GIM_MORE_INPUT], 100);
    EXPECT_GT(seen[GIM_UNSUPPORTED], 10);
    EXPECT_EQ(seen[GIM_MISUSE], 0);
}

// Files in tests/malformed are named after the status they must give.
TEST(Malformed, FilesAreRefusedForTheRightReason)
{
    const std::map<std::string, gim_status> expected = {{"more-input", GIM_MORE_INPUT},
                                                        {"corrupt", GIM_CORRUPT},
                                                        {"unsupported", GIM_UNSUPPORTED},
                                                        {"limit", GIM_LIMIT}};
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(GIMG_MALFORMED_DIR)) {
        if (entry.path().extension() != ".gim") continue;
        ++files;
        std::ifstream in(entry.path(), std::ios::binary);
        const Bytes bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
        const std::string name = entry.path().filename().string();
        const auto match = std::find_if(expected.begin(), expected.end(),
                                        [&](const auto& pair) { return name.rfind(pair.first, 0) == 0; });
        ASSERT_NE(match, expected.end()) << name;
        EXPECT_EQ(exerciseDecoder(bytes.data(), bytes.size(), 1025), match->second) << name;
    }
    EXPECT_GE(files, 10);
}

} // namespace
} // namespace gimg::codec

#include "sample_images.h"

#include <gtest/gtest.h>

namespace gimg::codec {
namespace {

using namespace samples;
using Bytes = std::vector<std::uint8_t>;

const Bytes& wholeFile()
{
    static const Bytes file = [] {
        const std::vector<float> xyz = bumpyImage(65, 1);
        Source source;
        source.grid = 65;
        source.seam = closedSeam(3, 33, 50);
        source.xyz = xyz;
        return encoded(source, {GIM_CODING_SURFACE, 1e-4f, 0});
    }();
    return file;
}

struct Prefix
{
    gim_status probe, decode;
    std::vector<float> xyz;
    gim_info info{};
};

Prefix decodedPrefix(const Bytes& file, std::size_t size, std::uint32_t flags = GIM_PREFIX)
{
    const Bytes bytes(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size));
    Prefix out{};
    out.info.size = sizeof out.info;
    out.probe = gim_probe(bytes.data(), bytes.size(), nullptr, &out.info);
    if (out.info.grid == 0) return out;
    std::vector<unsigned char> work(gim_workspace_size(&out.info));
    out.xyz.resize(std::size_t{3} * out.info.grid * out.info.grid);
    out.decode = gim_decode_geometry(bytes.data(), bytes.size(), nullptr, flags, work.data(), work.size(),
                                     out.xyz.data());
    return out;
}

TEST(Prefix, AnyOneBeyondTheHeadersIsAClosedSurface)
{
    const Bytes& file = wholeFile();
    const Prefix whole = decodedPrefix(file, file.size());
    ASSERT_EQ(whole.probe, GIM_OK);
    std::size_t decodable = 0;
    for (std::size_t size = 0; size < file.size(); size += size < 200 ? 1 : 13) {
        const Prefix prefix = decodedPrefix(file, size);
        EXPECT_EQ(prefix.probe, GIM_MORE_INPUT) << size;
        if (prefix.info.grid == 0) continue;
        ++decodable;
        ASSERT_EQ(prefix.decode, GIM_OK) << size;
        EXPECT_EQ(prefix.info.geometry_bytes + prefix.info.missing_bytes, whole.info.geometry_bytes);
        EXPECT_EQ(prefix.info.container_bytes + prefix.info.seam_bytes + prefix.info.geometry_bytes, size);
        EXPECT_EQ(decodedPrefix(file, size, 0).decode, GIM_MORE_INPUT) << size;
        const std::vector<std::uint32_t> classes = borderClasses(closedSeam(3, 33, 50), 65);
        for (std::uint32_t k = 0; k < classes.size(); ++k)
            for (unsigned c = 0; c < 3; ++c)
                ASSERT_EQ(prefix.xyz[3 * borderSample(65, k) + c],
                          prefix.xyz[3 * borderSample(65, classes[k]) + c])
                    << size << ' ' << k;
    }
    // All but the headers, the seam's chunk and the geometry's fixed fields: some forty bytes.
    EXPECT_GT(decodable, (file.size() - 200) / 13 + 140);
}

// An octave of bytes is about one bit of every detail, thus half the distance.
TEST(Prefix, ComesNearerWithEveryOctaveOfBytes)
{
    const Bytes& file = wholeFile();
    const std::vector<float> whole = decodedPrefix(file, file.size()).xyz;
    double before = rmsDistance(decodedPrefix(file, file.size() / 32).xyz, whole);
    for (const std::size_t part : {16, 8, 4, 2}) {
        const double now = rmsDistance(decodedPrefix(file, file.size() / part).xyz, whole);
        EXPECT_LT(now, 0.7 * before) << part;
        before = now;
    }
    EXPECT_GT(before, 0);
}

// The last byte is no loss to speak of, the whole file none.
TEST(Prefix, OfAllBytesIsTheFile)
{
    const Bytes& file = wholeFile();
    const Prefix whole = decodedPrefix(file, file.size()), plain = decodedPrefix(file, file.size(), 0);
    EXPECT_EQ(whole.xyz, plain.xyz);
    const Prefix noChecksum = decodedPrefix(file, file.size() - 1);
    EXPECT_EQ(noChecksum.probe, GIM_MORE_INPUT);
    EXPECT_EQ(noChecksum.info.missing_bytes, 0u);
    EXPECT_EQ(noChecksum.xyz, plain.xyz);
    EXPECT_LT(rmsDistance(decodedPrefix(file, file.size() - 5).xyz, plain.xyz), 1e-4);
}

TEST(Prefix, OfAnotherCodingIsRefused)
{
    const std::vector<float> xyz = bumpyImage(65, 1);
    Source source;
    source.grid = 65;
    source.seam = diskSeam(17);
    source.xyz = xyz;
    for (const gim_coding coding : {GIM_CODING_WAVELET, GIM_CODING_RAW12, GIM_CODING_FLOAT}) {
        const Bytes file = encoded(source, {coding, 0.01f, 0});
        const Prefix prefix = decodedPrefix(file, file.size() / 2);
        EXPECT_EQ(prefix.probe, GIM_MORE_INPUT);
        EXPECT_EQ(prefix.info.grid, 0u);
    }
}

TEST(Prefix, LeavesOutWhatComesAfterTheCut)
{
    const std::vector<float> xyz = torusImage(33), normals = torusNormals(33);
    Source source;
    source.grid = 33;
    source.seam = torusSeam(9);
    source.xyz = xyz;
    source.normalGrid = 33;
    source.normals = normals;
    const Bytes file = encoded(source, {GIM_CODING_SURFACE, 0.01f, 0.05f});
    const Prefix prefix = decodedPrefix(file, file.size() - 8);
    EXPECT_EQ(prefix.probe, GIM_MORE_INPUT);
    EXPECT_EQ(prefix.decode, GIM_OK);
    EXPECT_EQ(prefix.info.missing_bytes, 0u);
    EXPECT_EQ(prefix.info.normal_grid, 0u);
    EXPECT_EQ(prefix.xyz, decodedPrefix(file, file.size()).xyz);
}

} // namespace
} // namespace gimg::codec

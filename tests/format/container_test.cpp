#include "format/container.h"
#include "format/writer.h"

#include <gtest/gtest.h>

namespace gimg::format {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes fileOf(std::initializer_list<std::pair<char, Bytes>> chunks)
{
    Writer writer;
    for (const auto& [type, content] : chunks) writer.addChunk(static_cast<std::uint8_t>(type), content);
    return writer.finish();
}

ReadStatus statusOf(const Bytes& bytes)
{
    Contents contents;
    return readContents({bytes.data(), bytes.size()}, false, &contents);
}

TEST(Container, OverheadIsTenBytesAndSixAChunk)
{
    EXPECT_EQ(fileOf({}).size(), 10u);
    EXPECT_EQ(fileOf({{'S', {}}, {'G', {}}}).size(), 10u + 6 + 6);
    EXPECT_EQ(fileOf({{'S', Bytes(127)}}).size(), 10u + 6 + 127);
    EXPECT_EQ(fileOf({{'S', Bytes(128)}}).size(), 10u + 7 + 128); // the length takes a second byte
    EXPECT_EQ(chunkSize(127), 6u + 127);
    EXPECT_EQ(chunkSize(128), 7u + 128);
    EXPECT_EQ(chunkSize(1u << 21), 9u + (1u << 21));
}

TEST(Container, BytesAreAsTheSpecificationSays)
{
    const Bytes file = fileOf({{'S', {5}}});
    const Bytes head = {0x89, 'G', 'I', 'M', 1, 1};
    EXPECT_TRUE(std::equal(head.begin(), head.end(), file.begin()));
    EXPECT_EQ(file[10], 'S');
    EXPECT_EQ(file[11], 1);
    EXPECT_EQ(file[12], 5);
    // CRC-32 of "123456789" is the polynomial's published check value.
    const Bytes check = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
    EXPECT_EQ(crc({check.data(), check.size()}), 0xCBF43926u);
}

TEST(Container, FindsKnownChunksInAnyOrderAndSkipsAncillaryOnes)
{
    const Bytes file = fileOf({{'x', {1, 2, 3}}, {'G', {7}}, {'n', {8, 8}}, {'z', {}}, {'S', {9}}});
    Contents contents;
    ASSERT_EQ(readContents({file.data(), file.size()}, false, &contents), ReadStatus::Ok);
    EXPECT_EQ(contents.chunks, 5u);
    EXPECT_EQ(contents.geometry.content.data[0], 7);
    EXPECT_EQ(contents.normals.content.size, 2u);
    EXPECT_EQ(contents.seam.content.data[0], 9);
    EXPECT_EQ(contents.otherBytes, 3u);
    EXPECT_EQ(contents.geometry.offset, 10u + 9 + 2);
}

TEST(Container, RefusesWhatItMust)
{
    EXPECT_EQ(statusOf(fileOf({{'S', {1}}, {'G', {1}}, {'X', {}}})), ReadStatus::Unsupported);
    EXPECT_EQ(statusOf(fileOf({{'S', {1}}})), ReadStatus::Corrupt);                         // no geometry
    EXPECT_EQ(statusOf(fileOf({{'S', {1}}, {'G', {1}}, {'S', {1}}})), ReadStatus::Corrupt); // twice
    Bytes trailing = fileOf({{'S', {1}}, {'G', {1}}});
    trailing.push_back(0);
    EXPECT_EQ(statusOf(trailing), ReadStatus::Corrupt);
    Bytes version = fileOf({{'S', {1}}, {'G', {1}}});
    version[4] = 2;
    EXPECT_EQ(statusOf(version), ReadStatus::Unsupported);
    EXPECT_EQ(statusOf({'P', 'K'}), ReadStatus::Corrupt);
}

TEST(Container, LongSpellingOfALengthIsRefused)
{
    Bytes file = fileOf({});
    file[5] = 1;
    const std::uint32_t sum = crc({file.data(), 6});
    for (unsigned k = 0; k < 4; ++k) file[6 + k] = static_cast<std::uint8_t>(sum >> 8 * k);
    for (const Bytes& chunk : {Bytes{'x', 0x80, 0x00}, Bytes{'x', 0xFF, 0xFF, 0xFF, 0xFF, 0x1F}}) {
        Bytes bad = file;
        bad.insert(bad.end(), chunk.begin(), chunk.end());
        appendU32(bad, crc({chunk.data(), chunk.size()}));
        EXPECT_EQ(statusOf(bad), ReadStatus::Corrupt);
    }
}

TEST(Container, EveryTruncationAsksForMoreAndEveryFlippedBitIsNoticed)
{
    const Bytes file = fileOf({{'S', {1, 2, 3}}, {'x', {}}, {'G', Bytes(200, 42)}});
    ASSERT_EQ(statusOf(file), ReadStatus::Ok);
    for (std::size_t size = 0; size < file.size(); ++size)
        EXPECT_EQ(statusOf(Bytes(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size))),
                  ReadStatus::MoreInput)
            << size;
    for (std::size_t k = 0; k < 8 * file.size(); ++k) {
        Bytes flipped = file;
        flipped[k / 8] = static_cast<std::uint8_t>(flipped[k / 8] ^ (1u << k % 8));
        EXPECT_NE(statusOf(flipped), ReadStatus::Ok) << "bit " << k;
    }
}

TEST(Reader, FailsOnceAndForAll)
{
    const Bytes bytes = {1, 2, 3};
    Reader in({bytes.data(), bytes.size()});
    EXPECT_EQ(in.u8(), 1);
    EXPECT_EQ(in.u32(), 0u);
    EXPECT_TRUE(in.failed());
    EXPECT_EQ(in.u8(), 0);
    EXPECT_EQ(in.remaining(), 2u);
}

} // namespace
} // namespace gimg::format

// The Stanford bunny that corpus/fetch brings, end to end. Slow under sanitizers.
#include "gimg/decode.h"
#include "gimg/encode.h"
#include "gimg/mesh_io.h"
#include "manifold_check.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace gimg {
namespace {

std::string bunnyPath()
{
    const char* folder = std::getenv("GIMG_CORPUS_DIR");
    return (folder != nullptr ? std::string(folder) : std::string(GIMG_SOURCE_CORPUS) + "/cache") +
           "/bunny.obj";
}

class Bunny : public testing::Test
{
protected:
    static void SetUpTestSuite()
    {
        Result<MeshFile> read = readMesh(bunnyPath());
        ASSERT_TRUE(read.ok()) << read.error().message << " (corpus/fetch bunny brings it)";
        EncodeOptions options;
        options.grid = 257;
        Result<MeshEncoder> prepared = MeshEncoder::prepare(read->mesh, options);
        ASSERT_TRUE(prepared.ok()) << prepared.error().message;
        encoder_ = new MeshEncoder(std::move(*prepared));
    }
    static void TearDownTestSuite()
    {
        delete encoder_;
        encoder_ = nullptr;
    }
    static MeshEncoder* encoder_;
};
MeshEncoder* Bunny::encoder_ = nullptr;

TEST_F(Bunny, FitsInFewKilobytes)
{
    ASSERT_NE(encoder_, nullptr);
    const Result<EncodedMesh> encoded = encoder_->encode({EncodeTarget::Bytes, 12000});
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    EXPECT_LE(encoded->file.size(), 12000u);
    EXPECT_GE(encoded->file.size(), 11880u);
    EXPECT_GT(encoded->psnr, 68);
    EXPECT_GT(encoded->stretchEfficiency, 0.33);
    const Result<DecodedImages> images = decodeImages(encoded->file);
    ASSERT_TRUE(images.ok());
    EXPECT_LE(images->info.container_bytes, 48u);
    for (unsigned level = 0; level < images->info.levels; ++level) {
        const Result<Mesh> decoded = levelMesh(encoded->file, *images, level);
        ASSERT_TRUE(decoded.ok());
        const test::ManifoldCheck check = test::checkManifold(decoded->faces);
        EXPECT_EQ(check.fault, "");
        EXPECT_EQ(check.genus, 0);
        EXPECT_EQ(check.boundaries, 0);
    }
}

TEST_F(Bunny, ThreeKilobytesAndNoLossAtAll)
{
    ASSERT_NE(encoder_, nullptr);
    const Result<EncodedMesh> small = encoder_->encode({EncodeTarget::Bytes, 3000});
    ASSERT_TRUE(small.ok());
    EXPECT_GT(small->psnr, 57);
    const Result<EncodedMesh> raw = encoder_->encode({EncodeTarget::RawFloat});
    ASSERT_TRUE(raw.ok());
    EXPECT_GT(raw->psnr, 74.5);
}

} // namespace
} // namespace gimg

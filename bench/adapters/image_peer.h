#pragma once

#include "adapter.h"

#include <filesystem>

namespace gimg::adapter {

/// A geometry image in whole numbers of `bits` bits over its bounding cube, as image coders take it.
struct ScaledImage
{
    int side = 0;
    int bits = 0;
    std::vector<std::uint16_t> planes; ///< all x, all y, all z
};

/// One way in which an image coder may be used; the best of them is taken for each size.
struct ImageVariant
{
    nlohmann::ordered_json settings;
    int bits = 16; ///< of the whole numbers that are coded
    /// The parameter that decides the size: its range, where a search begins, and the power of it that size
    /// goes about as.
    double least = 0, most = 0, start = 0, exponent = 1;
    std::function<Result<std::vector<std::uint8_t>>(const ScaledImage&, double parameter)> encode;
};

/// What makes a peer that codes the geometry image as an image.
struct ImagePeer
{
    Description description;
    std::string extension;
    std::vector<ImageVariant> variants;
    /// @param like  what was coded; its samples do not matter
    std::function<Result<ScaledImage>(const std::vector<std::uint8_t>&, const ScaledImage& like)> decode;
    /// Times of a file's encoder and decoder, as the programs print them.
    std::function<Result<Times>(const ScaledImage&, double parameter, int runs)> time;
};

/// For each size the variant of the highest surface PSNR. A file holds the bounding cube in 16 bytes, then
/// what the coder made. `time` uses the first variant.
std::unique_ptr<Adapter> makeImagePeer(ImagePeer peer);

/// A folder for the files that a program reads and writes, gone with this.
class Scratch
{
public:
    Scratch();
    ~Scratch();
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;

    std::string path(const std::string& name) const { return (folder_ / name).string(); }

private:
    std::filesystem::path folder_;
};

/// Runs a program of PATH to its end; gives what it printed, on either stream.
/// Errors: CodecFailure with the last line it printed.
Result<std::string> runTool(const std::vector<std::string>& command);

/// Of `programs` those that are not on PATH, each named by its Debian package, as Description::missing holds.
std::vector<std::string> missingPrograms(const std::vector<std::string>& programs,
                                         const std::string& package);

/// A whole file. Errors: CodecFailure, FileNotWritable.
Result<std::vector<std::uint8_t>> readScratch(const std::string& path);
Status writeScratch(const std::string& path, const void* bytes, std::size_t size);

/// The number that follows `before` in what a program printed. Errors: CodecFailure if there is none.
Result<double> numberAfter(const std::string& printed, const std::string& before);

} // namespace gimg::adapter

#include "whole_file.h"

#include "cli.h"

#include <fcntl.h>
#include <openssl/evp.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>

namespace gimg::cli {
namespace {

namespace fs = std::filesystem;

bool writeAll(int file, const char* bytes, std::size_t size)
{
    while (size > 0) {
        const ssize_t count = ::write(file, bytes, size);
        if (count < 0 && errno != EINTR) return false;
        if (count < 0) continue;
        bytes += count;
        size -= static_cast<std::size_t>(count);
    }
    return true;
}

// A name that no other process on any machine uses: several may write in one folder at once.
std::string temporaryName()
{
    std::random_device random;
    char name[32];
    std::snprintf(name, sizeof name, ".gimenc-%08x%08x", random(), random());
    return name;
}

class Sha256
{
public:
    Sha256() { EVP_DigestInit_ex(state_.get(), EVP_sha256(), nullptr); }
    void add(const void* bytes, std::size_t size) { EVP_DigestUpdate(state_.get(), bytes, size); }
    std::string text()
    {
        unsigned char digest[EVP_MAX_MD_SIZE];
        unsigned length = 0;
        EVP_DigestFinal_ex(state_.get(), digest, &length);
        std::string digits;
        for (unsigned i = 0; i < length; ++i)
            for (const int half : {digest[i] >> 4, digest[i] & 15}) digits += "0123456789abcdef"[half];
        return digits;
    }

private:
    std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> state_{EVP_MD_CTX_new(), EVP_MD_CTX_free};
};

} // namespace

bool writeWhole(const std::string& path, const void* bytes, std::size_t size)
{
    std::error_code error;
    const fs::file_status there = fs::status(path, error);
    if (fs::exists(there) && !fs::is_regular_file(there)) return writeFile(path, bytes, size);
    fs::path target(path);
    if (fs::is_symlink(fs::symlink_status(target, error))) target = fs::weakly_canonical(target, error);

    const fs::path temporary = target.parent_path() / temporaryName();
    const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0) return false;
    // On the disk before it has its name: otherwise a power cut could leave the name and not the bytes.
    bool good = writeAll(file, static_cast<const char*>(bytes), size) && ::fsync(file) == 0;
    good = ::close(file) == 0 && good;
    good = good && ::rename(temporary.c_str(), target.c_str()) == 0;
    if (!good) ::unlink(temporary.c_str());
    return good;
}

std::optional<Contents> contentsOf(const std::string& path)
{
    std::ifstream in(path, std::ios::binary);
    Sha256 hash;
    Contents contents;
    char block[1 << 16];
    while (in.read(block, sizeof block) || in.gcount() > 0) {
        const auto count = static_cast<std::size_t>(in.gcount());
        hash.add(block, count);
        contents.bytes += count;
    }
    if (!in.eof()) return std::nullopt;
    contents.sha256 = hash.text();
    return contents;
}

Contents contentsOf(const void* bytes, std::size_t size)
{
    Sha256 hash;
    hash.add(bytes, size);
    return {size, hash.text()};
}

} // namespace gimg::cli

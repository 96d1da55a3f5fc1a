#pragma once

#include "gimg/result.h"

#include <atomic>
#include <filesystem>
#include <string>

namespace gimg::gimrd {

/// The folder that a sweep writes to. Files come into being under a temporary name and are then renamed, so
/// that a process can be killed at any time, and several can work at once, without a lock and without a
/// half-written file.
class SweepFolder
{
public:
    explicit SweepFolder(std::filesystem::path out) : out_(std::move(out)) {}

    /// Makes the folders, and removes what killed processes of this machine left behind.
    /// Errors: FileNotWritable.
    Status open();
    /// Removes this process's temporary files.
    void close();

    const std::filesystem::path& path() const { return out_; }
    std::filesystem::path work(const std::string& mesh) const { return out_ / "work" / mesh; }
    std::filesystem::path point(const std::string& mesh, const std::string& stem) const
    {
        return out_ / "points" / mesh / (stem + ".json");
    }
    std::filesystem::path thumbnail(const std::string& mesh, const std::string& stem) const
    {
        return out_ / "thumbnails" / mesh / (stem + ".png");
    }

    /// A name in a folder of this process's own, never given twice.
    std::filesystem::path temporary(const std::string& extension = "");

    /// Where a job's coder writes, in that same folder.
    std::filesystem::path jobFolder(const std::string& mesh, const std::string& series) const;

    /// Moves a temporary file or folder to where it belongs, over what is there. Errors: FileNotWritable.
    Status publish(const std::filesystem::path& temporary, const std::filesystem::path& place);
    Status publishText(const std::string& text, const std::filesystem::path& place);

    /// A message without the folders that names in it stand in: the same wherever the sweep runs.
    std::string withoutFolders(std::string message) const;

private:
    std::filesystem::path out_, own_;
    std::atomic<int> next_ = 0;
};

} // namespace gimg::gimrd

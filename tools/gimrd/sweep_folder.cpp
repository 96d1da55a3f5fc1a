#include "sweep_folder.h"

#include "../cli.h"

#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <regex>

namespace gimg::gimrd {
namespace {

namespace fs = std::filesystem;

Error notWritable(const fs::path& path, const std::string& why)
{
    return {ErrorKind::FileNotWritable, path.string() + ": " + why};
}

// "running-HOST-PID": whose it is can be told from the name, on a folder that machines share.
std::string ownPrefix()
{
    char host[256] = "localhost";
    ::gethostname(host, sizeof host - 1);
    return std::string("running-") + host + '-';
}

void removeLeftovers(const fs::path& work)
{
    const std::string prefix = ownPrefix();
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(work, ignored)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with(prefix)) continue;
        const auto process = static_cast<pid_t>(std::atol(name.c_str() + prefix.size()));
        if (process > 0 && ::kill(process, 0) != 0 && errno == ESRCH) fs::remove_all(entry.path(), ignored);
    }
}

} // namespace

Status SweepFolder::open()
{
    std::error_code failed;
    const fs::path work = out_ / "work";
    fs::create_directories(work, failed);
    if (failed) return notWritable(out_, failed.message());
    removeLeftovers(work);
    own_ = work / (ownPrefix() + std::to_string(::getpid()));
    fs::remove_all(own_, failed);
    fs::create_directories(own_, failed);
    if (failed) return notWritable(own_, failed.message());
    return Done{};
}

void SweepFolder::close()
{
    std::error_code ignored;
    if (!own_.empty()) fs::remove_all(own_, ignored);
}

fs::path SweepFolder::temporary(const std::string& extension)
{
    return own_ / (std::to_string(next_++) + extension);
}

fs::path SweepFolder::jobFolder(const std::string& mesh, const std::string& series) const
{
    return own_ / "jobs" / mesh / series;
}

Status SweepFolder::publish(const fs::path& temporary, const fs::path& place)
{
    std::error_code failed;
    fs::create_directories(place.parent_path(), failed);
    if (!failed) fs::rename(temporary, place, failed);
    if (failed) return notWritable(place, failed.message());
    return Done{};
}

Status SweepFolder::publishText(const std::string& text, const fs::path& place)
{
    const fs::path draft = temporary();
    if (!cli::writeFile(draft.string(), text.data(), text.size()))
        return notWritable(place, "cannot be written");
    return publish(draft, place);
}

std::string SweepFolder::withoutFolders(std::string message) const
{
    for (const fs::path& folder : {own_, out_}) {
        const std::string prefix = folder.string() + '/';
        for (size_t at; (at = message.find(prefix)) != std::string::npos;) message.erase(at, prefix.size());
    }
    static const std::regex absolute(R"((^|[\s'"(=:])/(?:[^\s/:'"]+/)*(?=[^\s/:'"]))");
    return std::regex_replace(message, absolute, "$1");
}

} // namespace gimg::gimrd

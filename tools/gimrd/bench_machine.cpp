#include "bench_machine.h"

#include <nlohmann/json.hpp>

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <string>

namespace gimg::gimrd {
namespace {

// What follows the first `key` and the separator in a file of lines "key<separator>value"; empty if nothing.
std::string valueIn(const char* path, const std::string& key, char separator)
{
    std::ifstream in(path);
    for (std::string line; std::getline(in, line);) {
        if (line.rfind(key, 0) != 0) continue;
        const size_t at = line.find(separator);
        if (at == std::string::npos) continue;
        const size_t first = line.find_first_not_of(" \t\"", at + 1);
        const size_t last = line.find_last_not_of(" \t\"");
        if (first != std::string::npos) return line.substr(first, last - first + 1);
    }
    return {};
}

std::string compiler()
{
#if defined(__clang__)
    return "Clang " __clang_version__;
#elif defined(__GNUC__)
    return "GCC " __VERSION__;
#else
    return "unknown";
#endif
}

} // namespace

nlohmann::ordered_json describeMachine()
{
    nlohmann::ordered_json machine;
    const std::string cpu = valueIn("/proc/cpuinfo", "model name", ':');
    const std::string os = valueIn("/etc/os-release", "PRETTY_NAME", '=');
    double load = 0;
    machine["cpu"] = cpu.empty() ? "unknown" : cpu;
    machine["cores"] = ::sysconf(_SC_NPROCESSORS_ONLN);
    machine["memory"] = std::int64_t{::sysconf(_SC_PHYS_PAGES)} * ::sysconf(_SC_PAGESIZE);
    machine["os"] = os.empty() ? "unknown" : os;
    machine["compiler"] = compiler();
    machine["load"] = nullptr; // before the first measurement
    if (::getloadavg(&load, 1) == 1) machine["load"] = load;
    return machine;
}

std::int64_t ownBytes()
{
    const std::string kilobytes = valueIn("/proc/self/status", "RssAnon", ':');
    return 1024 * std::int64_t{std::atoi(kilobytes.c_str())};
}

} // namespace gimg::gimrd

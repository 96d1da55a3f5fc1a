#include "process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <mutex>
#include <set>

namespace gimg::cli {
namespace {

constexpr size_t kErrorsKept = 4000;

std::mutex runningMutex;
std::set<pid_t> running; ///< guarded by the mutex, as is `ending`
bool ending = false;

// Reads what is there; false at the end of the stream.
bool drain(int descriptor, std::string& into)
{
    char block[1 << 16];
    const ssize_t count = ::read(descriptor, block, sizeof block);
    if (count > 0) into.append(block, static_cast<size_t>(count));
    return count > 0 || (count < 0 && errno == EINTR);
}

void giveLines(std::string& buffer, const std::function<void(const std::string&)>& line)
{
    size_t begin = 0;
    for (size_t end; (end = buffer.find('\n', begin)) != std::string::npos; begin = end + 1)
        line(buffer.substr(begin, end - begin));
    buffer.erase(0, begin);
}

// What the child does between fork and exec; only calls that are safe there.
[[noreturn]] void become(char* const* arguments, int out, int errors, pid_t parent)
{
    ::setpgid(0, 0); // so that what it starts itself ends with it
    sigset_t none;
    ::sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(127); // the parent went first
    const int nothing = ::open("/dev/null", O_RDONLY);
    ::dup2(nothing, STDIN_FILENO);
    ::dup2(out, STDOUT_FILENO);
    ::dup2(errors, STDERR_FILENO);
    ::execvp(arguments[0], arguments);
    ::_exit(127);
}

// Negative if there is no child.
pid_t start(char* const* arguments, int out, int errors)
{
    const std::lock_guard lock(runningMutex);
    if (ending) return -1;
    const pid_t parent = ::getpid();
    const pid_t child = ::fork();
    if (child == 0) become(arguments, out, errors, parent);
    if (child > 0) running.insert(child);
    return child;
}

// Waits for the end of a child. Its number may belong to another process as soon as it has been waited for,
// so it leaves the list first.
int reap(pid_t child, rusage& usage)
{
    siginfo_t info{};
    while (::waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOWAIT) < 0 && errno == EINTR) {
    }
    {
        const std::lock_guard lock(runningMutex);
        running.erase(child);
    }
    int status = 0;
    while (::wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    return status;
}

} // namespace

Result<Ended> runProgram(const std::vector<std::string>& command,
                         const std::function<void(const std::string&)>& line)
{
    std::vector<char*> arguments;
    for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    int out[2], errors[2];
    if (::pipe2(out, O_CLOEXEC) != 0)
        return Error{ErrorKind::FileNotReadable, command[0] + ": " + std::strerror(errno)};
    if (::pipe2(errors, O_CLOEXEC) != 0) {
        ::close(out[0]), ::close(out[1]);
        return Error{ErrorKind::FileNotReadable, command[0] + ": " + std::strerror(errno)};
    }
    const pid_t child = start(arguments.data(), out[1], errors[1]);
    ::close(out[1]), ::close(errors[1]);
    if (child < 0) {
        restIfEnding();
        ::close(out[0]), ::close(errors[0]);
        return Error{ErrorKind::FileNotReadable, command[0] + ": cannot be started"};
    }

    Ended ended;
    std::string pending;
    pollfd streams[2] = {{out[0], POLLIN, 0}, {errors[0], POLLIN, 0}};
    while (streams[0].fd >= 0 || streams[1].fd >= 0) {
        if (::poll(streams, 2, -1) < 0) {
            if (errno == EINTR) continue;
            break;
        }
        for (pollfd& stream : streams) {
            if (stream.fd < 0 || stream.revents == 0) continue;
            std::string& into = stream.fd == out[0] ? pending : ended.errors;
            if (!drain(stream.fd, into)) stream.fd = -1;
        }
        giveLines(pending, line);
        if (ended.errors.size() > kErrorsKept) ended.errors.erase(0, ended.errors.size() - kErrorsKept);
    }
    if (!pending.empty()) line(pending);
    ::close(out[0]), ::close(errors[0]);

    rusage usage{};
    const int status = reap(child, usage);
    restIfEnding();
    ended.code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    ended.peakBytes = std::int64_t{usage.ru_maxrss} * 1024;
    return ended;
}

void restIfEnding()
{
    {
        const std::lock_guard lock(runningMutex);
        if (!ending) return;
    }
    for (;;) ::pause();
}

void endPrograms()
{
    const std::lock_guard lock(runningMutex);
    ending = true;
    for (const pid_t child : running) {
        ::kill(-child, SIGKILL);
        ::kill(child, SIGKILL); // it may not lead its group yet
    }
}

} // namespace gimg::cli

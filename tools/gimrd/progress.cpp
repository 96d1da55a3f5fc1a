#include "progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace gimg::gimrd {
namespace {

constexpr size_t kBarWidth = 24;

std::string duration(double seconds)
{
    char text[32];
    if (seconds < 90)
        std::snprintf(text, sizeof text, "%.0f s", std::ceil(seconds));
    else if (seconds < 90 * 60)
        std::snprintf(text, sizeof text, "%.0f min", std::ceil(seconds / 60));
    else
        std::snprintf(text, sizeof text, "%.1f h", seconds / 3600);
    return text;
}

size_t terminalWidth()
{
    winsize size{};
    return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

} // namespace

Progress::Progress(int jobs) : jobs_(std::max(jobs, 1)), terminal_(::isatty(STDERR_FILENO) != 0) {}

void Progress::expect(const std::string& series, double weight)
{
    const std::lock_guard lock(mutex_);
    paces_[series].open += weight;
    ++total_;
}

void Progress::found()
{
    const std::lock_guard lock(mutex_);
    ++total_, ++done_;
}

void Progress::finish(const std::string& mesh, const std::string& series, size_t target, double weight,
                      double seconds, const std::string& outcome)
{
    const std::lock_guard lock(mutex_);
    Pace& pace = paces_[series];
    pace.open -= weight;
    pace.done += weight;
    pace.seconds += seconds;
    ++done_;
    const std::string name = mesh + ' ' + series + ' ' + std::to_string(target);
    if (terminal_)
        draw(name + ": " + outcome);
    else
        std::fprintf(stderr, "%zu/%zu %s: %s\n", done_, total_, name.c_str(), outcome.c_str());
}

void Progress::overtaken(const std::string& series, double weight)
{
    const std::lock_guard lock(mutex_);
    paces_[series].open -= weight;
    ++done_;
}

void Progress::say(const std::string& line)
{
    const std::lock_guard lock(mutex_);
    wipe();
    std::fprintf(stderr, "gimrd: %s\n", line.c_str());
    if (terminal_ && total_ > 0) draw(current_);
}

void Progress::clear()
{
    const std::lock_guard lock(mutex_);
    wipe();
}

// Each series at its own pace; one that has not shown its pace yet at the mean of the others. Negative if
// nothing is known.
double Progress::secondsLeft() const
{
    double done = 0, seconds = 0, left = 0;
    for (const auto& [series, pace] : paces_) done += pace.done, seconds += pace.seconds;
    if (done <= 0) return -1;
    for (const auto& [series, pace] : paces_)
        left += std::max(pace.open, 0.0) * (pace.done > 0 ? pace.seconds / pace.done : seconds / done);
    return left / jobs_;
}

void Progress::draw(const std::string& current)
{
    current_ = current;
    const size_t filled = total_ == 0 ? 0 : kBarWidth * done_ / total_;
    std::string line = '[' + std::string(filled, '#') + std::string(kBarWidth - filled, '.') + "] " +
                       std::to_string(done_) + '/' + std::to_string(total_);
    const double left = secondsLeft();
    if (left >= 0 && done_ < total_) line += ", " + duration(left) + " left";
    line += "  " + current_;
    line.resize(std::min(line.size(), terminalWidth() - 1));
    std::fprintf(stderr, "\r%s\033[K", line.c_str());
    std::fflush(stderr);
}

void Progress::wipe() const
{
    if (terminal_) std::fputs("\r\033[K", stderr);
}

} // namespace gimg::gimrd

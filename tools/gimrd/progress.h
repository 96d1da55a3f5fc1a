#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <mutex>
#include <string>

namespace gimg::gimrd {

/// Says on standard error how far a sweep is: a bar with the time that is left, or, where that is no
/// terminal, a line for each point. Thread-safe.
class Progress
{
public:
    explicit Progress(int jobs);

    /// Announces a point that is still to be made. `weight` stands for the work in it, within one series.
    void expect(const std::string& series, double weight);
    /// Announces a point that is there already.
    void found();

    /// A point is done, `seconds` after the one before it in its job.
    void finish(const std::string& mesh, const std::string& series, size_t target, double weight,
                double seconds, const std::string& outcome);
    /// An expected point was made by another process.
    void overtaken(const std::string& series, double weight);
    /// A line of its own.
    void say(const std::string& line);
    /// Takes the bar away.
    void clear();

private:
    struct Pace
    {
        double open = 0; ///< weight still to do
        double done = 0, seconds = 0;
    };
    double secondsLeft() const;
    void draw(const std::string& current);
    void wipe() const;

    std::mutex mutex_;
    std::map<std::string, Pace> paces_;
    size_t total_ = 0, done_ = 0;
    int jobs_;
    bool terminal_;
    std::string current_;
};

} // namespace gimg::gimrd

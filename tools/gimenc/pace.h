#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace gimg::gimenc {

/// How long the rest of a batch takes, if a byte of input takes as long as those before it did.
class Pace
{
public:
    void expect(std::uint64_t bytes) { left_ += weight(bytes); }

    /// @param worked  false for a job that was found finished: it took no time and tells nothing
    void finish(std::uint64_t bytes, bool worked)
    {
        left_ -= weight(bytes);
        if (worked) done_ += weight(bytes);
    }

    /// ", about 1 h 20 min left"; empty while nothing is known.
    std::string left() const
    {
        if (done_ <= 0) return "";
        const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start_;
        const long seconds = static_cast<long>(spent.count() * left_ / done_ + 0.5);
        const auto in = [](long number, const char* unit) { return std::to_string(number) + unit; };
        if (seconds < 60) return ", about " + in(seconds, " s left");
        if (seconds < 3600) return ", about " + in(seconds / 60, " min ") + in(seconds % 60, " s left");
        return ", about " + in(seconds / 3600, " h ") + in(seconds / 60 % 60, " min left");
    }

private:
    // The part of a job that its size does not decide weighs as much as a mesh of this many bytes.
    static constexpr double kSizeless = 200'000;
    static double weight(std::uint64_t bytes) { return static_cast<double>(bytes) + kSizeless; }

    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    double left_ = 0, done_ = 0;
};

} // namespace gimg::gimenc

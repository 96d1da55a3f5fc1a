#pragma once

#include <unistd.h>

#include <cstdio>
#include <string>

namespace gimg::gimenc {

/// One line on a terminal that says what is being done; gone with this object. Elsewhere it is not shown.
class StatusLine
{
public:
    explicit StatusLine(bool wanted) : shown_(wanted && isatty(STDERR_FILENO) == 1) {}
    ~StatusLine() { wipe(); }
    StatusLine(const StatusLine&) = delete;
    StatusLine& operator=(const StatusLine&) = delete;

    bool isShown() const { return shown_; }
    void show(const std::string& text) const
    {
        if (shown_) std::fprintf(stderr, "\r\033[K%s", text.c_str());
    }
    void wipe() const { show(""); }

private:
    bool shown_;
};

} // namespace gimg::gimenc

#pragma once

#include <cctype>
#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

namespace gimg {

/// Walks over a text in memory token by token. Lines end with LF, CRLF or CR; a backslash before a line end
/// joins two lines; a token that starts with '#' hides the rest of its line.
class TextScanner
{
public:
    explicit TextScanner(std::string_view text) : text_(text) {}

    /// The next token of the current line; empty at its end.
    std::string_view lineToken()
    {
        skipBlanks();
        if (atLineEnd()) return {};
        const size_t start = at_;
        while (at_ < text_.size() && !isBlank(text_[at_]) && !isLineEnd(text_[at_])) ++at_;
        return text_.substr(start, at_ - start);
    }

    /// The next token, on this or a later line; empty at the end of the text.
    std::string_view token()
    {
        for (;;) {
            const std::string_view t = lineToken();
            if (!t.empty() || !nextLine()) return t;
        }
    }

    /// Goes to the start of the next line. False at the end of the text.
    bool nextLine()
    {
        while (at_ < text_.size() && !isLineEnd(text_[at_])) ++at_;
        if (at_ == text_.size()) return false;
        passLineEnd();
        return true;
    }

    /// Number of the current line, from 1.
    size_t line() const { return line_; }
    size_t remaining() const { return text_.size() - at_; }
    /// No line end follows any more: what is wrong with this line may be that the rest is missing.
    bool onLastLine() const { return text_.find_first_of("\r\n", at_) == std::string_view::npos; }

private:
    static bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
    static bool isLineEnd(char c) { return c == '\n' || c == '\r'; }

    void passLineEnd()
    {
        if (text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n') ++at_;
        ++at_;
        ++line_;
    }

    void skipBlanks()
    {
        for (; at_ < text_.size(); ++at_) {
            if (isBlank(text_[at_])) continue;
            if (text_[at_] != '\\' || at_ + 1 == text_.size() || !isLineEnd(text_[at_ + 1])) return;
            ++at_;
            passLineEnd();
            --at_;
        }
    }

    bool atLineEnd()
    {
        if (at_ < text_.size() && text_[at_] == '#')
            while (at_ < text_.size() && !isLineEnd(text_[at_])) ++at_;
        return at_ == text_.size() || isLineEnd(text_[at_]);
    }

    std::string_view text_;
    size_t at_ = 0;
    size_t line_ = 1;
};

/// A whole token as a number; "nan" and "inf" are numbers, and so is what overflows to infinity.
inline std::optional<double> number(std::string_view token)
{
    if (!token.empty() && token.front() == '+') token.remove_prefix(1);
    double value = 0;
    const auto [end, failure] = std::from_chars(token.data(), token.data() + token.size(), value);
    if (token.empty() || end != token.data() + token.size()) return std::nullopt;
    if (failure == std::errc::result_out_of_range) {
        const size_t exponent = token.find_first_of("eE");
        const bool tiny =
            exponent == token.npos ? token.find('.') <= 2 : token.substr(exponent + 1).starts_with('-');
        return tiny ? 0.0 : std::numeric_limits<double>::infinity();
    }
    return value;
}

inline std::optional<int64_t> integer(std::string_view token)
{
    if (!token.empty() && token.front() == '+') token.remove_prefix(1);
    int64_t value = 0;
    const auto [end, failure] = std::from_chars(token.data(), token.data() + token.size(), value);
    if (token.empty() || failure != std::errc() || end != token.data() + token.size()) return std::nullopt;
    return value;
}

inline bool equalsIgnoringCase(std::string_view token, std::string_view lower)
{
    if (token.size() != lower.size()) return false;
    for (size_t i = 0; i < token.size(); ++i)
        if (std::tolower(static_cast<unsigned char>(token[i])) != lower[i]) return false;
    return true;
}

} // namespace gimg

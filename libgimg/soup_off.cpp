// Object File Format: OFF with any of the prefixes ST, C and N, text. One vertex or face a line, so that
// whatever follows the coordinates or indices (normals, colours, texture coordinates) can be passed over.
#include "soup_parsers.h"
#include "text_scan.h"

#include <climits>

namespace gimg {

namespace {

class OffParser
{
public:
    explicit OffParser(std::string_view text) : scan_(text)
    {
        soup_.lastLineOpen = text.back() != '\n' && text.back() != '\r';
    }

    Result<PolygonSoup> parse()
    {
        std::string_view first = scan_.token();
        if (!number(first)) { // the keyword may be left out
            if (!first.ends_with("OFF") || first.find_first_not_of("STCNOF") != first.npos)
                return Error{ErrorKind::FileCorrupt, "not a text OFF file of points in space"};
            first = scan_.token();
            if (equalsIgnoringCase(first, "binary"))
                return Error{ErrorKind::FormatUnknown, "binary OFF is not supported"};
        }
        if (first.empty()) return Error{ErrorKind::FileTruncated, "the file ends within the header"};
        const std::optional<int64_t> vertices = integer(first);
        const std::optional<int64_t> faces = integer(scan_.token());
        if (!vertices || !faces || *vertices < 0 || *faces < 0)
            return Error{ErrorKind::FileCorrupt,
                         "line " + std::to_string(scan_.line()) + ": no element counts"};
        scan_.nextLine();

        for (int64_t i = 0; i < *vertices; ++i)
            if (!vertex()) return failure("vertex", i, *vertices);
        for (int64_t i = 0; i < *faces; ++i)
            if (!face()) return failure("face", i, *faces);
        if (const std::string_view rest = scan_.token(); !rest.empty())
            soup_.trailingBytes = rest.size() + scan_.remaining();
        return std::move(soup_);
    }

private:
    bool vertex()
    {
        Vec3 p;
        for (int k = 0; k < 3; ++k) {
            const std::optional<double> value = number(k == 0 ? scan_.token() : scan_.lineToken());
            if (!value) return false;
            p[k] = *value;
        }
        soup_.positions.push_back(p);
        scan_.nextLine();
        return true;
    }

    bool face()
    {
        const std::optional<int64_t> count = integer(scan_.token());
        if (!count || *count < 0) return false;
        for (int64_t k = 0; k < *count; ++k) {
            const std::optional<int64_t> v = integer(scan_.lineToken());
            if (!v || *v < INT_MIN || *v > INT_MAX) return false;
            soup_.corners.push_back(static_cast<int>(*v));
        }
        soup_.endFace();
        scan_.nextLine();
        return true;
    }

    Error failure(const char* what, int64_t done, int64_t count) const
    {
        const std::string element = what;
        if (scan_.onLastLine())
            return {ErrorKind::FileTruncated, "the file ends at " + element + " " + std::to_string(done) +
                                                  ", the header promises " + std::to_string(count) +
                                                  " of them"};
        return {ErrorKind::FileCorrupt, "line " + std::to_string(scan_.line()) + ": " + element + " " +
                                            std::to_string(done) + " is malformed"};
    }

    TextScanner scan_;
    PolygonSoup soup_;
};

} // namespace

Result<PolygonSoup> parseOff(std::string_view text) { return OffParser(text).parse(); }

} // namespace gimg
